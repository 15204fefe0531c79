#include "slicing/lookahead.h"

#include "core/maths.h"
#include "slicing/volume_rule.h"

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

/// The copy has about as many voxels as this: enough to tell limbs apart.
constexpr double coarse_voxels = 800;
constexpr int coarsest = 6;

/// Where along an axis a plane is tried, as fractions of its half-length.
constexpr std::array<double, 5> stations = {-0.5, -0.25, 0.0, 0.25, 0.5};

using Cell = std::array<int, 3>;

/// The cells from `first` to `last`, of `factor` voxels a side, in an empty layer.
VoxelGrid coarser(const VoxelGrid& grid, int factor, const Cell& first, const Cell& last) {
  VoxelGrid coarse;
  coarse.axes = grid.axes;
  coarse.size = grid.size * factor;
  coarse.origin = grid.to_world(factor * Vec3(first[0] - 1, first[1] - 1, first[2] - 1));
  for (std::size_t a = 0; a < 3; ++a) {
    coarse.dims[a] = last[a] - first[a] + 3;
  }
  coarse.kinds.assign(coarse.index(0, 0, coarse.dims[2]), VoxelKind::outer);
  return coarse;
}

} // namespace

Lookahead::Lookahead(const VoxelGrid& grid, std::span<const std::uint32_t> voxels,
                     const OrientedBox& box, bool split_parts, double padding)
    : box_(box), split_parts_(split_parts), padding_(padding) {
  const double ratio = static_cast<double>(voxels.size()) / coarse_voxels;
  const int factor =
      std::clamp(static_cast<int>(std::lround(maths::pow(ratio, 1.0 / 3))), 1, coarsest);
  const auto cell_of = [&](std::uint32_t voxel) {
    const Cell c = grid.cell(voxel);
    return Cell{c[0] / factor, c[1] / factor, c[2] / factor};
  };
  Cell first = cell_of(voxels.front());
  Cell last = first;
  for (const std::uint32_t v : voxels) {
    const Cell c = cell_of(v);
    for (std::size_t a = 0; a < 3; ++a) {
      first[a] = std::min(first[a], c[a]);
      last[a] = std::max(last[a], c[a]);
    }
  }
  coarse_ = coarser(grid, factor, first, last);
  for (const std::uint32_t v : voxels) {
    const Cell c = cell_of(v);
    coarse_.kinds[coarse_.index(c[0] - first[0] + 1, c[1] - first[1] + 1, c[2] - first[2] + 1)] =
        VoxelKind::inner;
  }
  for (std::uint32_t v = 0; v < coarse_.kinds.size(); ++v) {
    if (coarse_.occupied(v)) {
      voxels_.push_back(v);
    }
  }
  owners_ = {std::vector<std::uint32_t>(coarse_.kinds.size(), VoxelOwners::none),
             std::vector<std::uint32_t>(coarse_.kinds.size(), 0)};
  owners_.assign(voxels_, 0);
}

double Lookahead::share_left(const CutPlane& plane) const {
  const std::vector<std::vector<std::uint32_t>> parts =
      partition(coarse_, owners_, 0, voxels_, box_, plane, split_parts_);
  if (parts.size() < 2) {
    return 1;
  }
  VoxelOwners owners = owners_;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    owners.assign(parts[p], p);
  }
  CutVolumes total;
  for (std::uint32_t p = 0; p < parts.size(); ++p) {
    const CutVolumes volumes =
        least_volumes(coarse_, owners, p, parts[p], box_,
                      {.split_parts = split_parts_, .margin = 1, .padding = padding_});
    total.uncut += volumes.uncut;
    total.cut += volumes.cut;
  }
  return total.cut / total.uncut;
}

std::vector<CutPlane> Lookahead::evenly_spaced_planes(double margin) const {
  std::vector<CutPlane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double station : stations) {
      if ((1 - std::abs(station)) * box_.half[axis] > margin) {
        planes.push_back({axis, station * box_.half[axis]});
      }
    }
  }
  return planes;
}

} // namespace cagewright
