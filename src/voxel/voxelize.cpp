#include "voxel/voxelize.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/reach.h"
#include "voxel/classify.h"
#include "voxel/triangle_overlap.h"
#include <cagewright/mesh/measures.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <string>

namespace cagewright {
namespace {

// In voxels. Far above the round-off of positions up to about 1e5 diagonals from the origin, so
// that surfaces exactly between two layers fall in both, wherever the model stands; far below
// anything that matters.
constexpr double round_off = 1e-6;

// How far, in voxels, a box's faces keep from the boundaries of layers at least. Half of a layer in
// two would be 0.25, which simple ratios of a box's edges hit exactly: then round-off would choose.
constexpr double least_gap = 0.2327;

constexpr double max_voxels = 1 << 28;
constexpr double bytes_a_voxel = 20; // with what classification takes, at most

// "1.2 GB"
std::string gigabytes(double bytes) {
  std::string text = std::to_string(std::ceil(bytes / (1 << 30) * 10) / 10);
  return text.substr(0, text.find('.') + 2) + " GB";
}

Status fits_memory(double voxels, int resolution) {
  const std::string asked = "a grid of " + std::to_string(std::llround(voxels / 1e6)) +
                            " million voxels (resolution " + std::to_string(resolution) + ")";
  if (!(voxels <= max_voxels)) {
    return Error{ErrorCode::too_large,
                 asked + " is more than the 268 million there may be; lower the resolution"};
  }
  if (bytes_a_voxel * voxels > memory_allowed()) {
    return Error{ErrorCode::too_large, asked + " needs " + gigabytes(bytes_a_voxel * voxels) +
                                           " of memory, but only " + gigabytes(memory_allowed()) +
                                           " are allowed; lower the resolution"};
  }
  return success();
}

double fraction(double x) {
  return x - std::floor(x);
}

// Layers along one axis, in voxels from where the middle of the box lies in the grid.
struct Layers {
  double middle = 0; // of the box: at a boundary (0) or the middle (0.5) of a layer
  double first = 0;
  double last = 0;
};

// `length` and the mesh's extent [low, high] about the box's middle, in voxels.
Layers layers(double length, double low, double high) {
  const double rest = fraction(length / 2);
  const double middle = rest >= least_gap && rest <= 1 - least_gap ? 0.0 : 0.5;
  return {middle, std::floor(middle + std::min(-length / 2, low)) - 1,
          std::floor(middle + std::max(length / 2, high)) + 1};
}

Result<VoxelGrid> make_grid(TriangleView mesh, const OrientedBox& frame,
                            const VoxelizeOptions& options) {
  if (options.resolution < 2 || options.resolution > 4096) {
    return Error{ErrorCode::invalid_option, "the resolution is " +
                                                std::to_string(options.resolution) +
                                                "; it must be from 2 to 4096"};
  }
  if (!(options.margin >= 0 && options.margin <= 64)) {
    return Error{ErrorCode::invalid_option, "the margin must be from 0 to 64 voxels"};
  }
  if (mesh.positions.empty()) {
    return Error{ErrorCode::unfit_model, "the model has no vertices"};
  }
  Box3 extent;
  for (const Vec3& p : mesh.positions) {
    if (!is_within_reach(p)) {
      return Error{ErrorCode::unfit_model,
                   "the model has a coordinate that is not finite, or beyond 1e100"};
    }
    extent.extend(frame.to_local(p));
  }
  VoxelGrid grid;
  grid.axes = frame.axes;
  grid.size = 2 * frame.half.maxCoeff() / (options.resolution - 1);
  if (!(grid.size > 0 && std::isfinite(grid.size))) {
    return Error{ErrorCode::unfit_model, "the model has no extent: all its points coincide"};
  }
  Vec3 first;
  double voxels = 1;
  const double reach = options.margin + round_off;
  for (int k = 0; k < 3; ++k) {
    const Layers l = layers(2 * frame.half[k] / grid.size, extent.min()[k] / grid.size - reach,
                            extent.max()[k] / grid.size + reach);
    first[k] = l.first - l.middle;
    voxels *= l.last - l.first + 1;
    if (!(l.last - l.first < max_voxels)) {
      return fits_memory(voxels, options.resolution).error();
    }
    grid.dims[k] = static_cast<int>(l.last - l.first) + 1;
  }
  if (Status status = fits_memory(voxels, options.resolution); !status) {
    return status.error();
  }
  grid.origin = frame.center + frame.axes * (grid.size * first);
  grid.kinds.assign(static_cast<std::size_t>(voxels), VoxelKind::outer);
  return grid;
}

// Threads may mark the same voxel at once.
using Marks = std::vector<std::atomic<bool>>;

void mark(const VoxelGrid& grid, const Triangle& t, std::span<const Vec3> positions, double grow,
          Marks& marks) {
  const TriangleOverlap overlap(positions[t[0]], positions[t[1]], positions[t[2]], grow);
  overlap.for_each_cell([&](const std::array<int, 3>& cell) {
    marks[grid.index(cell)].store(true, std::memory_order_relaxed);
  });
}

std::vector<Triangle> stray_vertices(TriangleView mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    used[t[0]] = used[t[1]] = used[t[2]] = true;
  }
  std::vector<Triangle> strays;
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (!used[v]) {
      strays.push_back({v, v, v});
    }
  }
  return strays;
}

void mark_features(TriangleView mesh, VoxelGrid& grid, double grow, const Progress& progress) {
  std::vector<Vec3> positions(mesh.positions.size());
  parallel_for(0, positions.size(), 4096,
               [&](std::size_t i) { positions[i] = grid.to_grid(mesh.positions[i]); });
  const std::vector<Triangle> strays = stray_vertices(mesh);
  Marks marks(grid.kinds.size());
  for (const std::span<const Triangle> triangles :
       {mesh.triangles, std::span<const Triangle>(strays)}) {
    parallel_for(0, triangles.size(), 256, [&](std::size_t t) {
      if (!progress.cancelled()) {
        mark(grid, triangles[t], positions, grow, marks);
      }
    });
  }
  for (std::size_t v = 0; v < marks.size(); ++v) {
    if (marks[v].load(std::memory_order_relaxed)) {
      grid.kinds[v] = VoxelKind::feature;
    }
  }
}

} // namespace

Result<VoxelGrid> voxelize(TriangleView mesh, const OrientedBox& frame,
                           const VoxelizeOptions& options, const Progress& progress) {
  progress(0, "finding voxels on the surface");
  Result<VoxelGrid> grid = make_grid(mesh, frame, options);
  if (!grid) {
    return grid;
  }
  mark_features(mesh, *grid, options.margin + round_off, progress);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  const Progress rest = progress.part(0.5, 1);
  const Status status = options.patches != nullptr ? classify(mesh, *options.patches, *grid, rest)
                                                   : classify(mesh, *grid, rest);
  if (!status) {
    return status.error();
  }
  return grid;
}

} // namespace cagewright
