#include "cage/openings.h"

#include "core/parallel.h"
#include "mesh/edge_chains.h"
#include "mesh/shapes.h"
#include "mesh/topology.h"
#include "obb/principal_axes.h"
#include "spatial/bvh.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

namespace cagewright {
namespace {

using Cell = std::array<int, 3>;

// ---- Loops of boundary edges

/// The second longest edge of the box of a loop.
double width_of(std::span<const Vec3> loop) {
  Vec3 half = pca_box(loop).half;
  std::sort(half.begin(), half.end());
  return 2 * half[1];
}

/// A cap for every loop of boundary edges.
void close_loops(TriangleView model, double widest, Closures& closures) {
  const TriangleMesh welded = weld(model);
  const TopologyReport report = topology(TriangleView(welded));
  PolygonMesh caps;
  for (const EdgeChain& chain : chains_of(report.boundary_edges)) {
    std::vector<Vec3> loop;
    for (const Index v : chain.vertices) {
      loop.push_back(welded.positions[v]);
    }
    if (!chain.closed || loop.size() < 3) {
      continue;
    }
    if (widest > 0 && width_of(loop) > widest) {
      ++closures.too_wide;
      continue;
    }
    const auto first = static_cast<Index>(caps.positions.size());
    std::vector<Index> corners(loop.size());
    std::iota(corners.rbegin(), corners.rend(), first); // the other way round than the faces
    caps.positions.insert(caps.positions.end(), loop.begin(), loop.end());
    caps.add_face(corners);
    ++closures.closed;
  }
  closures.mesh = to_triangle_mesh(caps);
}

// ---- Hollows

/// Directions of lines, each once, with small whole numbers.
std::vector<Cell> line_directions() {
  constexpr int reach = 3;
  std::vector<Cell> directions;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const bool is_first = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
        if (is_first && std::gcd(std::gcd(std::abs(x), std::abs(y)), std::abs(z)) == 1) {
          directions.push_back({x, y, z});
        }
      }
    }
  }
  return directions;
}

Vec3 vector_of(const Cell& d) {
  return {static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2])};
}

constexpr std::size_t words = 3; // of 64 lines each: there are 145
using Lines = std::array<std::uint64_t, words>;

constexpr int lines_in_plane = 8;
constexpr int lines_that_meet = 7;

/// For each line the plane across it: the lines most nearly at right angles to it.
std::vector<Lines> planes_of(const std::vector<Cell>& directions) {
  std::vector<Lines> planes;
  for (const Cell& normal : directions) {
    const Vec3 n = vector_of(normal).normalized();
    std::vector<std::pair<double, std::size_t>> by_angle;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      by_angle.emplace_back(std::abs(n.dot(vector_of(directions[i]).normalized())), i);
    }
    std::sort(by_angle.begin(), by_angle.end());
    Lines plane{};
    for (std::size_t k = 0; k < lines_in_plane; ++k) {
      const std::size_t i = by_angle[k].second;
      plane[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    planes.push_back(plane);
  }
  return planes;
}

/// How far it is from every voxel to the next occupied one along a direction; infinite: there is
/// none.
class Sweep {
public:
  explicit Sweep(const VoxelGrid& grid) : grid_(grid), far_(grid.kinds.size()) {}

  const std::vector<float>& along(const Cell& d) {
    const int steps = std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    std::vector<Cell> way; // cells that are passed
    for (int k = 1; k <= steps; ++k) {
      const auto at = [&](std::size_t a) {
        return static_cast<int>(std::lround(static_cast<double>(d[a] * k) / steps));
      };
      way.push_back({at(0), at(1), at(2)});
    }
    const auto length = static_cast<float>(vector_of(d).norm());
    Cell c{};
    for (int z = 0; z < grid_.dims[2]; ++z) {
      c[2] = d[2] > 0 ? grid_.dims[2] - 1 - z : z;
      for (int y = 0; y < grid_.dims[1]; ++y) {
        c[1] = d[1] > 0 ? grid_.dims[1] - 1 - y : y;
        for (int x = 0; x < grid_.dims[0]; ++x) {
          c[0] = d[0] > 0 ? grid_.dims[0] - 1 - x : x;
          far_[grid_.index(c)] = from(c, way, length);
        }
      }
    }
    return far_;
  }

private:
  [[nodiscard]] float from(const Cell& c, const std::vector<Cell>& way, float length) const {
    constexpr float none = std::numeric_limits<float>::infinity();
    std::size_t at = 0;
    for (std::size_t k = 0; k < way.size(); ++k) {
      const Cell next = {c[0] + way[k][0], c[1] + way[k][1], c[2] + way[k][2]};
      for (std::size_t a = 0; a < 3; ++a) {
        if (next[a] < 0 || next[a] >= grid_.dims[a]) {
          return none;
        }
      }
      at = grid_.index(next);
      if (grid_.occupied(at)) {
        return length * static_cast<float>(k + 1) / static_cast<float>(way.size());
      }
    }
    return far_[at] + length;
  }

  const VoxelGrid& grid_;
  std::vector<float> far_;
};

/// Of each voxel the lines that meet the surface on both sides, and of these the narrow ones.
struct Sights {
  std::vector<Lines> met;
  std::vector<Lines> narrow;
};

/// \param widest  in voxels; 0: every line is narrow
Sights sights_of(const VoxelGrid& grid, const std::vector<Cell>& directions, double widest,
                 const Progress& progress) {
  Sights sights{std::vector<Lines>(grid.kinds.size()), std::vector<Lines>(grid.kinds.size())};
  parallel_for(0, words, 1, [&](std::size_t word) {
    Sweep ahead(grid);
    Sweep behind(grid);
    const std::size_t end = std::min(directions.size(), 64 * (word + 1));
    for (std::size_t i = 64 * word; i < end && !progress.cancelled(); ++i) {
      const Cell& d = directions[i];
      const std::vector<float>& one = ahead.along(d);
      const std::vector<float>& other = behind.along({-d[0], -d[1], -d[2]});
      const std::uint64_t bit = std::uint64_t{1} << (i % 64);
      for (std::size_t v = 0; v < one.size(); ++v) {
        const float chord = one[v] + other[v];
        if (std::isfinite(chord)) {
          sights.met[v][word] |= bit;
          sights.narrow[v][word] |= widest == 0 || chord <= widest ? bit : 0;
        }
      }
    }
  });
  return sights;
}

int common(const Lines& a, const Lines& b) {
  int count = 0;
  for (std::size_t w = 0; w < words; ++w) {
    count += std::popcount(a[w] & b[w]);
  }
  return count;
}

enum class Surrounding : std::uint8_t { none, narrow, wide };

Surrounding surrounding_of(const Lines& met, const Lines& narrow,
                           const std::vector<Lines>& planes) {
  Surrounding found = Surrounding::none;
  for (const Lines& plane : planes) {
    if (common(met, plane) >= lines_that_meet) {
      if (common(narrow, plane) > 0) {
        return Surrounding::narrow;
      }
      found = Surrounding::wide;
    }
  }
  return found;
}

/// Calls visit(index) for the neighbors of a voxel, `across` 1: those it shares a face with, 3: a
/// corner. Voxels of the outermost layer have none.
template <class Visit>
void for_neighbors(const VoxelGrid& grid, std::size_t at, int across, const Visit& visit) {
  const Cell c = grid.cell(at);
  for (std::size_t a = 0; a < 3; ++a) {
    if (c[a] == 0 || c[a] + 1 == grid.dims[a]) {
      return;
    }
  }
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const int apart = std::abs(x) + std::abs(y) + std::abs(z);
        if (apart > 0 && apart <= across) {
          visit(grid.index(c[0] + x, c[1] + y, c[2] + z));
        }
      }
    }
  }
}

/// What hangs together with a voxel among those of a label, which get another.
std::vector<std::size_t> part_from(const VoxelGrid& grid, std::vector<int>& labels,
                                   std::size_t seed, int across, int label) {
  const int from = labels[seed];
  std::vector<std::size_t> part = {seed};
  labels[seed] = label;
  for (std::size_t i = 0; i < part.size(); ++i) {
    for_neighbors(grid, part[i], across, [&](std::size_t next) {
      if (labels[next] == from) {
        labels[next] = label;
        part.push_back(next);
      }
    });
  }
  return part;
}

// Labels of voxels while hollows are looked for; parts of them are numbered from 1.
constexpr int no_hollow = 0;
constexpr int candidate = -1;

/// A hollow, in voxels.
struct Hollow {
  std::vector<std::size_t> voxels;
  std::vector<double> mouths; ///< areas
};

/// The openings of a hollow to the outside: the voxels before it, as they hang together.
std::vector<double> mouths_of(const VoxelGrid& grid, const std::vector<int>& labels,
                              const std::vector<std::size_t>& hollow) {
  const int own = labels[hollow.front()];
  std::vector<int> before(labels.size(), 0);
  std::vector<std::size_t> voxels;
  for (const std::size_t v : hollow) {
    for_neighbors(grid, v, 1, [&](std::size_t next) {
      if (!grid.occupied(next) && labels[next] != own && before[next] == 0) {
        before[next] = 1;
        voxels.push_back(next);
      }
    });
  }
  std::vector<double> areas;
  for (const std::size_t v : voxels) {
    if (before[v] == 1) {
      areas.push_back(static_cast<double>(part_from(grid, before, v, 3, 2).size()));
    }
  }
  return areas;
}

bool is_to_be_filled(const Hollow& hollow) {
  constexpr double least_depth = 0.5; // of the width of the mouths
  constexpr double counts = 0.1;      // of the greatest mouth
  double greatest = 0;
  for (const double area : hollow.mouths) {
    greatest = std::max(greatest, area);
  }
  double sum = 0;
  int count = 0;
  for (const double area : hollow.mouths) {
    if (area >= counts * greatest) {
      sum += area;
      ++count;
    }
  }
  if (count <= 1) {
    return true;
  }
  const double mean = sum / count;
  const double depth = static_cast<double>(hollow.voxels.size()) / (sum / 2);
  return depth >= least_depth * std::sqrt(mean);
}

/// The surface of what was filled, where it is no wall: through the middles of voxels.
class ClosureMesh {
public:
  ClosureMesh(const VoxelGrid& grid, const std::vector<bool>& filled, TriangleView walls)
      : grid_(grid), filled_(filled), walls_(walls), number_(grid.kinds.size(), none) {}

  TriangleMesh made() {
    for (std::size_t v = 0; v < filled_.size(); ++v) {
      if (is_solid(v)) {
        for (int axis = 0; axis < 3; ++axis) {
          add_square(v, axis);
        }
      }
    }
    return std::move(mesh_);
  }

private:
  static constexpr Index none = std::numeric_limits<Index>::max();

  [[nodiscard]] bool is_solid(std::size_t v) const { return filled_[v] || grid_.occupied(v); }

  // The square of four middles across an axis, from its least corner. There is an outer layer all
  // round, so that no square is missed at the ends of rows.
  void add_square(std::size_t v, int axis) {
    const std::size_t b = grid_.stride((axis + 1) % 3);
    const std::size_t c = grid_.stride((axis + 2) % 3);
    const std::array<std::size_t, 4> square = {v, v + b, v + b + c, v + c};
    if (square[2] >= filled_.size() || !are_solid(square)) {
      return;
    }
    if (std::none_of(square.begin(), square.end(), [&](std::size_t k) { return filled_[k]; })) {
      return;
    }
    const std::size_t a = grid_.stride(axis);
    const bool above = are_solid(moved(square, a));
    const bool below = are_solid(moved(square, std::size_t{0} - a));
    if (above && below) {
      return;
    }
    std::array<Index, 4> q{};
    for (std::size_t k = 0; k < 4; ++k) {
      q[k] = vertex_of(square[above ? 3 - k : k]);
    }
    mesh_.triangles.push_back({q[0], q[1], q[2]});
    mesh_.triangles.push_back({q[0], q[2], q[3]});
  }

  static std::array<std::size_t, 4> moved(std::array<std::size_t, 4> square, std::size_t by) {
    for (std::size_t& k : square) {
      k += by;
    }
    return square;
  }

  [[nodiscard]] bool are_solid(const std::array<std::size_t, 4>& square) const {
    return std::all_of(square.begin(), square.end(),
                       [&](std::size_t k) { return k < filled_.size() && is_solid(k); });
  }

  // On the surface its nearest point: the middle of the voxel may be outside the model.
  Index vertex_of(std::size_t v) {
    if (number_[v] == none) {
      number_[v] = static_cast<Index>(mesh_.positions.size());
      const Vec3 middle = grid_.center(v);
      const bool is_wall = grid_.kinds[v] == VoxelKind::feature;
      mesh_.positions.push_back(is_wall ? walls_.nearest(middle).point : middle);
    }
    return number_[v];
  }

  const VoxelGrid& grid_;
  const std::vector<bool>& filled_;
  TriangleBvh walls_;
  std::vector<Index> number_;
  TriangleMesh mesh_;
};

/// Marks the voxels of hollows that are to be filled.
std::vector<bool> filled_hollows(const VoxelGrid& grid, double widest, const Progress& progress,
                                 Closures& closures) {
  constexpr std::size_t least_voxels = 27;
  const std::vector<Cell> directions = line_directions();
  const std::vector<Lines> planes = planes_of(directions);
  const Sights sights = sights_of(grid, directions, widest / grid.size, progress);
  std::vector<Surrounding> surrounding(grid.kinds.size(), Surrounding::none);
  parallel_for(0, surrounding.size(), 1024, progress, [&](std::size_t v) {
    if (!grid.occupied(v)) {
      surrounding[v] = surrounding_of(sights.met[v], sights.narrow[v], planes);
    }
  });
  std::vector<bool> filled(grid.kinds.size(), false);
  std::vector<int> labels(grid.kinds.size(), no_hollow);
  for (const Surrounding wanted : {Surrounding::narrow, Surrounding::wide}) {
    for (std::size_t v = 0; v < labels.size(); ++v) {
      labels[v] = surrounding[v] == wanted ? candidate : no_hollow;
    }
    int label = 0;
    for (std::size_t v = 0; v < labels.size(); ++v) {
      if (labels[v] != candidate) {
        continue;
      }
      Hollow hollow{part_from(grid, labels, v, 1, ++label), {}};
      if (hollow.voxels.size() < least_voxels) {
        continue;
      }
      hollow.mouths = mouths_of(grid, labels, hollow.voxels);
      if (!is_to_be_filled(hollow)) {
        continue;
      }
      if (wanted == Surrounding::wide) {
        ++closures.too_wide;
        continue;
      }
      ++closures.closed;
      for (const std::size_t k : hollow.voxels) {
        filled[k] = true;
      }
    }
  }
  return filled;
}

} // namespace

Result<Closures> close_openings(TriangleView model, double widest, const Progress& progress) {
  Closures closures;
  close_loops(model, widest, closures);
  TriangleMesh walls;
  walls.positions.assign(model.positions.begin(), model.positions.end());
  walls.triangles.assign(model.triangles.begin(), model.triangles.end());
  walls = joined(walls, closures.mesh);
  const Box3 box = bounding_box(TriangleView(walls));
  OrientedBox frame;
  frame.center = box.center();
  constexpr double room = 0.05; // of the longest edge: some layers outside, before all mouths
  frame.half = box.sizes() / 2 + Vec3::Constant(room * box.sizes().maxCoeff());
  const Result<VoxelGrid> grid = voxelize(walls, frame, {}, progress);
  if (!grid) {
    return grid.error();
  }
  const std::vector<bool> filled = filled_hollows(*grid, widest, progress, closures);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  closures.mesh = joined(closures.mesh, ClosureMesh(*grid, filled, walls).made());
  return closures;
}

} // namespace cagewright
