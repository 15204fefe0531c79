/// \file
/// Fewer vertices, one edge collapse after the other.
#pragma once

#include "improve/objective.h"
#include <cagewright/core/progress.h>

#include <limits>
#include <vector>

namespace cagewright {

/// How the vertex that remains of an edge is placed.
enum class Placement {
  outside_patch,  ///< outside the planes of the old faces: quick, never asks the model, grows
  clear_of_model, ///< where it lowers the objective, clear of the model
};

/// What a change may not do to the shape of the faces, unless it was as bad before.
struct ShapeLimits {
  double worst_defect = 8;     ///< of a face: see shape_defect(); it is hard on needles
  double least_quality = 0.06; ///< of a face: see shape_quality(); it is hard on flat corners
  double sharpest_bend = -0.9; ///< of two neighbours: see bend(); 26 degrees between the faces
};

struct SimplifyOptions {
  std::size_t vertices = 4;
  Placement placement = Placement::clear_of_model;
  std::size_t most_valence = 10;
  ShapeLimits limits = {};
};

/// The cage under change, and what has to be kept beside it.
struct WorkingCage {
  explicit WorkingCage(TriangleView start, CageExtent extent = CageExtent::whole,
                       std::span<const Index> parts = {}, std::span<const SeamBand> bands = {})
      : mesh(start, extent, parts, bands), boxes(mesh) {}

  /// Makes the change and keeps the boxes up to date. \returns the new faces
  std::vector<Index> apply(const Patch& patch);

  CageMesh mesh;
  FaceBoxes boxes;
  /// How far relax() let a vertex move in its next step, when it stopped.
  double reach = std::numeric_limits<double>::infinity();
};

/// Collapses edges, the one that costs the objective least first, until the number of vertices is
/// reached or no edge is left that can go. The cage stays valid throughout.
///
/// \returns false if it was cancelled; the cage is valid then too
bool simplify(WorkingCage& cage, const Guard& guard, const Objective& objective,
              const SimplifyOptions& options, const Progress& progress = {});

/// True when no two faces that meet at the patch's new faces fold onto each other more sharply than
/// before, and no new face is a needle unless an old one was worse.
bool keeps_shape(const CageMesh& cage, const Patch& patch, const ShapeLimits& limits = {});

} // namespace cagewright
