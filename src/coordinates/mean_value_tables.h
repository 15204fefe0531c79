/// \file
/// What is computed once for a cage, and the vector code that reads it. Internal to this module.
#pragma once

#include "coordinates/mean_value.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cagewright {

/// A cage prepared for the kernel in numbers of type T: moved to the origin and scaled by a power
/// of two to a diagonal in [0.5, 1).
template <class T> struct MeanValueTables {
  struct Vertex {
    T x, y, z;
  };
  struct Edge {
    Index from, to;
    T length;
    T x, y, z; ///< to - from
  };
  /// An affine function of the point: x, y, z and the constant.
  using Affine = std::array<T, 4>;
  struct Face {
    std::array<Index, 3> vertices;
    std::array<Index, 3> edges; ///< edges[i] is opposite vertices[i]
    Affine lambda_0, lambda_1;  ///< barycentric coordinates of the point's projection
    Affine delta;               ///< signed height over twice the area, positive behind the face
    std::array<T, 3> kappa;     ///< kappa[i]: scalar product of the two edge vectors at vertex i
    T area2;                    ///< twice the area
  };

  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

struct MeanValueSolver::Tables {
  Vec3 center = Vec3::Zero();
  double scale = 1;
  std::size_t cage_vertices = 0; ///< C: without the middles of quads
  /// Corners of the quads whose middles are the vertices from C on.
  std::vector<std::array<Index, 4>> quads;
  std::vector<std::uint8_t> used; ///< whether a vertex has faces
  MeanValueTables<double> in_double;
  MeanValueTables<float> in_float;
};

/// Sixteen points, moved and scaled as the cage was.
template <class T> struct PointTile { alignas(64) std::array<T, 16> x, y, z; };

/// The three variants of the kernel, for the best instruction set of this machine. `tile` takes
/// 16 C weights.
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           double* tile);
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           float* tile);
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<float>& points,
                           float* tile);

} // namespace cagewright
