#include "slicing/cross_section.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cagewright {
namespace {

/// Two heights this near (as a fraction of the greatest f) are alike: the earlier slice wins, so
/// that round-off in a moved copy of the model cannot choose another cut.
constexpr double tie = 1e-9;

/// A binary raster, and the sizes of its 8-connected parts.
class Raster {
public:
  Raster(std::size_t width, std::size_t height)
      : width_(width + 2), pixels_(width_ * (height + 2), 0) {}

  void clear() { std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0}); }
  void set(std::size_t u, std::size_t v) { pixels_[(v + 1) * width_ + u + 1] = 1; }

  /// Number of pixels of each part; the raster is empty afterwards.
  const std::vector<std::size_t>& take_parts() {
    sizes_.clear();
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
      if (pixels_[p] != 0) {
        sizes_.push_back(take_part(p));
      }
    }
    return sizes_;
  }

private:
  std::size_t take_part(std::size_t seed) {
    std::size_t size = 0;
    stack_.assign(1, seed);
    pixels_[seed] = 0;
    while (!stack_.empty()) {
      const std::size_t p = stack_.back();
      stack_.pop_back();
      ++size;
      // The frame of one empty pixel keeps all eight neighbours inside the array.
      for (const std::size_t q : {p - width_ - 1, p - width_, p - width_ + 1, p - 1, p + 1,
                                  p + width_ - 1, p + width_, p + width_ + 1}) {
        if (pixels_[q] != 0) {
          pixels_[q] = 0;
          stack_.push_back(q);
        }
      }
    }
    return size;
  }

  std::size_t width_;
  std::vector<std::uint8_t> pixels_;
  std::vector<std::size_t> stack_;
  std::vector<std::size_t> sizes_;
};

std::size_t smallest_part(const std::vector<std::size_t>& sizes, double min_part) {
  std::size_t total = 0;
  for (const std::size_t size : sizes) {
    total += size;
  }
  std::size_t least = total;
  for (const std::size_t size : sizes) {
    if (static_cast<double>(size) >= min_part * static_cast<double>(total)) {
      least = std::min(least, size);
    }
  }
  return least;
}

std::vector<double> median_filtered(const std::vector<double>& f, int radius) {
  std::vector<double> out(f.size());
  std::vector<double> window;
  const auto n = static_cast<std::ptrdiff_t>(f.size());
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    // Near an end the window shrinks on both sides, so that a slope keeps its foot.
    const std::ptrdiff_t r = std::min<std::ptrdiff_t>({radius, k, n - 1 - k});
    window.assign(f.begin() + (k - r), f.begin() + (k + r + 1));
    std::nth_element(window.begin(), window.begin() + r, window.end());
    out[static_cast<std::size_t>(k)] = window[static_cast<std::size_t>(r)];
  }
  return out;
}

/// Slices of a box along one axis, and the raster of the other two.
struct Lattice {
  std::size_t slices, width, height;
  Vec3 first;           // grid coordinates of the first sample
  Vec3 along, over, up; // steps in grid coordinates
  double step;          // between slices, in model units
};

std::size_t samples(double length, double size) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(length / size)));
}

Lattice lattice_of(const VoxelGrid& grid, const OrientedBox& box, int axis) {
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Lattice lattice{};
  lattice.slices = samples(2 * box.half[axis], grid.size);
  lattice.width = samples(2 * box.half[u], grid.size);
  lattice.height = samples(2 * box.half[v], grid.size);
  const auto step = [&](int a, std::size_t count) {
    return Vec3(box.axes.col(a) * (2 * box.half[a] / static_cast<double>(count)));
  };
  const Vec3 along = step(axis, lattice.slices);
  const Vec3 over = step(u, lattice.width);
  const Vec3 up = step(v, lattice.height);
  lattice.step = along.norm();
  const Vec3 corner = box.center - box.axes * box.half;
  lattice.first = grid.to_grid(corner + (along + over + up) / 2);
  lattice.along = grid.axes.transpose() * along / grid.size;
  lattice.over = grid.axes.transpose() * over / grid.size;
  lattice.up = grid.axes.transpose() * up / grid.size;
  return lattice;
}

} // namespace

CrossSection cross_section(const VoxelGrid& grid, const VoxelOwners& owners, std::uint32_t part,
                           const OrientedBox& box, int axis, const CrossSectionOptions& options) {
  const Lattice lattice = lattice_of(grid, box, axis);
  const auto occupied = [&](const Vec3& p) {
    const int i = static_cast<int>(std::floor(p.x()));
    const int j = static_cast<int>(std::floor(p.y()));
    const int k = static_cast<int>(std::floor(p.z()));
    return i >= 0 && j >= 0 && k >= 0 && i < grid.dims[0] && j < grid.dims[1] && k < grid.dims[2] &&
           owners.part[grid.index(i, j, k)] == part;
  };

  CrossSection section;
  section.axis = axis;
  section.step = lattice.step;
  section.first = -box.half[axis] + lattice.step / 2;
  const double sample_area = 2 * box.half[(axis + 1) % 3] / static_cast<double>(lattice.width) *
                             (2 * box.half[(axis + 2) % 3] / static_cast<double>(lattice.height));
  Raster raster(lattice.width, lattice.height);
  for (std::size_t slice = 0; slice < lattice.slices; ++slice) {
    const Vec3 origin = lattice.first + static_cast<double>(slice) * lattice.along;
    for (std::size_t v = 0; v < lattice.height; ++v) {
      for (std::size_t u = 0; u < lattice.width; ++u) {
        if (occupied(origin + static_cast<double>(u) * lattice.over +
                     static_cast<double>(v) * lattice.up)) {
          raster.set(u, v);
        }
      }
    }
    section.area.push_back(
        static_cast<double>(smallest_part(raster.take_parts(), options.min_part)) * sample_area);
  }
  section.smooth = median_filtered(section.area, options.median_radius);
  return section;
}

Jump greatest_jump(std::span<const double> f, std::size_t margin) {
  const double highest = f.empty() ? 0.0 : *std::max_element(f.begin(), f.end());
  Jump best;
  if (highest <= 0) {
    return best;
  }
  // A run is a stretch of f that never falls, or never rises: from one extreme to the next.
  for (std::size_t begin = 0; begin + 1 < f.size();) {
    std::size_t end = begin + 1;
    while (end + 1 < f.size() && f[end] == f[begin]) {
      ++end;
    }
    const bool rises = f[end] > f[begin];
    while (end + 1 < f.size() && (rises ? f[end + 1] >= f[end] : f[end + 1] <= f[end])) {
      ++end;
    }
    const double height = std::abs(f[end] - f[begin]) / highest;
    if (height > best.height + tie) {
      double steepest = 0;
      for (std::size_t k = std::max(begin, margin > 0 ? margin - 1 : 0);
           k < end && k + 1 + margin <= f.size(); ++k) {
        const double slope = std::abs(f[k + 1] - f[k]) / highest;
        if (slope > steepest + tie) {
          steepest = slope;
          best = {k, height};
        }
      }
    }
    begin = end;
  }
  return best;
}

} // namespace cagewright
