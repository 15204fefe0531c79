#include "slicing/volume_rule.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace cagewright {
namespace {

/// Two costs this near (relatively) are alike: the earlier slice wins.
constexpr double tie = 1e-9;
/// A second candidate along an axis lies at least this many slices from the first.
constexpr std::ptrdiff_t apart = 4;

struct Sweep {
  const VoxelGrid& grid;
  const VoxelOwners& owners;
  std::uint32_t part;
  std::span<const std::uint32_t> voxels;
  std::vector<Vec3> centers; // of the voxels, in the frame of the box
  std::array<std::ptrdiff_t, 26> steps;
  Vec3 extent_of_one; // of the padded box of a single voxel, along the axes of the box
  bool split_parts;

  Sweep(const VoxelGrid& of_grid, const VoxelOwners& of_owners, std::uint32_t of_part,
        std::span<const std::uint32_t> of_voxels, const OrientedBox& box,
        const VolumeRuleOptions& options)
      : grid(of_grid), owners(of_owners), part(of_part), voxels(of_voxels),
        steps(neighbor_steps(of_grid)), split_parts(options.split_parts) {
    extent_of_one =
        ((box.axes.transpose() * grid.axes).cwiseAbs() * Vec3::Constant(grid.size)).array() +
        2 * options.padding;
    centers.reserve(voxels.size());
    for (const std::uint32_t v : voxels) {
      centers.push_back(box.to_local(grid.center(v)));
    }
  }
};

/// The slices of the voxels along one axis. Slice boundaries lie half-way between voxel centers
/// when the box is parallel to the grid.
struct Slices {
  double begin = 0;                 // local coordinate where slice 0 begins
  std::vector<std::uint32_t> of;    // slice of each voxel
  std::vector<std::uint32_t> order; // voxels by slice
  std::vector<std::size_t> first;   // where each slice begins in `order`, and the end

  Slices(const Sweep& sweep, int axis) : of(sweep.voxels.size()), order(sweep.voxels.size()) {
    double low = sweep.centers[0][axis];
    double high = low;
    for (const Vec3& c : sweep.centers) {
      low = std::min(low, c[axis]);
      high = std::max(high, c[axis]);
    }
    const double size = sweep.grid.size;
    begin = low - size / 2;
    first.assign(static_cast<std::size_t>((high - begin) / size) + 3, 0);
    for (std::size_t s = 0; s < of.size(); ++s) {
      of[s] = static_cast<std::uint32_t>((sweep.centers[s][axis] - begin) / size);
      ++first[of[s] + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t s = 0; s < of.size(); ++s) {
      order[next[of[s]]++] = s;
    }
    while (first.size() > 2 && first[first.size() - 2] == of.size()) {
      first.pop_back();
    }
  }

  [[nodiscard]] std::size_t count() const { return first.size() - 1; }
};

/// Sets of voxels, their extents, and the sum of the volumes of their boxes.
class GrowingParts {
public:
  explicit GrowingParts(const Sweep& sweep) : sweep_(sweep), parent_(sweep.voxels.size(), absent) {
    boxes_.resize(sweep.voxels.size());
  }

  void add(std::uint32_t slot) {
    parent_[slot] = slot;
    boxes_[slot] = {sweep_.centers[slot], sweep_.centers[slot]};
    total_ += volume(boxes_[slot]);
    if (!sweep_.split_parts) {
      join(slot, seed_ == absent ? seed_ = slot : seed_);
      return;
    }
    for (const std::ptrdiff_t step : sweep_.steps) {
      const std::size_t n = sweep_.voxels[slot] + static_cast<std::size_t>(step);
      if (sweep_.owners.part[n] == sweep_.part && parent_[sweep_.owners.slot[n]] != absent) {
        join(slot, sweep_.owners.slot[n]);
      }
    }
  }

  [[nodiscard]] double total_volume() const { return total_; }

private:
  static constexpr std::uint32_t absent = 0xffffffff;

  struct Extent {
    Vec3 low, high;
  };

  [[nodiscard]] double volume(const Extent& e) const {
    return (e.high - e.low + sweep_.extent_of_one).prod();
  }

  std::uint32_t find(std::uint32_t s) {
    while (parent_[s] != s) {
      parent_[s] = parent_[parent_[s]];
      s = parent_[s];
    }
    return s;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) {
      return;
    }
    if (a > b) {
      std::swap(a, b); // the older voxel leads: no ranks, and the same on every run
    }
    total_ -= volume(boxes_[a]) + volume(boxes_[b]);
    boxes_[a].low = boxes_[a].low.cwiseMin(boxes_[b].low);
    boxes_[a].high = boxes_[a].high.cwiseMax(boxes_[b].high);
    parent_[b] = a;
    total_ += volume(boxes_[a]);
  }

  const Sweep& sweep_;
  std::vector<std::uint32_t> parent_;
  std::vector<Extent> boxes_;
  std::uint32_t seed_ = absent;
  double total_ = 0;
};

/// Volume of the boxes of slices 0..k, for every k; or of k.. when backward.
std::vector<double> volumes(const Sweep& sweep, const Slices& slices, bool backward) {
  GrowingParts parts(sweep);
  std::vector<double> volumes(slices.count());
  for (std::size_t n = 0; n < slices.count(); ++n) {
    const std::size_t k = backward ? slices.count() - 1 - n : n;
    for (std::size_t at = slices.first[k]; at < slices.first[k + 1]; ++at) {
      parts.add(slices.order[at]);
    }
    volumes[k] = parts.total_volume();
  }
  return volumes;
}

/// Total volume after each cut along an axis: entry k is for the cut between slices k and k + 1.
std::vector<double> cut_costs(const Sweep& sweep, const Slices& slices) {
  const std::vector<double> below = volumes(sweep, slices, false);
  const std::vector<double> above = volumes(sweep, slices, true);
  std::vector<double> costs(slices.count() - 1);
  for (std::size_t k = 0; k < costs.size(); ++k) {
    costs[k] = below[k] + above[k + 1];
  }
  return costs;
}

/// The range of cuts that leave the margin on both sides; empty when begin >= end.
std::pair<std::ptrdiff_t, std::ptrdiff_t> allowed_cuts(const Slices& slices, int margin) {
  return {margin - 1, static_cast<std::ptrdiff_t>(slices.count()) - margin};
}

void append_best(const Sweep& sweep, int axis, const VolumeRuleOptions& options,
                 std::vector<CutPlane>& out) {
  const Slices slices(sweep, axis);
  const auto [begin, end] = allowed_cuts(slices, options.margin);
  if (begin >= end) {
    return;
  }
  const std::vector<double> costs = cut_costs(sweep, slices);
  std::vector<std::ptrdiff_t> chosen;
  for (int n = 0; n < options.per_axis; ++n) {
    std::ptrdiff_t best = -1;
    double best_cost = 0;
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const double cost = costs[static_cast<std::size_t>(k)];
      const bool free = std::none_of(chosen.begin(), chosen.end(),
                                     [&](std::ptrdiff_t c) { return std::abs(c - k) < apart; });
      if (free && (best < 0 || cost < (1 - tie) * best_cost)) {
        best = k;
        best_cost = cost;
      }
    }
    if (best < 0) {
      return;
    }
    chosen.push_back(best);
    out.push_back({axis, slices.begin + static_cast<double>(best + 1) * sweep.grid.size});
  }
}

} // namespace

std::vector<CutPlane> volume_cuts(const VoxelGrid& grid, const VoxelOwners& owners,
                                  std::uint32_t part, std::span<const std::uint32_t> voxels,
                                  const OrientedBox& box, const VolumeRuleOptions& options) {
  const Sweep sweep(grid, owners, part, voxels, box, options);
  std::array<std::vector<CutPlane>, 3> by_axis;
  parallel_for(0, 3, 1, [&](std::size_t axis) {
    append_best(sweep, static_cast<int>(axis), options, by_axis[axis]);
  });
  std::vector<CutPlane> planes;
  for (const std::vector<CutPlane>& along : by_axis) {
    planes.insert(planes.end(), along.begin(), along.end());
  }
  return planes;
}

CutVolumes least_volumes(const VoxelGrid& grid, const VoxelOwners& owners, std::uint32_t part,
                         std::span<const std::uint32_t> voxels, const OrientedBox& box,
                         const VolumeRuleOptions& options) {
  const Sweep sweep(grid, owners, part, voxels, box, options);
  Box3 extent;
  for (const Vec3& c : sweep.centers) {
    extent.extend(c);
  }
  CutVolumes least;
  least.uncut = (extent.sizes() + sweep.extent_of_one).prod();
  least.cut = least.uncut;
  for (int axis = 0; axis < 3; ++axis) {
    const Slices slices(sweep, axis);
    const auto [begin, end] = allowed_cuts(slices, options.margin);
    if (begin < end) {
      const std::vector<double> costs = cut_costs(sweep, slices);
      least.cut =
          std::min(least.cut, *std::min_element(costs.begin() + begin, costs.begin() + end));
    }
  }
  return least;
}

} // namespace cagewright
