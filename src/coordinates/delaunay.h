/// \file
/// The Delaunay tetrahedra of points. Internal to this module.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cagewright {

/// Points are inserted one after the other (Bowyer 1981, Watson 1981). They are rounded to a grid
/// of integers, on which all predicates are exact, and moved there by a few steps of it, so that no
/// five lie on a sphere: what is given are the tetrahedra of points 1e-6 beside those inserted.
class Delaunay {
public:
  using Cell = std::array<Index, 4>;

  Delaunay();

  /// Points must lie within [-0.9, 0.9]^3; the n-th is called n from then on.
  /// \returns false: it falls together with another, and is in no tetrahedron
  bool insert(const Vec3& point);

  /// Those of which all corners were inserted.
  [[nodiscard]] std::vector<Cell> cells() const;

private:
  struct Place {
    std::int64_t x = 0, y = 0, z = 0;
  };
  struct Tetrahedron {
    Cell corners;
    std::array<std::int32_t, 4> beside; ///< what lies across the face opposite to each corner
  };
  /// A face of the hole round a new point.
  struct Rim {
    std::int32_t cell;
    unsigned face;
  };
  /// A face of a new tetrahedron that has the new point as a corner, by its other two.
  struct Side {
    Index low, high;
    std::int32_t cell;
    unsigned face;
  };

  static int orientation(const Place& a, const Place& b, const Place& c, const Place& d);
  static bool in_sphere(const Place& a, const Place& b, const Place& c, const Place& d,
                        const Place& e);

  [[nodiscard]] std::int32_t find(const Place& p) const;
  bool try_insert(Index name);
  [[nodiscard]] bool is_in_conflict(std::int32_t cell, const Place& p) const;
  void fill_hole(Index name);

  std::vector<Place> places_; // those of the box round all first
  std::vector<Tetrahedron> cells_;
  std::vector<std::uint32_t> seen_; // 2 n: not in the hole of the n-th try, 2 n + 1: in it
  std::vector<std::int32_t> free_;
  std::uint32_t tries_ = 0;
  std::int32_t last_ = 0;
  // Room for a try.
  std::vector<std::int32_t> hole_;
  std::vector<Rim> rim_;
  std::vector<Side> sides_;
};

} // namespace cagewright
