#include "quads/grid_layout.h"

#include "envelope/well_composed.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

using Planes = std::array<std::vector<int>, 3>;
using Cell = std::array<int, 3>;

constexpr Index none = ~Index{0};

/// The filled cells between the planes, with a layer of outer cells all round.
VoxelGrid cells_between(const Planes& planes, const SolidGrid& solid) {
  VoxelGrid cells;
  for (int a = 0; a < 3; ++a) {
    cells.dims[a] = static_cast<int>(planes[a].size()) + 1;
  }
  cells.kinds.assign(cells.index(0, 0, cells.dims[2]), VoxelKind::outer);
  for (int k = 1; k + 1 < cells.dims[2]; ++k) {
    for (int j = 1; j + 1 < cells.dims[1]; ++j) {
      for (int i = 1; i + 1 < cells.dims[0]; ++i) {
        const Cell low{planes[0][i - 1], planes[1][j - 1], planes[2][k - 1]};
        const Cell high{planes[0][i], planes[1][j], planes[2][k]};
        if (solid.touches(low, high)) {
          cells.kinds[cells.index(i, j, k)] = VoxelKind::inner;
        }
      }
    }
  }
  return cells;
}

double volume_of(const VoxelGrid& cells, const Planes& planes) {
  double volume = 0;
  for (std::size_t c = 0; c < cells.kinds.size(); ++c) {
    if (cells.occupied(c)) {
      const auto [i, j, k] = cells.cell(c);
      volume += static_cast<double>(planes[0][i] - planes[0][i - 1]) *
                (planes[1][j] - planes[1][j - 1]) * (planes[2][k] - planes[2][k - 1]);
    }
  }
  return volume;
}

/// How many vertices the surface of the cells has, if it is manifold.
std::size_t vertices_of(const VoxelGrid& cells) {
  std::size_t count = 0;
  const std::array<std::size_t, 8> corner = [&] {
    std::array<std::size_t, 8> offsets{};
    for (std::size_t c = 0; c < 8; ++c) {
      offsets[c] = (c & 1U) + (c >> 1U & 1U) * cells.stride(1) + (c >> 2U) * cells.stride(2);
    }
    return offsets;
  }();
  for (int k = 0; k + 1 < cells.dims[2]; ++k) {
    for (int j = 0; j + 1 < cells.dims[1]; ++j) {
      for (int i = 0; i + 1 < cells.dims[0]; ++i) {
        const std::size_t at = cells.index(i, j, k);
        int filled = 0;
        for (const std::size_t c : corner) {
          filled += cells.occupied(at + c) ? 1 : 0;
        }
        count += filled != 0 && filled != 8 ? 1 : 0;
      }
    }
  }
  return count;
}

std::size_t faces_of(const VoxelGrid& cells) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < cells.kinds.size(); ++c) {
    for (int a = 0; a < 3 && cells.occupied(c); ++a) {
      count += cells.occupied(c + cells.stride(a)) ? 0 : 1;
      count += cells.occupied(c - cells.stride(a)) ? 0 : 1;
    }
  }
  return count;
}

class Search {
public:
  Search(const SolidGrid& solid, const GridLayoutOptions& options, const Progress& progress)
      : solid_(solid), options_(options), progress_(progress), middle_(solid.dims()[0] / 2) {}

  GridLayout run() {
    Planes planes;
    for (int a = 0; a < 3; ++a) {
      for (int p = solid_.low()[a]; p <= solid_.high()[a]; ++p) {
        planes[a].push_back(p);
      }
    }
    thin_out(planes);
    GridLayout layout = layout_of(std::move(planes));
    while (!progress_.cancelled() && most_ < layout.vertices && drop_one(layout)) {
    }
    constexpr int rounds = 6;
    for (int round = 0; round < rounds && !progress_.cancelled(); ++round) {
      const bool shifted = shift(layout);
      const bool exchanged = exchange(layout);
      if (!shifted && !exchanged) {
        break;
      }
    }
    return layout;
  }

private:
  // A plane with its mirror image.
  [[nodiscard]] bool is_fixed(int axis, int plane) const {
    return plane == solid_.low()[axis] || plane == solid_.high()[axis] ||
           (options_.half && axis == 0 && plane == middle_);
  }
  [[nodiscard]] int image(int plane) const { return 2 * middle_ - plane; }
  [[nodiscard]] bool is_paired(int axis) const { return options_.half && axis == 0; }
  [[nodiscard]] bool is_image(int axis, int plane) const {
    return is_paired(axis) && plane < middle_;
  }

  void erase(Planes& planes, int axis, int plane) const {
    std::erase(planes[axis], plane);
    if (is_paired(axis)) {
      std::erase(planes[axis], image(plane));
    }
  }
  void insert(Planes& planes, int axis, int plane) const {
    const auto add = [&](int p) {
      planes[axis].insert(std::upper_bound(planes[axis].begin(), planes[axis].end(), p), p);
    };
    add(plane);
    if (is_paired(axis)) {
      add(image(plane));
    }
  }

  [[nodiscard]] GridLayout layout_of(Planes planes) const {
    GridLayout layout;
    layout.cells = cells_between(planes, solid_);
    make_manifold(layout.cells, options_.half);
    layout.volume = volume_of(layout.cells, planes);
    layout.vertices = vertices_of(layout.cells);
    // Of a closed surface of quads: V - F = 2 - 2 g.
    const auto euler =
        static_cast<long>(layout.vertices) - static_cast<long>(faces_of(layout.cells));
    layout.genus = static_cast<int>(1 - euler / 2);
    layout.planes = std::move(planes);
    return layout;
  }

  /// Drops planes by their volume alone, until there are so few that more can be asked of each.
  void thin_out(Planes& planes) const {
    const std::size_t enough = 30 + static_cast<std::size_t>(most_) / 8;
    while (!progress_.cancelled() &&
           planes[0].size() + planes[1].size() + planes[2].size() > enough) {
      const VoxelGrid cells = cells_between(planes, solid_);
      double least = std::numeric_limits<double>::infinity();
      int best_axis = -1;
      int best = 0;
      for (int a = 0; a < 3; ++a) {
        const std::vector<double> costs = merging_costs(cells, planes, a);
        for (std::size_t p = 1; p + 1 < planes[a].size(); ++p) {
          double cost = costs[p];
          if (is_fixed(a, planes[a][p]) || is_image(a, planes[a][p])) {
            continue;
          }
          if (cost < least) {
            least = cost;
            best_axis = a;
            best = planes[a][p];
          }
        }
      }
      if (best_axis < 0) {
        return;
      }
      erase(planes, best_axis, best);
    }
  }

  /// By place of the plane: the volume of the cells on one side of it that are filled on the
  /// other only.
  static std::vector<double> merging_costs(const VoxelGrid& cells, const Planes& planes, int axis) {
    std::vector<double> costs(planes[axis].size(), 0);
    const auto extent = [&](int a, int i) {
      return static_cast<double>(planes[a][i] - planes[a][i - 1]);
    };
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    for (int k = 1; k + 1 < cells.dims[2]; ++k) {
      for (int j = 1; j + 1 < cells.dims[1]; ++j) {
        for (int i = 1; i + 1 < cells.dims[0]; ++i) {
          const Cell at{i, j, k};
          if (at[axis] + 2 >= cells.dims[axis]) {
            continue;
          }
          const std::size_t here = cells.index(at);
          const bool filled = cells.occupied(here);
          if (filled != cells.occupied(here + cells.stride(axis))) {
            costs[at[axis]] +=
                extent(b, at[b]) * extent(c, at[c]) * extent(axis, at[axis] + (filled ? 1 : 0));
          }
        }
      }
    }
    return costs;
  }

  struct Drop {
    double price = 0; // volume for each vertex saved
    GridLayout layout;
  };

  bool drop_one(GridLayout& layout) const {
    std::optional<Drop> best;
    for (int a = 0; a < 3; ++a) {
      for (const int plane : layout.planes[a]) {
        if (is_fixed(a, plane) || is_image(a, plane)) {
          continue;
        }
        Planes planes = layout.planes;
        erase(planes, a, plane);
        Drop drop{0, layout_of(std::move(planes))};
        if (drop.layout.vertices >= layout.vertices) {
          continue;
        }
        // No more saved than has to be.
        const double saved = static_cast<double>(
            layout.vertices - std::max(most_ - most_ / 20, drop.layout.vertices));
        drop.price = (cost_of(drop.layout) - cost_of(layout)) / std::max(1.0, saved);
        if (!best || drop.price < best->price) {
          best = std::move(drop);
        }
      }
    }
    if (best) {
      layout = std::move(best->layout);
    }
    return best.has_value();
  }

  /// A handle more is as bad as a twentieth more of volume.
  [[nodiscard]] double cost_of(const GridLayout& layout) const {
    return layout.volume * (1 + 0.05 * layout.genus);
  }

  [[nodiscard]] bool is_better(const GridLayout& other, const GridLayout& layout) const {
    return other.vertices <= std::max(most_, layout.vertices) && cost_of(other) < cost_of(layout);
  }

  /// Planes one or two voxels on, while that is better.
  bool shift(GridLayout& layout) const {
    bool any = false;
    for (int a = 0; a < 3; ++a) {
      const std::vector<int> before = layout.planes[a];
      for (const int plane : before) {
        if (is_fixed(a, plane) || is_image(a, plane)) {
          continue;
        }
        int at = plane;
        for (const int by : {1, -1, 2, -2}) {
          for (bool better = true; better;) {
            better = false;
            const int to = at + by;
            if (to <= solid_.low()[a] || to >= solid_.high()[a] || has(layout, a, to) ||
                (is_paired(a) && to <= middle_)) {
              break;
            }
            Planes planes = layout.planes;
            erase(planes, a, at);
            insert(planes, a, to);
            GridLayout other = layout_of(std::move(planes));
            if (is_better(other, layout)) {
              layout = std::move(other);
              at = to;
              better = any = true;
            }
          }
        }
      }
    }
    return any;
  }

  static bool has(const GridLayout& layout, int axis, int plane) {
    return std::binary_search(layout.planes[axis].begin(), layout.planes[axis].end(), plane);
  }

  /// A plane more where the budget has room for it, or one instead of another.
  bool exchange(GridLayout& layout) const {
    std::optional<GridLayout> best;
    const auto consider = [&](const Planes& base) {
      for (int a = 0; a < 3; ++a) {
        for (std::size_t p = 1; p < base[a].size(); ++p) {
          const int middle = (base[a][p - 1] + base[a][p]) / 2;
          if (middle == base[a][p - 1] || (is_paired(a) && middle <= middle_)) {
            continue;
          }
          Planes planes = base;
          insert(planes, a, middle);
          GridLayout other = layout_of(std::move(planes));
          if (is_better(other, best ? *best : layout)) {
            best = std::move(other);
          }
        }
      }
    };
    consider(layout.planes);
    for (int a = 0; a < 3; ++a) {
      for (const int plane : layout.planes[a]) {
        if (!is_fixed(a, plane) && !is_image(a, plane)) {
          Planes planes = layout.planes;
          erase(planes, a, plane);
          consider(planes);
        }
      }
    }
    if (best) {
      layout = std::move(*best);
    }
    return best.has_value();
  }

  const SolidGrid& solid_;
  GridLayoutOptions options_;
  const Progress& progress_;
  int middle_;
  std::size_t most_ = static_cast<std::size_t>(options_.vertices);
};

} // namespace

GridLayout grid_layout(const SolidGrid& solid, const GridLayoutOptions& options,
                       const Progress& progress) {
  return Search(solid, options, progress).run();
}

PolygonMesh surface_of(const GridLayout& layout, const SolidGrid& solid, bool half) {
  const VoxelGrid& cells = layout.cells;
  PolygonMesh mesh;
  const auto n = [&](int a) { return layout.planes[a].size(); };
  std::vector<Index> number(n(0) * n(1) * n(2), none);
  const int middle = solid.dims()[0] / 2;
  const auto vertex = [&](const Cell& at) { // the place of a plane along each axis
    Index& v =
        number[static_cast<std::size_t>(at[0]) +
               n(0) * (static_cast<std::size_t>(at[1]) + n(1) * static_cast<std::size_t>(at[2]))];
    if (v == none) {
      v = static_cast<Index>(mesh.positions.size());
      Vec3 p =
          solid.corner(layout.planes[0][at[0]], layout.planes[1][at[1]], layout.planes[2][at[2]]);
      if (half && layout.planes[0][at[0]] == middle) {
        p.x() = 0;
      }
      mesh.positions.push_back(p);
    }
    return v;
  };
  for (std::size_t c = 0; c < cells.kinds.size(); ++c) {
    const Cell cell = cells.cell(c);
    if (!cells.occupied(c) || (half && layout.planes[0][cell[0] - 1] < middle)) {
      continue;
    }
    for (int a = 0; a < 3; ++a) {
      for (const int side : {0, 1}) {
        if (cells.occupied(side == 1 ? c + cells.stride(a) : c - cells.stride(a))) {
          continue;
        }
        const int b = (a + 1) % 3;
        const int d = (a + 2) % 3;
        Cell low{cell[0] - 1, cell[1] - 1, cell[2] - 1};
        low[a] += side;
        std::array<Cell, 4> corners{low, low, low, low};
        corners[1][b] += 1;
        corners[2][b] += 1;
        corners[2][d] += 1;
        corners[3][d] += 1;
        if (side == 0) {
          std::swap(corners[1], corners[3]);
        }
        mesh.add_face(
            {vertex(corners[0]), vertex(corners[1]), vertex(corners[2]), vertex(corners[3])});
      }
    }
  }
  return mesh;
}

} // namespace cagewright
