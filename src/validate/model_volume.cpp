#include <cagewright/validate/model_volume.h>

#include "core/maths.h"
#include "core/parallel.h"
#include "mesh/topology.h"
#include "validate/containment.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// Winding numbers above this share of the samples tell that the surface overlaps, and hollows
/// above it that it has some: less may be round-off of the grid.
constexpr double noticed = 0.01;

/// Sample points in the middle of the cells of a grid, how many rays found each inside, and which
/// steps from sample to sample cross the surface.
class SampleGrid {
public:
  SampleGrid(TriangleView model, const Box3& box, int longest) : model_(model) {
    // Off the middle by a little, so that no ray runs along a symmetry of the model.
    const double side = box.sizes().maxCoeff() / longest;
    step_ = side;
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      // One layer more on each side: all of the outside hangs together.
      size_[axis] = std::max(1, static_cast<int>(std::ceil(box.sizes()[axis] / side))) + 2;
      origin_[axis] = box.center()[axis] + (0.5 - 0.5 * size_[axis] + 1e-4 * (axis + 1)) * side;
      count *= static_cast<std::size_t>(size_[axis]);
    }
    stride_ = {1, static_cast<std::size_t>(size_[0]),
               static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1])};
    samples_.assign(count, {});
  }

  /// Votes along both directions of an axis.
  void vote_along(int axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    crossings_.assign(static_cast<std::size_t>(size_[u]) * static_cast<std::size_t>(size_[v]), {});
    for (const Triangle& t : model_.triangles) {
      add_crossings(t, axis, u, v);
    }
    parallel_for(0, crossings_.size(), 64, [&](std::size_t column) {
      count_column(crossings_[column], axis, static_cast<int>(column) % size_[u],
                   static_cast<int>(column) / size_[u]);
    });
  }

  /// Marks the samples that can be reached from the outside.
  void flood() {
    std::vector<std::size_t> open = {0}; // a corner: outside
    samples_[0].reached = true;
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      std::size_t rest = at;
      for (int axis = 2; axis >= 0; --axis) {
        const auto place = static_cast<int>(rest / stride_[axis]);
        rest %= stride_[axis];
        const std::size_t stride = stride_[axis];
        if (place + 1 < size_[axis] && !(samples_[at].walls >> axis & 1U)) {
          reach(at + stride, open);
        }
        if (place > 0 && !(samples_[at - stride].walls >> axis & 1U)) {
          reach(at - stride, open);
        }
      }
    }
  }

  struct Counts {
    std::size_t enclosed = 0; ///< by the rule of the header
    std::size_t once = 0;     ///< the surface winds round them once, one way or the other
    std::size_t opposite = 0; ///< of these, the rarer of the two ways
    std::size_t more = 0;     ///< it winds round them twice or more
    std::size_t hollow = 0;   ///< they are shut in, but it does not wind round them
  };

  [[nodiscard]] Counts counts(int needed_votes) const {
    Counts counts;
    std::size_t backward = 0;
    for (const Sample& sample : samples_) {
      counts.enclosed += !sample.reached || sample.votes >= needed_votes ? 1 : 0;
      counts.once += std::abs(sample.winding) == 1 ? 1 : 0;
      backward += sample.winding == -1 ? 1 : 0;
      counts.more += std::abs(sample.winding) > 1 ? 1 : 0;
      counts.hollow += !sample.reached && sample.winding == 0 ? 1 : 0;
    }
    counts.opposite = std::min(backward, counts.once - backward);
    return counts;
  }

  [[nodiscard]] double cell_volume() const { return step_ * step_ * step_; }

private:
  struct Crossing {
    double depth;
    int sign;
  };
  struct Sample {
    std::uint8_t votes = 0;
    std::uint8_t walls = 0; // bit k: the step to the next along axis k crosses the surface
    bool reached = false;
    int winding = 0; // as the last axis has it; of a closed surface all agree
  };

  void reach(std::size_t at, std::vector<std::size_t>& open) {
    if (!samples_[at].reached) {
      samples_[at].reached = true;
      open.push_back(at);
    }
  }

  [[nodiscard]] double sample(int axis, int i) const { return origin_[axis] + i * step_; }

  /// On which side of the line from a to b the ray lies: 1 or -1. On the line it is taken to lie
  /// beside it, the same way for both faces of an edge, so that no ray slips through between them.
  static int side(const Vec3& a, const Vec3& b, int u, int v, double x, double y) {
    const double turn = (a[u] - x) * (b[v] - y) - (a[v] - y) * (b[u] - x);
    if (turn != 0) {
      return turn > 0 ? 1 : -1;
    }
    return std::pair(a[u], a[v]) < std::pair(b[u], b[v]) ? 1 : -1;
  }

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
        const int way = side(*p[0], *p[1], u, v, x, y);
        if (side(*p[1], *p[2], u, v, x, y) != way || side(*p[2], *p[0], u, v, x, y) != way) {
          continue;
        }
        const double a = turn(*p[1], *p[2], x, y);
        const double b = turn(*p[2], *p[0], x, y);
        const double c = turn(*p[0], *p[1], x, y);
        const double sum = a + b + c;
        const double depth = sum != 0
                                 ? (a * (*p[0])[axis] + b * (*p[1])[axis] + c * (*p[2])[axis]) / sum
                                 : (*p[0])[axis];
        crossings_[static_cast<std::size_t>(j) * static_cast<std::size_t>(size_[u]) +
                   static_cast<std::size_t>(i)]
            .push_back({depth, way});
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
    std::size_t at = static_cast<std::size_t>(i) * stride_[(axis + 1) % 3] +
                     static_cast<std::size_t>(j) * stride_[(axis + 2) % 3];
    for (int k = 0; k < size_[axis]; ++k, at += stride_[axis]) {
      const std::size_t passed = next;
      for (; next < column.size() && column[next].depth < sample(axis, k); ++next) {
        ahead -= column[next].sign;
        behind += column[next].sign;
      }
      if (next > passed && k > 0) {
        samples_[at - stride_[axis]].walls |= static_cast<std::uint8_t>(1U << axis);
      }
      samples_[at].votes += static_cast<std::uint8_t>((ahead != 0 ? 1 : 0) + (behind != 0 ? 1 : 0));
      samples_[at].winding = ahead;
    }
  }

  TriangleView model_;
  double step_ = 1;
  Vec3 origin_ = Vec3::Zero(); // the first sample
  std::array<int, 3> size_{};
  std::array<std::size_t, 3> stride_{};
  std::vector<Sample> samples_;
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
  case VolumeMethod::enclosed:
    return "enclosed";
  }
  return "unknown"; // no default above: the compiler points here when a method is added
}

ModelVolume model_volume(TriangleView model, const Progress& progress) {
  const Box3 box = bounding_box(model);
  if (model.triangles.empty() || !(box.sizes().maxCoeff() > 0)) {
    return {};
  }
  constexpr int longest = 96;
  constexpr int needed_votes = 4;
  SampleGrid grid(model, box, longest);
  for (int axis = 0; axis < 3; ++axis) {
    if (progress.cancelled()) {
      return {};
    }
    grid.vote_along(axis);
  }
  if (progress.cancelled()) {
    return {};
  }
  grid.flood();
  if (progress.cancelled()) {
    return {};
  }
  const SampleGrid::Counts counts = grid.counts(needed_votes);
  const bool is_closed = closure_of(weld(model).triangles) == Closure::oriented;
  const double few = noticed * static_cast<double>(counts.enclosed);
  const bool winds_once = static_cast<double>(counts.more) <= few &&
                          static_cast<double>(counts.opposite) <= few &&
                          static_cast<double>(counts.hollow) <= few;
  const double exact = is_closed ? std::abs(signed_volume(model)) : 0;
  // What winds round nothing has but the volume of its rounding.
  constexpr double rounding = 1e-12;
  const bool has_volume = exact > rounding * maths::cube(box.diagonal().norm());
  if (is_closed && winds_once && (counts.enclosed == 0 || counts.once > 0)) {
    return {has_volume ? exact : 0, VolumeMethod::exact};
  }
  return {static_cast<double>(counts.enclosed) * grid.cell_volume(),
          is_closed ? VolumeMethod::enclosed : VolumeMethod::sampled};
}

} // namespace cagewright
