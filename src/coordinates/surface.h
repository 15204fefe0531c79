/// \file
/// A cage as a surface of triangles, prepared for integrals over it. Internal to this module.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// An edge of a triangle as it is looked up: smaller index first.
struct EdgeUse {
  Index from, to;
  std::size_t triangle;
  unsigned opposite; ///< which corner of the triangle
  int direction;     ///< +1 when the triangle runs from -> to

  [[nodiscard]] bool same_edge(const EdgeUse& other) const {
    return from == other.from && to == other.to;
  }
};

/// The three of each triangle, those of one edge side by side.
std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles);

/// Whether integrals over the cage make sense. Errors: invalid_cage (no faces, an index out of
/// range, positions not finite; open edges unless allowed).
Status check_surface(TriangleView cage, bool allow_open);

/// Triangles without area see nothing, and a triangle this thin has no plane to speak of: the faces
/// beside it meet across its edges as if it were not there.
template <class Vector> bool is_degenerate(const Vector& a, const Vector& b, const Vector& c) {
  using Real = typename Vector::Scalar;
  const Real longest2 =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() <= Real(1e-13L) * longest2;
}

/// A cage whose quads are cut into triangles.
struct TriangulatedCage {
  TriangleMesh mesh; ///< the cage's C vertices, then the middles of quads
  /// Corners of the quads whose middles are the vertices from C on.
  std::vector<std::array<Index, 4>> quads;
};
TriangulatedCage triangulated(const PolygonMesh& cage, QuadTreatment quads);

/// Adds the middles to the positions of a cage, at rest or deformed.
std::vector<Vec3> with_middles(std::span<const Vec3> cage,
                               std::span<const std::array<Index, 4>> quads);

/// Where a cage is, so that computations do not depend on its unit and origin.
struct CageFrame {
  Vec3 center = Vec3::Zero();
  double scale = 1;    ///< a power of two: the scaled diagonal is in [0.5, 1)
  double diagonal = 0; ///< in the cage's units

  [[nodiscard]] Vec3 to_frame(const Vec3& p) const { return (p - center) * scale; }
  [[nodiscard]] double scaled_diagonal() const { return diagonal * scale; }
};

/// Errors: invalid_cage (no extent).
Result<CageFrame> frame_of(TriangleView cage);

/// A closed cage in its frame, its triangles counter-clockwise from outside; those without area are
/// left out.
///
/// Of a triangle, edge e runs from corner e to corner e + 1, and is opposite corner e + 2. Unit
/// vectors: n the normal, t_e along the edge, nu_e = t_e x n in the plane and outward. g_i is the
/// gradient of hat function i, -nu_{i+1} length_{i+1} / 2A.
struct Surface {
  struct Face {
    std::array<Index, 3> vertices;
    std::array<Index, 3> edges;
    Vec3 normal;
    std::array<Vec3, 3> along;                  ///< t_e
    std::array<Vec3, 3> outward;                ///< nu_e
    std::array<double, 3> length;               ///< of the edges
    std::array<double, 3> share;                ///< length_{i+1} / 2A: lambda_i = rho_{i+1} share_i
    std::array<std::array<double, 3>, 3> slope; ///< g_i . nu_e at [i][e]
    double twice_area = 0;
    /// rho_e and the height as affine functions of the point: x, y, z and the constant.
    std::array<std::array<double, 4>, 3> rho;
    std::array<double, 4> height;
  };
  struct Edge {
    Index from, to;
    Vec3 along;
    double length = 0;
  };

  CageFrame frame;
  std::size_t cage_vertices = 0; ///< C
  bool is_turned = false;        ///< the cage was inside out
  std::vector<std::array<Index, 4>> quads;
  std::vector<Vec3> positions; ///< with the middles, in the frame
  std::vector<Face> faces;
  std::vector<std::size_t> source; ///< of each face, which triangle of the cut cage it is
  std::vector<Edge> edges;

  /// Errors: invalid_cage (as check_surface() and frame_of() say; no face with area).
  static Result<Surface> create(const PolygonMesh& cage, QuadTreatment quads);

  /// Any triangles with area, open or closed, of positions in a frame.
  static Surface of_triangles(const CageFrame& frame, std::vector<Vec3> positions,
                              std::span<const Triangle> triangles);

  /// The corners of each triangle.
  [[nodiscard]] std::vector<Triangle> triangles() const;

  /// Which vertices and middles have faces, in order.
  [[nodiscard]] std::vector<Index> used_vertices() const;

  /// The weights of middles are shared by the corners: the first C of `weights` are then complete.
  template <class T> void share_middles(std::span<T> weights, std::size_t stride = 1) const {
    for (std::size_t q = 0; q < quads.size(); ++q) {
      for (const Index corner : quads[q]) {
        weights[corner * stride] += weights[(cage_vertices + q) * stride] / 4;
      }
    }
  }

private:
  void connect(std::span<const Triangle> triangles);
};

} // namespace cagewright
