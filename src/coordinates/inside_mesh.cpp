#include "coordinates/inside_mesh.h"

#include "coordinates/delaunay.h"
#include "core/maths.h"
#include "core/parallel.h"
#include "mesh/solid_angle.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace cagewright {
namespace {

/// Points inside are not nearer to the cage than this, nor points of a face to its edges; in
/// spacings.
constexpr double keep_off = 0.6;
/// Further points on the cage are not nearer to one another.
constexpr double least_spacing = 0.15;
/// A tetrahedron flatter than this, of an even one's 1, carries nothing.
constexpr double flat = 0.02;
/// The edge of a cube of the lattice inside, which has a point in its middle, too.
constexpr double lattice_step = 1.15;

using Edge = std::pair<Index, Index>;

Edge edge_of(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

/// 6 sqrt 2 times the volume over the cube of the edges' root mean square: 1 for an even one.
double evenness(const std::array<const Vec3*, 4>& p) {
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      squares += (*p[i] - *p[j]).squaredNorm();
    }
  }
  const double size = std::sqrt(squares / 6);
  const double volume = std::abs((*p[1] - *p[0]).cross(*p[2] - *p[0]).dot(*p[3] - *p[0])) / 6;
  return 6 * std::numbers::sqrt2 * volume / (size * size * size);
}

class InsideMesher {
public:
  InsideMesher(const Surface& surface, double spacing)
      : surface_(surface), spacing_(spacing), triangles_(surface.triangles()),
        bvh_(TriangleView{surface.positions, triangles_}),
        of_vertex_(surface.positions.size(), none) {}

  Result<InsideMesh> make(const Progress& progress) {
    add_cage();
    add_lattice();
    std::vector<Delaunay::Cell> cells;
    constexpr int rounds = 6;
    for (int round = 0; round < rounds; ++round) {
      if (progress.cancelled()) {
        return Error::cancelled();
      }
      insert_new();
      cells = delaunay_.cells();
      keep_inside(cells);
      progress(static_cast<double>(round + 1) / rounds, "bind");
      if (round + 1 == rounds || !add_where_missing(cells)) {
        break;
      }
    }
    return finished(cells);
  }

private:
  static constexpr Index none = NearestPoint::none;

  struct Point {
    Vec3 x;
    std::optional<CagePlace> place; ///< on the cage
  };

  Index add(const Vec3& x, std::optional<CagePlace> place) {
    points_.push_back({x, place});
    return static_cast<Index>(points_.size() - 1);
  }

  [[nodiscard]] Vec3 at(const CagePlace& place) const {
    Vec3 x = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      x += place.hats[i] * surface_.positions[surface_.faces[place.face].vertices[i]];
    }
    return x;
  }

  /// Vertices, edges and faces of the cage.
  void add_cage() {
    std::vector<std::uint8_t> is_done(surface_.edges.size(), 0);
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
      const Surface::Face& face = surface_.faces[f];
      for (std::size_t k = 0; k < 3; ++k) {
        if (of_vertex_[face.vertices[k]] == none) {
          CagePlace corner{f, {}};
          corner.hats[k] = 1;
          of_vertex_[face.vertices[k]] = add(surface_.positions[face.vertices[k]], corner);
        }
      }
    }
    for (std::size_t f = 0; f < surface_.faces.size(); ++f) {
      for (std::size_t e = 0; e < 3; ++e) {
        if (std::exchange(is_done[surface_.faces[f].edges[e]], std::uint8_t(1)) == 0) {
          add_edge(f, e);
        }
      }
      add_face(f);
    }
  }

  void add_edge(std::size_t f, std::size_t e) {
    const Surface::Face& face = surface_.faces[f];
    const auto pieces = std::max(1, static_cast<int>(std::ceil(face.length[e] / spacing_ - 1e-9)));
    Index last = of_vertex_[face.vertices[e]];
    for (int i = 1; i <= pieces; ++i) {
      Index next = of_vertex_[face.vertices[(e + 1) % 3]];
      if (i < pieces) {
        CagePlace place{f, {}};
        place.hats[(e + 1) % 3] = static_cast<double>(i) / pieces;
        place.hats[e] = 1 - place.hats[(e + 1) % 3];
        next = add(at(place), place);
      }
      segments_.push_back(edge_of(last, next));
      last = next;
    }
  }

  /// Points of a triangular lattice along the longest edge, round the middle.
  void add_face(std::size_t f) {
    const Surface::Face& face = surface_.faces[f];
    const auto longest = static_cast<std::size_t>(
        std::max_element(face.length.begin(), face.length.end()) - face.length.begin());
    const Vec3& u = face.along[longest];
    const Vec3 v = -face.outward[longest];
    const Vec3 middle = at({f, {1.0 / 3, 1.0 / 3, 1.0 / 3}});
    const int reach = static_cast<int>(std::ceil(2 * face.length[longest] / spacing_)) + 1;
    const double row = spacing_ * std::sqrt(0.75);
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const double along = spacing_ * (i + ((j % 2) != 0 ? 0.5 : 0.0));
        const Vec3 x = middle + along * u + row * j * v;
        CagePlace place{f, {}};
        bool is_inside = true;
        for (std::size_t k = 0; k < 3 && is_inside; ++k) {
          const std::size_t e = (k + 1) % 3;
          const double off = face.outward[e].dot(surface_.positions[face.vertices[e]] - x);
          is_inside = off >= keep_off * spacing_;
          place.hats[k] = face.share[k] * off;
        }
        if (is_inside) {
          add(x, place);
        }
      }
    }
  }

  [[nodiscard]] bool is_inside(const Vec3& x) const {
    double angle = 0;
    for (const Triangle& t : triangles_) {
      angle += solid_angle(x, surface_.positions[t[0]], surface_.positions[t[1]],
                           surface_.positions[t[2]]);
    }
    return angle > 2 * std::numbers::pi;
  }

  void add_lattice() {
    const double step = lattice_step * spacing_;
    const Box3 box = bounding_box(surface_.positions);
    const Vec3 start = box.center() - 0.5 * box.sizes();
    const auto count = [&](int axis) {
      return static_cast<std::size_t>(2 * box.sizes()[axis] / step) + 2; // half steps
    };
    std::vector<std::vector<Vec3>> slices(count(0));
    parallel_for(0, slices.size(), 1, [&](std::size_t i) {
      for (std::size_t j = i % 2; j < count(1); j += 2) {
        for (std::size_t k = i % 2; k < count(2); k += 2) {
          const Vec3 x =
              start + step / 2 *
                          Vec3(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5,
                               static_cast<double>(k) + 0.5);
          if (!bvh_.nearest(x, keep_off * spacing_) && is_inside(x)) {
            slices[i].push_back(x);
          }
        }
      }
    });
    for (const std::vector<Vec3>& slice : slices) {
      for (const Vec3& x : slice) {
        add(x, {});
      }
    }
  }

  /// Points that are not yet in the mesh; in rounds, each over all space (Amenta, Choi, Rote 2003),
  /// so that no tetrahedron stays long.
  void insert_new() {
    struct Turn {
      int round;
      std::uint64_t along; ///< a curve that stays near
      Index point;
    };
    std::vector<Turn> turns;
    for (std::size_t i = inserted_.size(); i < points_.size(); ++i) {
      std::uint64_t hash = (i + 1) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 31U;
      const int round = hash == 0 ? 0 : -std::min(std::countr_zero(hash), 10);
      turns.push_back({round, along_curve(points_[i].x), static_cast<Index>(i)});
    }
    std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
      return std::tie(a.round, a.along, a.point) < std::tie(b.round, b.along, b.point);
    });
    inserted_.resize(points_.size());
    for (const Turn& turn : turns) {
      delaunay_.insert(points_[turn.point].x);
      name_.push_back(turn.point);
    }
  }

  static std::uint64_t along_curve(const Vec3& x) {
    std::uint64_t bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = static_cast<std::uint64_t>((x[axis] + 1) * 512);
      for (unsigned b = 0; b < 10; ++b) {
        bits |= (place >> b & 1U) << (3 * b + static_cast<unsigned>(axis));
      }
    }
    return bits;
  }

  /// Leaves those that are inside, or partly; in names of points.
  void keep_inside(std::vector<Delaunay::Cell>& cells) const {
    std::vector<std::uint8_t> is_kept(cells.size(), 0);
    parallel_for(0, cells.size(), 256, [&](std::size_t c) {
      bool has_inner = false;
      Vec3 middle = Vec3::Zero();
      for (Index& v : cells[c]) {
        v = name_[v];
        has_inner = has_inner || !points_[v].place;
        middle += points_[v].x / 4;
      }
      is_kept[c] = has_inner || is_inside(middle) ? 1 : 0;
    });
    std::size_t kept = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (is_kept[c] != 0) {
        cells[kept++] = cells[c];
      }
    }
    cells.resize(kept);
  }

  static std::vector<Edge> edges_of(const std::vector<Delaunay::Cell>& cells) {
    std::vector<Edge> edges;
    for (const Delaunay::Cell& cell : cells) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = i + 1; j < 4; ++j) {
          edges.push_back(edge_of(cell[i], cell[j]));
        }
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
  }

  /// Where an edge goes through the cage, if it does.
  [[nodiscard]] std::optional<CagePlace> crossing(const Edge& edge) const {
    const Vec3& a = points_[edge.first].x;
    const Vec3& b = points_[edge.second].x;
    const double touching = 1e-4 * spacing_;
    std::optional<CagePlace> found;
    bvh_.visit_segment(a, b, [&](Index f) {
      const Surface::Face& face = surface_.faces[f];
      const Vec3& on = surface_.positions[face.vertices[0]];
      const double at_a = face.normal.dot(a - on);
      const double at_b = face.normal.dot(b - on);
      if (std::abs(at_a) <= touching || std::abs(at_b) <= touching || (at_a > 0) == (at_b > 0)) {
        return true;
      }
      const Vec3 x = a + at_a / (at_a - at_b) * (b - a);
      CagePlace place{f, {}};
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t e = (k + 1) % 3;
        const double off = face.outward[e].dot(surface_.positions[face.vertices[e]] - x);
        if (off < -touching) {
          return true;
        }
        place.hats[k] = std::max(0.0, face.share[k] * off);
        sum += place.hats[k];
      }
      for (double& hat : place.hats) {
        hat /= sum;
      }
      found = place;
      return false;
    });
    return found;
  }

  [[nodiscard]] std::vector<std::optional<CagePlace>>
  crossings(const std::vector<Edge>& edges) const {
    std::vector<std::optional<CagePlace>> found(edges.size());
    parallel_for(0, edges.size(), 256, [&](std::size_t i) { found[i] = crossing(edges[i]); });
    return found;
  }

  /// Adds points to the cage. \returns whether it has
  bool add_where_missing(const std::vector<Delaunay::Cell>& cells) {
    const std::size_t before = points_.size();
    const std::vector<Edge> edges = edges_of(cells);
    std::vector<Edge> segments;
    for (const Edge& segment : segments_) {
      const double length = (points_[segment.first].x - points_[segment.second].x).norm();
      if (length < 2 * least_spacing * spacing_ ||
          std::binary_search(edges.begin(), edges.end(), segment)) {
        segments.push_back(segment);
        continue;
      }
      const Index middle = split(segment);
      segments.push_back(edge_of(segment.first, middle));
      segments.push_back(edge_of(middle, segment.second));
    }
    segments_ = std::move(segments);
    for (const std::optional<CagePlace>& place : crossings(edges)) {
      if (!place) {
        continue;
      }
      const Vec3 x = at(*place);
      const bool is_near = std::any_of(
          points_.begin() + static_cast<std::ptrdiff_t>(before), points_.end(),
          [&](const Point& p) { return (p.x - x).norm() < 2 * least_spacing * spacing_; });
      if (!is_near) {
        add(x, place);
      }
    }
    return points_.size() > before;
  }

  /// The middle of a piece of a cage's edge.
  Index split(const Edge& segment) {
    const Vec3 x = (points_[segment.first].x + points_[segment.second].x) / 2;
    const NearestPoint nearest = bvh_.nearest(x);
    const Surface::Face& face = surface_.faces[nearest.triangle];
    CagePlace place{nearest.triangle, {}};
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t e = (k + 1) % 3;
      place.hats[k] =
          std::max(0.0, face.share[k] * face.outward[e].dot(surface_.positions[face.vertices[e]] -
                                                            nearest.point));
      sum += place.hats[k];
    }
    for (double& hat : place.hats) {
      hat /= sum;
    }
    return add(x, place);
  }

  /// Without those that cross the cage, or are flat, and with points of the others alone.
  Result<InsideMesh> finished(std::vector<Delaunay::Cell> cells) const {
    const std::vector<Edge> edges = edges_of(cells);
    const std::vector<std::optional<CagePlace>> crossed = crossings(edges);
    std::erase_if(cells, [&](const Delaunay::Cell& cell) {
      std::array<const Vec3*, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = &points_[cell[i]].x;
        for (std::size_t j = i + 1; j < 4; ++j) {
          const auto edge = std::lower_bound(edges.begin(), edges.end(), edge_of(cell[i], cell[j]));
          if (crossed[static_cast<std::size_t>(edge - edges.begin())]) {
            return true;
          }
        }
      }
      return evenness(corners) < flat;
    });
    if (cells.empty()) {
      return Error{ErrorCode::invalid_cage, "the cage has nothing inside"};
    }
    std::vector<Index> fresh(points_.size(), none);
    for (const Delaunay::Cell& cell : cells) {
      for (const Index v : cell) {
        fresh[v] = 0;
      }
    }
    InsideMesh mesh;
    for (const bool on_cage : {true, false}) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (fresh[i] != none && points_[i].place.has_value() == on_cage) {
          fresh[i] = static_cast<Index>(mesh.positions.size());
          mesh.positions.push_back(points_[i].x);
          if (on_cage) {
            mesh.on_cage.push_back(*points_[i].place);
          }
        }
      }
    }
    for (Delaunay::Cell& cell : cells) {
      for (Index& v : cell) {
        v = fresh[v];
      }
    }
    mesh.cells = std::move(cells);
    return mesh;
  }

  const Surface& surface_;
  double spacing_;
  std::vector<Triangle> triangles_;
  TriangleBvh bvh_;
  std::vector<Index> of_vertex_; // of the surface: its point
  std::vector<Point> points_;
  std::vector<std::uint8_t> inserted_;
  std::vector<Index> name_;    // of what was inserted, in order: its point
  std::vector<Edge> segments_; // into which the cage's edges are cut
  Delaunay delaunay_;
};

} // namespace

double spacing_for(const Surface& surface, std::size_t points) {
  const std::vector<Triangle> triangles = surface.triangles();
  const TriangleView mesh{surface.positions, triangles};
  const double volume = std::abs(signed_volume(mesh));
  const double area = surface_area(mesh);
  // Two points in a cube of the lattice, and one in sqrt(3)/2 of a square on the cage. Fat cages
  // have most inside, where they cost most.
  constexpr double most_inside = 0.4;
  const auto count = [&](double spacing) {
    const double inside = 2 * volume / maths::cube(lattice_step * spacing);
    const double on_cage = area / (std::sqrt(0.75) * spacing * spacing);
    return std::max(inside + on_cage, inside / most_inside);
  };
  double low = 0;
  double high = surface.frame.scaled_diagonal();
  for (int i = 0; i < 50; ++i) {
    const double middle = (low + high) / 2;
    (count(middle) > static_cast<double>(points) ? low : high) = middle;
  }
  return high;
}

Result<InsideMesh> inside_mesh(const Surface& surface, double spacing, const Progress& progress) {
  return InsideMesher(surface, spacing).make(progress);
}

} // namespace cagewright
