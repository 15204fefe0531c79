/// \file
/// What is computed once for a cage, and the vector code that reads it. Internal to this module.
#pragma once

#include <cagewright/coordinates/mean_value.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cagewright {

/// A cage prepared for the kernel in numbers of type T: moved to the origin and scaled by a power
/// of two to a diagonal in [0.5, 1).
template <class T> struct MeanValueTables {
  struct Vertex {
    T x, y, z;
    T square; ///< of the distance to the origin
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
    Vertex center;              ///< the mean of the corners
    T radius2;                  ///< square of the greatest distance of a corner from it
    std::array<T, 3> length2;   ///< length2[i]: square of the edge opposite vertices[i]
  };
  /// A rule for integrating over a triangle.
  struct Rule {
    struct Node {
      std::array<T, 3> lambda;   ///< barycentric coordinates
      std::array<T, 3> products; ///< products[i]: of the two lambdas besides i
      std::array<T, 3> weighted; ///< lambda times the node's weight; all weights sum to 1
    };
    T least_ratio2 = 0; ///< distance over radius, squared, from which on it is exact to rounding
    std::vector<Node> nodes;
  };

  /// Ordered from the fewest nodes, for the most distant points, to the most.
  std::vector<Rule> rules;
  /// Sum over the faces of signed height times area: three times the volume, for closed cages.
  Affine flux;
  T outside2 = 0;   ///< square of the distance from the origin beyond which `rules` are used
  T least_flux = 0; ///< a sum of weights far away that is smaller is noise

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

/// Where the weights of sixteen points go: those for cage vertex c begin at first[c * stride].
template <class T> struct WeightsOut {
  T* first;
  std::size_t stride;
};

/// The three variants of the kernel, for the best instruction set of this machine.
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           WeightsOut<double> out);
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<double>& points,
                           WeightsOut<float> out);
TileReport mean_value_tile(const MeanValueSolver::Tables& cage, const PointTile<float>& points,
                           WeightsOut<float> out);

} // namespace cagewright
