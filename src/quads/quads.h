/// \file
/// A cage of triangles made into one of quads.
#pragma once

#include "improve/seam_band.h"
#include "quads/quad_shape.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/quads/quad_report.h>

#include <functional>
#include <span>
#include <vector>

namespace cagewright {

struct ModelSurface;

struct QuadOptions {
  QuadLimits limits = {};
  /// Least distance from every part of every face to the model, in diagonals of the model's box.
  /// The cage to start from must keep it.
  double clearance = 0.002;
  /// How far the cage moves off the model at most, in diagonals, while its faces are being paired.
  double room = 0.01;
  /// What lengths are fractions of. 0: the diagonal of the model's box.
  double diagonal = 0;
  /// Where the cage is to be finer: see ImproveOptions. The view must live as long as the call.
  std::span<const double> density = {};
  /// The part that each face of the cage to start from belongs to, or empty. The edges between two
  /// parts stay edges. The view must live as long as the call.
  std::span<const Index> parts = {};
  /// By part: where its border to parts of smaller numbers stays. Or empty.
  std::span<const SeamBand> bands = {};
  /// The share of the space between limbs that a cage encloses (see SpaceBetween), which counts
  /// against it where there are several to choose from. None: not asked.
  std::function<double(TriangleView cage)> webbing = {};
  double square = 40;  ///< weight of large gaps: see ObjectiveWeights
  double shape = 7e-4; ///< weight of well shaped faces: see ObjectiveWeights
};

struct Quadrangulated {
  /// Triangles and quads. Cut along any choice of diagonals it is valid, and keeps the clearance.
  /// The first diagonal of each quad is the one along which triangulate() cuts it.
  PolygonMesh cage;
  std::vector<Index> parts; ///< that its faces belong to: see QuadOptions
  QuadReport report;
};

/// Makes a quad-dominant cage of a cage of triangles, with the same vertices or fewer, moved: the
/// cheapest, by volume, gaps, webs and shapes, of two to four; of large cages of
/// fewer.
///
/// The cage is valid and keeps the clearance: so does the result, because no change is made
/// that was not checked. It may be open if its border lies in the plane x = 0: then it is one half
/// of a symmetric cage, and the border stays in the plane.
///
/// Errors: invalid_option, invalid_cage (no faces, or a border off the plane x = 0), unfit_model
/// (no vertices), cancelled. The same result on any number of threads.
Result<Quadrangulated> make_quads(TriangleView cage, TriangleView model,
                                  const QuadOptions& options = {}, const Progress& progress = {});

/// The same for a model that has been looked at already: lengths are fractions of its `diagonal`,
/// whatever the options say.
Result<Quadrangulated> make_quads(TriangleView cage, const ModelSurface& model,
                                  const QuadOptions& options = {}, const Progress& progress = {});

/// The same vertices and surface, with quads in place of pairs of triangles in one plane, if
/// they are convex: as many as there can be, the squarest first. Whether a quad meets another face
/// along its other diagonal has to be checked.
PolygonMesh pair_coplanar(TriangleView mesh);

/// Measures the quads of a mesh.
QuadReport report_of(const PolygonMesh& mesh);

} // namespace cagewright
