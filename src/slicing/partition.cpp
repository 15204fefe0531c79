#include "slicing/partition.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace cagewright {
namespace {

/// A cut is moved by this part of a voxel, so that centers that lie on it up to round-off all fall
/// on the same side.
constexpr double off_center = 1e-6;

/// Crumbs are parts at most this many voxels thick along the axis of the cut ...
constexpr double crumb_thickness = 2.0;
/// ... or with less than this share of the voxels, when a box of their own saves no volume.
constexpr double crumb_share = 0.05;

class Partition {
public:
  Partition(const VoxelGrid& grid, const VoxelOwners& owners, std::uint32_t part,
            std::span<const std::uint32_t> voxels, const OrientedBox& box, const CutPlane& plane)
      : grid_(grid), owners_(owners), part_(part), voxels_(voxels), box_(box), plane_(plane),
        steps_(neighbor_steps(grid)), above_(voxels.size()) {
    const Vec3 normal = box.axes.col(plane.axis);
    const double level = normal.dot(box.center) + plane.offset + off_center * grid.size;
    for (std::size_t s = 0; s < voxels.size(); ++s) {
      above_[s] = normal.dot(grid.center(voxels[s])) > level ? 1 : 0;
    }
  }

  void label_halves() {
    labels_.assign(above_.begin(), above_.end());
    const bool both = std::find(above_.begin(), above_.end(), 0) != above_.end() &&
                      std::find(above_.begin(), above_.end(), 1) != above_.end();
    count_ = both ? 2 : 1;
  }

  void label_connected_parts() {
    labels_.assign(voxels_.size(), unlabelled);
    count_ = 0;
    for (std::uint32_t s = 0; s < voxels_.size(); ++s) {
      if (labels_[s] == unlabelled) {
        flood(s, count_++);
      }
    }
  }

  void give_back_crumbs();

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> lists() const {
    std::vector<std::uint32_t> compact(count_, unlabelled);
    std::vector<std::vector<std::uint32_t>> parts;
    for (std::size_t s = 0; s < voxels_.size(); ++s) {
      std::uint32_t& at = compact[count_ > 1 ? labels_[s] : 0];
      if (at == unlabelled) {
        at = static_cast<std::uint32_t>(parts.size());
        parts.emplace_back();
      }
      parts[at].push_back(voxels_[s]);
    }
    return parts;
  }

private:
  static constexpr std::uint32_t unlabelled = 0xffffffff;

  struct Extent {
    Box3 box; // of the voxel centers, in the frame of the box
    std::size_t voxels = 0;
  };

  template <class Visit> void visit_neighbors(std::uint32_t slot, const Visit& visit) const {
    for (const std::ptrdiff_t step : steps_) {
      const std::size_t n = voxels_[slot] + static_cast<std::size_t>(step);
      if (owners_.part[n] == part_) {
        visit(owners_.slot[n]);
      }
    }
  }

  void flood(std::uint32_t seed, std::uint32_t label) {
    stack_.assign(1, seed);
    labels_[seed] = label;
    while (!stack_.empty()) {
      const std::uint32_t s = stack_.back();
      stack_.pop_back();
      visit_neighbors(s, [&](std::uint32_t n) {
        if (labels_[n] == unlabelled && above_[n] == above_[s]) {
          labels_[n] = label;
          stack_.push_back(n);
        }
      });
    }
  }

  [[nodiscard]] std::vector<Extent> extents() const {
    std::vector<Extent> extents(count_);
    for (std::size_t s = 0; s < voxels_.size(); ++s) {
      Extent& e = extents[labels_[s]];
      e.box.extend(box_.to_local(grid_.center(voxels_[s])));
      ++e.voxels;
    }
    return extents;
  }

  /// How many pairs of voxels two parts touch in, across the plane.
  [[nodiscard]] std::vector<std::map<std::uint32_t, std::size_t>> contacts() const {
    std::vector<std::map<std::uint32_t, std::size_t>> contacts(count_);
    for (std::uint32_t s = 0; s < voxels_.size(); ++s) {
      visit_neighbors(s, [&](std::uint32_t n) {
        if (labels_[n] != labels_[s]) {
          ++contacts[labels_[s]][labels_[n]];
        }
      });
    }
    return contacts;
  }

  /// Volume of the box of voxels whose centers lie in `centers`.
  [[nodiscard]] double volume(const Box3& centers) const {
    return (centers.sizes().array() + grid_.size).prod();
  }

  [[nodiscard]] bool is_crumb(const Extent& part, const Extent& neighbor) const {
    const double thickness = part.box.sizes()[plane_.axis] / grid_.size + 1;
    const bool small =
        static_cast<double>(part.voxels) < crumb_share * static_cast<double>(voxels_.size());
    return thickness <= crumb_thickness + off_center ||
           (small &&
            volume(part.box.merged(neighbor.box)) <= volume(part.box) + volume(neighbor.box));
  }

  const VoxelGrid& grid_;
  const VoxelOwners& owners_;
  std::uint32_t part_;
  std::span<const std::uint32_t> voxels_;
  const OrientedBox& box_;
  CutPlane plane_;
  std::array<std::ptrdiff_t, 26> steps_;
  std::vector<std::uint8_t> above_;
  std::vector<std::uint32_t> labels_;
  std::uint32_t count_ = 0;
  std::vector<std::uint32_t> stack_;
};

void Partition::give_back_crumbs() {
  if (count_ < 2) {
    return;
  }
  std::vector<Extent> extent = extents();
  const std::vector<std::map<std::uint32_t, std::size_t>> touching = contacts();
  std::vector<std::uint32_t> owner(count_);
  std::iota(owner.begin(), owner.end(), 0U);
  const auto find = [&](std::uint32_t p) {
    while (owner[p] != p) {
      p = owner[p];
    }
    return p;
  };
  std::vector<std::uint32_t> by_size(owner);
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
    return extent[a].voxels < extent[b].voxels;
  });
  for (const std::uint32_t p : by_size) {
    std::uint32_t most = unlabelled;
    std::size_t most_contacts = 0;
    for (const auto& [q, contacts] : touching[p]) {
      if (find(q) != p && contacts > most_contacts) {
        most = find(q);
        most_contacts = contacts;
      }
    }
    if (most != unlabelled && owner[p] == p && is_crumb(extent[p], extent[most])) {
      owner[p] = most;
      extent[most].box.extend(extent[p].box);
      extent[most].voxels += extent[p].voxels;
    }
  }
  for (std::uint32_t& label : labels_) {
    label = find(label);
  }
}

} // namespace

std::vector<std::vector<std::uint32_t>> partition(const VoxelGrid& grid, const VoxelOwners& owners,
                                                  std::uint32_t part,
                                                  std::span<const std::uint32_t> voxels,
                                                  const OrientedBox& box, const CutPlane& plane,
                                                  bool split_parts) {
  Partition cut(grid, owners, part, voxels, box, plane);
  if (split_parts) {
    cut.label_connected_parts();
    cut.give_back_crumbs();
  } else {
    cut.label_halves();
  }
  return cut.lists();
}

} // namespace cagewright
