/// \file
/// The kind of coordinates that carries a model best.
#pragma once

#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <span>
#include <string>
#include <vector>

namespace cagewright {

/// How a kind carries a model, all in diagonals of the model's box.
struct TriedKind {
  const CoordinateKind* kind = nullptr;
  double bend = 0;     ///< the mean error of the standard bend
  double twist = 0;    ///< and of the twist
  double drag = 0;     ///< how far a limb is dragged by what it does not see: see drag_per_share
  std::string refusal; ///< why it cannot carry the model at all; else empty

  [[nodiscard]] double cost() const { return bend + twist + drag; }
};

struct ChosenCoordinates {
  CoordinateSettings settings;
  std::vector<TriedKind> tried; ///< those that carry the model, the best first; then the others
};

/// A limb that moves by a fifth of the diagonal drags what does not see it by that, times the share
/// of its weights there: see unseen_share().
constexpr double drag_per_share = 0.2;

/// Tries every kind, as it is by itself, on up to 4096 vertices of the model: of those that have
/// weights for all of them that one is chosen whose errors in the standard bend and twist, and
/// whose drag across gaps, have the least sum; of equal ones the first. An open cage is accepted
/// where a kind makes sense of it.
///
/// Errors: invalid_cage (no kind can carry the model; with what the first said), cancelled.
/// Cost: that of preparing every kind once. The same on any number of threads.
Result<ChosenCoordinates> choose_coordinates(const PolygonMesh& cage, std::span<const Vec3> model,
                                             const Progress& progress = {});

} // namespace cagewright
