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
  std::array<Vec3, 4> corners;  ///< in the frame
  std::array<Vec3, 4> normals;  ///< at the corners: (p_{k+1} - p_k) x (p_{k-1} - p_k)
  std::array<Vec3, 4> position; ///< P = position[0] + u [1] + v [2] + u v [3]
  std::array<Vec3, 3> normal;   ///< N = normal[0] + u [1] + v [2]
};

Patch make_patch(const std::array<Vec3, 4>& corners);

/// Four numbers for the corners p_k of a patch and four for its normals N_k, the least of which the
/// first four have the sum s, and p_k times the first plus N_k times the others the sum v: they are
/// `factor` times (s, v - s middle), both in the units of the frame.
struct LeastChange {
  Vec3 middle;
  std::array<std::array<double, 4>, 8> factor;

  explicit LeastChange(const Patch& patch);
};

/// A patch of a cage, and what closed forms need of its rim.
struct CagePatch {
  Patch patch;
  LeastChange least;
  std::array<std::size_t, 4> rim;       ///< edges k to k + 1, of PatchedSurface::rims
  std::array<double, 4> rim_sign;       ///< -1 where the edge runs the other way there
  std::array<std::size_t, 2> triangles; ///< that were made of it, in PatchedSurface::surface: ...
  std::size_t triangle_count = 0;       ///< one or two; those without area are left out
};

/// An edge of a patch.
struct RimEdge {
  Index from, to;
  Vec3 along; ///< of length one; zero if the edge has none
  double length = 0;
};

/// Where quads remain, and triangles besides.
struct PatchedSurface {
  Surface surface;                    ///< quads cut along the diagonal of their corners 0 and 2
  std::vector<std::size_t> triangles; ///< faces of `surface` that are no part of a quad
  Surface without_quads;              ///< those alone, in the same frame, with the same vertices
  std::vector<CagePatch> patches;     ///< but those of which both triangles have no area
  std::vector<RimEdge> rims;

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

/// Gauss and Legendre's nodes on [0, 1].
struct LineRule {
  std::vector<double> at, weight;

  explicit LineRule(std::size_t count);
};

/// For pieces of a patch: the smaller they are as seen from a point, the fewer nodes do.
struct PatchRule {
  struct Choice {
    LineRule line;          ///< along both sides
    double seen_under2 = 0; ///< square of radius over distance, at most
  };
  std::vector<Choice> choices; ///< fewest nodes first; what is larger than all is split

  /// \param along_a_side  nodes of pieces of middling size
  /// \param accuracy      of a piece, as a part of the sum of all weights
  PatchRule(std::size_t along_a_side, double accuracy);
};

/// What gives weights an accuracy: 4 nodes a side for 1e-6, 6 for 1e-8, 12 for 1e-14.
const PatchRule& patch_rule(double accuracy);

} // namespace cagewright
