#include <cagewright/validate/model_volume.h>

#include "core/parallel.h"
#include "mesh/topology.h"
#include "validate/containment.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace cagewright {
namespace {

/// Sample points in the middle of the cells of a grid, and how many rays found each inside.
class VoteGrid {
public:
  VoteGrid(TriangleView model, const Box3& box, int longest) : model_(model) {
    // Off the middle by a little, so that no ray runs along a symmetry of the model.
    const double side = box.sizes().maxCoeff() / longest;
    step_ = side;
    for (int axis = 0; axis < 3; ++axis) {
      size_[axis] = std::max(1, static_cast<int>(std::ceil(box.sizes()[axis] / side)));
      origin_[axis] = box.center()[axis] + (0.5 - 0.5 * size_[axis] + 1e-4 * (axis + 1)) * side;
    }
    votes_.assign(static_cast<std::size_t>(size_[0]) * size_[1] * size_[2], 0);
  }

  /// Votes along both directions of an axis.
  void vote_along(int axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    crossings_.assign(static_cast<std::size_t>(size_[u]) * size_[v], {});
    for (const Triangle& t : model_.triangles) {
      add_crossings(t, axis, u, v);
    }
    parallel_for(0, crossings_.size(), 64, [&](std::size_t column) {
      count_column(crossings_[column], axis, static_cast<int>(column) % size_[u],
                   static_cast<int>(column) / size_[u]);
    });
  }

  [[nodiscard]] double volume(int needed_votes) const {
    const auto inside = std::count_if(votes_.begin(), votes_.end(),
                                      [&](std::uint8_t votes) { return votes >= needed_votes; });
    return static_cast<double>(inside) * step_ * step_ * step_;
  }

private:
  struct Crossing {
    double depth;
    int sign;
  };

  [[nodiscard]] double sample(int axis, int i) const { return origin_[axis] + i * step_; }

  void add_crossings(const Triangle& t, int axis, int u, int v) {
    const std::array<const Vec3*, 3> p = {&model_.positions[t[0]], &model_.positions[t[1]],
                                          &model_.positions[t[2]]};
    const auto range = [&](int along) {
      const auto [low, high] = std::minmax({(*p[0])[along], (*p[1])[along], (*p[2])[along]});
      return std::pair(std::max(0, static_cast<int>(std::ceil((low - origin_[along]) / step_))),
                       std::min(size_[along] - 1,
                                static_cast<int>(std::floor((high - origin_[along]) / step_))));
    };
    const auto turn = [&](const Vec3& a, const Vec3& b, double x, double y) {
      return (a[u] - x) * (b[v] - y) - (a[v] - y) * (b[u] - x);
    };
    const auto [u_first, u_last] = range(u);
    const auto [v_first, v_last] = range(v);
    for (int j = v_first; j <= v_last; ++j) {
      for (int i = u_first; i <= u_last; ++i) {
        const double x = sample(u, i);
        const double y = sample(v, j);
        const double a = turn(*p[1], *p[2], x, y);
        const double b = turn(*p[2], *p[0], x, y);
        const double c = turn(*p[0], *p[1], x, y);
        if ((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)) {
          const double depth =
              (a * (*p[0])[axis] + b * (*p[1])[axis] + c * (*p[2])[axis]) / (a + b + c);
          crossings_[static_cast<std::size_t>(j) * size_[u] + i].push_back({depth, a > 0 ? 1 : -1});
        }
      }
    }
  }

  void count_column(std::vector<Crossing>& column, int axis, int i, int j) {
    std::sort(column.begin(), column.end(),
              [](const Crossing& a, const Crossing& b) { return a.depth < b.depth; });
    int ahead = 0;
    for (const Crossing& crossing : column) {
      ahead += crossing.sign;
    }
    int behind = 0;
    std::size_t next = 0;
    std::array<int, 3> at{};
    at[(axis + 1) % 3] = i;
    at[(axis + 2) % 3] = j;
    for (int k = 0; k < size_[axis]; ++k) {
      for (; next < column.size() && column[next].depth < sample(axis, k); ++next) {
        ahead -= column[next].sign;
        behind += column[next].sign;
      }
      at[axis] = k;
      votes_[(static_cast<std::size_t>(at[2]) * size_[1] + at[1]) * size_[0] + at[0]] +=
          static_cast<std::uint8_t>((ahead != 0 ? 1 : 0) + (behind != 0 ? 1 : 0));
    }
  }

  TriangleView model_;
  double step_ = 1;
  Vec3 origin_ = Vec3::Zero(); // the first sample
  std::array<int, 3> size_{};
  std::vector<std::uint8_t> votes_;
  std::vector<std::vector<Crossing>> crossings_; // by column of the axis in hand
};

} // namespace

std::string_view name_of(VolumeMethod method) {
  switch (method) {
  case VolumeMethod::none:
    return "none";
  case VolumeMethod::exact:
    return "exact";
  case VolumeMethod::sampled:
    return "sampled";
  }
  return "unknown"; // no default above: the compiler points here when a method is added
}

ModelVolume model_volume(TriangleView model) {
  const Box3 box = bounding_box(model);
  if (model.triangles.empty() || !(box.sizes().maxCoeff() > 0)) {
    return {};
  }
  if (closure_of(weld(model).triangles) == Closure::oriented) {
    return {std::abs(signed_volume(model)), VolumeMethod::exact};
  }
  constexpr int longest = 96;
  constexpr int needed_votes = 4;
  VoteGrid grid(model, box, longest);
  for (int axis = 0; axis < 3; ++axis) {
    grid.vote_along(axis);
  }
  return {grid.volume(needed_votes), VolumeMethod::sampled};
}

} // namespace cagewright
