#include "envelope/envelope.h"

#include "envelope/well_composed.h"
#include "voxel/bridge.h"
#include "voxel/mirrored_grid.h"
#include "voxel/surface_patches.h"
#include "voxel/voxel_mesh.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {

namespace {

// The margin is a little more than the clearance: the surface of the voxels is then strictly clear.
constexpr double margin_factor = 1.05;

double unit_of(TriangleView model, const EnvelopeOptions& options) {
  return options.diagonal > 0 ? options.diagonal : diagonal(model.positions);
}

Result<VoxelGrid> voxels(TriangleView model, const SurfacePatches& patches,
                         const EnvelopeOptions& options, int resolution, const Progress& progress) {
  Box3 box = bounding_box(model.positions);
  if (options.half) {
    box.extend(Vec3(-box.min().x(), box.min().y(), box.min().z()));
    box.extend(Vec3(-box.max().x(), box.max().y(), box.max().z()));
  }
  const double diagonal = unit_of(model, options);
  OrientedBox frame;
  frame.center = box.center();
  frame.axes = Mat3::Identity();
  frame.half = box.sizes() / 2;
  const double across = frame.half.maxCoeff() * 2 / diagonal * resolution;
  VoxelizeOptions voxel;
  voxel.patches = &patches;
  voxel.resolution = std::max(2, static_cast<int>(std::lround(across)) + 1);
  const double size = 2 * frame.half.maxCoeff() / (voxel.resolution - 1);
  voxel.margin = margin_factor * options.clearance * diagonal / size;
  if (options.half) {
    center_on_mirror_plane(frame, voxel);
  }
  return voxelize(model, frame, voxel, progress);
}

// The part at x >= 0 of a surface of voxels which the plane x = 0 does not cut through.
TriangleMesh half_of(TriangleMesh mesh, double voxel) {
  for (Vec3& p : mesh.positions) {
    p.x() = std::abs(p.x()) < voxel / 4 ? 0 : p.x();
  }
  TriangleMesh half;
  constexpr auto none = ~Index{0};
  std::vector<Index> number(mesh.positions.size(), none);
  for (Triangle t : mesh.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](Index v) { return mesh.positions[v].x() > 0; })) {
      continue;
    }
    for (Index& v : t) {
      if (number[v] == none) {
        number[v] = static_cast<Index>(half.positions.size());
        half.positions.push_back(mesh.positions[v]);
      }
      v = number[v];
    }
    half.triangles.push_back(t);
  }
  return half;
}

// Adds to the set every voxel whose center is within `reach` voxels of the center of one in it.
void grow(std::vector<std::uint8_t>& set, const std::array<int, 3>& dims, double reach) {
  const auto nx = static_cast<std::size_t>(dims[0]);
  const auto ny = static_cast<std::size_t>(dims[1]);
  const auto nz = static_cast<std::size_t>(dims[2]);
  // Separable squared distance, cut off at the reach: along x, then y, then z.
  const int r = static_cast<int>(std::floor(reach));
  const double far = reach * reach + 1;
  std::vector<double> squared(set.size(), far);
  for (std::size_t i = 0; i < set.size(); ++i) {
    squared[i] = set[i] != 0 ? 0 : far;
  }
  const std::array<std::size_t, 3> counts = {nx, ny, nz};
  const std::array<std::size_t, 3> strides = {1, nx, nx * ny};
  for (int k = 0; k < 3; ++k) {
    std::vector<double> next(set.size(), far);
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto at = static_cast<int>(i / strides[k] % counts[k]);
      const int low = std::max(0, at - r);
      const int high = std::min(static_cast<int>(counts[k]) - 1, at + r);
      for (int j = low; j <= high; ++j) {
        const double d = squared[i + strides[k] * static_cast<std::size_t>(j) -
                                 strides[k] * static_cast<std::size_t>(at)] +
                         (j - at) * (j - at);
        next[i] = std::min(next[i], d);
      }
    }
    squared = std::move(next);
  }
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = squared[i] <= reach * reach ? 1 : 0;
  }
}

// A grid with `layers` more outer voxels on every side.
VoxelGrid padded(const VoxelGrid& grid, int layers) {
  VoxelGrid wide = grid;
  for (int& d : wide.dims) {
    d += 2 * layers;
  }
  wide.origin = grid.corner(-layers, -layers, -layers);
  wide.kinds.assign(wide.index(0, 0, wide.dims[2]), VoxelKind::outer);
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const auto [x, y, z] = grid.cell(i);
    wide.kinds[wide.index(x + layers, y + layers, z + layers)] = grid.kinds[i];
  }
  return wide;
}

// Morphological closing: what a ball of that radius (in voxels) cannot enter from outside.
void close_gaps(VoxelGrid& grid, double radius) {
  grid = padded(grid, static_cast<int>(std::ceil(radius)) + 1);
  std::vector<std::uint8_t> set(grid.kinds.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    set[i] = grid.occupied(i) ? 1 : 0;
  }
  grow(set, grid.dims, radius);
  for (std::uint8_t& s : set) {
    s = s == 0 ? 1 : 0;
  }
  grow(set, grid.dims, radius);
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set[i] == 0 && !grid.occupied(i)) {
      grid.kinds[i] = VoxelKind::inner;
    }
  }
}

// The handles of a model of one closed piece, which no grid is likely to show fewer of. Of other
// models nothing is known: 0.
long known_handles(const SurfacePatches& patches, std::size_t positions) {
  if (patches.closed.size() != 1 || !patches.closed[0]) {
    return 0;
  }
  std::vector<bool> used(positions, false);
  for (const Triangle& t : patches.triangles) {
    used[t[0]] = used[t[1]] = used[t[2]] = true;
  }
  const auto vertices = static_cast<long>(std::count(used.begin(), used.end(), true));
  const auto triangles = static_cast<long>(patches.triangles.size());
  return 1 - (vertices - triangles / 2) / 2;
}

Result<Envelope> at_resolution(TriangleView model, const SurfacePatches& patches,
                               const EnvelopeOptions& options, int resolution,
                               const Progress& progress) {
  Result<VoxelGrid> grid = voxels(model, patches, options, resolution, progress);
  if (!grid) {
    return grid.error();
  }
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  if (options.closing > 0) {
    close_gaps(*grid, options.closing * unit_of(model, options) / grid->size);
  }
  if (options.half) {
    mirror_occupied(*grid);
  }
  Envelope result;
  result.resolution = resolution;
  result.closing = options.closing;
  result.bridges = join_pieces(*grid);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  make_manifold(*grid, options.half); // bridges do not heed the plane
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  for (VoxelKind& kind : grid->kinds) {
    kind = kind == VoxelKind::outer ? kind : VoxelKind::feature;
  }
  result.mesh = to_triangle_mesh(voxel_boxes(*grid, {VoxelKind::feature}));
  const auto euler = static_cast<long>(result.mesh.positions.size()) -
                     static_cast<long>(result.mesh.triangles.size() / 2);
  result.genus = static_cast<int>(1 - euler / 2);
  result.known = static_cast<int>(known_handles(patches, model.positions.size()));
  if (options.half) {
    result.mesh = half_of(std::move(result.mesh), grid->size);
  }
  return result;
}

} // namespace

Result<Envelope> envelope(TriangleView model, const EnvelopeOptions& options,
                          const Progress& progress) {
  if (!(options.clearance > 0 && options.clearance < 1)) {
    return Error{ErrorCode::invalid_option, "the clearance must be above 0 and below 1"};
  }
  const double size = diagonal(model.positions);
  if (!(size > 0) || !std::isfinite(size)) {
    return Error{ErrorCode::unfit_model,
                 "the model has no extent, or a coordinate that is not finite"};
  }
  if (options.resolution != 0) {
    if (options.resolution < 2 || options.resolution > 4096) {
      return Error{ErrorCode::invalid_option, "the resolution is " +
                                                  std::to_string(options.resolution) +
                                                  "; it must be from 2 to 4096"};
    }
    return at_resolution(model, surface_patches(model), options, options.resolution, progress);
  }
  const SurfacePatches patches = surface_patches(model);
  const long handles = known_handles(patches, model.positions.size());
  // A handle costs vertices and is rarely the model's own when a finer grid does not show it. Of
  // the first few resolutions with the least genus the coarsest is taken, or the first that shows
  // no more handles than the model has.
  const double least = std::clamp(3.2 * std::sqrt(options.vertices), 24.0, 64.0);
  std::optional<Envelope> best;
  constexpr std::array<double, 5> factors = {1, 1.2, 1.45, 1.75, 2.1};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    Result<Envelope> next = at_resolution(
        model, patches, options, static_cast<int>(std::lround(least * factors[i])),
        progress.part(0.1 * static_cast<double>(i), 0.1 * static_cast<double>(i + 1)));
    if (!next) {
      return next;
    }
    if (!best || next->genus < best->genus) {
      best = std::move(*next);
    }
    if (best->genus <= handles) {
      break;
    }
  }
  // More handles than the vertices can go round: the narrowest are filled.
  constexpr int vertices_for_a_handle = 8;
  constexpr std::array<double, 4> closings = {0.01, 0.02, 0.035, 0.06};
  EnvelopeOptions closed = options;
  for (std::size_t i = 0;
       i < closings.size() && vertices_for_a_handle * best->genus > options.vertices; ++i) {
    closed.closing = std::max(options.closing, closings[i]);
    Result<Envelope> next = at_resolution(
        model, patches, closed, static_cast<int>(std::lround(least)),
        progress.part(0.5 + 0.1 * static_cast<double>(i), 0.6 + 0.1 * static_cast<double>(i)));
    if (!next) {
      return next;
    }
    if (next->genus < best->genus) {
      best = std::move(*next);
    }
  }
  return *std::move(best);
}

} // namespace cagewright
