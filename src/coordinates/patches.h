/// \file
/// A cage of triangles and bilinear quads. Internal to this module.
#pragma once

#include "coordinates/surface.h"
#include "coordinates/surface_coordinates.h"

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace cagewright {

/// A quad as the surface P(u, v) = sum of B_k p_k, B = ((1 - u)(1 - v), u (1 - v), u v, (1 - u) v).
/// Its normal P_u x P_v, with the length that it has, is affine in u and v.
struct Patch {
  std::array<Index, 4> vertices;
  std::array<Vec3, 4> corners;    ///< in the frame
  std::array<Vec3, 4> normals;    ///< at the corners: (p_{k+1} - p_k) x (p_{k-1} - p_k)
  std::array<Vec3, 4> position;   ///< P = position[0] + u [1] + v [2] + u v [3]
  std::array<Vec3, 3> normal;     ///< N = normal[0] + u [1] + v [2]
  std::vector<std::size_t> faces; ///< its triangles with area in `surface`, cut along p0 p2
};

Patch make_patch(const std::array<Vec3, 4>& corners);

/// Where quads remain, and triangles besides.
struct PatchedSurface {
  Surface surface;                    ///< quads cut along the diagonal of their corners 0 and 2
  std::vector<std::size_t> triangles; ///< faces of `surface` that are no part of a quad
  std::vector<Patch> patches;         ///< but those of which both triangles have no area

  /// Errors: those of Surface::create().
  static Result<PatchedSurface> create(const PolygonMesh& cage);
};

/// Coordinates that are computed from it.
class PatchedCoordinates : public FramedCoordinates {
protected:
  /// \param rule  made before: `patched` is moved from
  PatchedCoordinates(std::shared_ptr<const ColumnRule> rule, PatchedSurface patched,
                     OutsideTreatment outside)
      : FramedCoordinates(std::move(rule), patched.surface.frame, outside),
        patched_(std::move(patched)) {}

  [[nodiscard]] const PatchedSurface& patched() const { return patched_; }

private:
  PatchedSurface patched_;
};

/// The hats of a patch.
inline std::array<double, 4> hats_at(double u, double v) {
  return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
}

/// Nodes of Gauss and Legendre on the unit square, filled up with nodes of weight 0 to a multiple
/// of 8.
struct SquareRule {
  std::vector<double> u, v, weight;

  explicit SquareRule(std::size_t along_a_side);
};

/// How many nodes along a side give weights an accuracy: 4 for 1e-6, 6 for 1e-8, 12 for 1e-14.
const SquareRule& square_rule(double accuracy);

} // namespace cagewright
