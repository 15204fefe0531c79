#include "envelope/envelope.h"

#include "envelope/closing.h"
#include "envelope/handles.h"
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
constexpr int vertices_for_a_handle = 8; // a cage needs to go round one

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

std::optional<int> known_handles(const SurfacePatches& patches, std::size_t positions) {
  if (patches.closed.size() != 1 || !patches.closed[0]) {
    return std::nullopt;
  }
  std::vector<bool> used(positions, false);
  for (const Triangle& t : patches.triangles) {
    used[t[0]] = used[t[1]] = used[t[2]] = true;
  }
  const auto vertices = static_cast<long>(std::count(used.begin(), used.end(), true));
  const auto triangles = static_cast<long>(patches.triangles.size());
  return static_cast<int>(1 - (vertices - triangles / 2) / 2);
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
    const double radius = options.closing * unit_of(model, options) / grid->size;
    *grid = padded(*grid, layers_to_close(radius));
    close_gaps(*grid, radius);
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
  result.known = options.own_handles >= 0
                     ? options.own_handles
                     : known_handles(patches, model.positions.size()).value_or(0);
  result.genus = genus_of(*grid);
  const int wanted = std::min(result.known, options.vertices / vertices_for_a_handle);
  if (options.fill > 0 && result.genus > wanted) {
    const double widest = options.fill / 2 * unit_of(model, options) / grid->size;
    result.genus = fill_handles(*grid, wanted, widest, options.half);
    result.fill = options.fill;
  }
  for (VoxelKind& kind : grid->kinds) {
    kind = kind == VoxelKind::outer ? kind : VoxelKind::feature;
  }
  result.mesh = to_triangle_mesh(voxel_boxes(*grid, {VoxelKind::feature}));
  if (options.half) {
    result.mesh = half_of(std::move(result.mesh), grid->size);
  }
  return result;
}

} // namespace

std::optional<int> known_handles(TriangleView model) {
  return known_handles(surface_patches(model), model.positions.size());
}

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
  const int handles = options.own_handles >= 0
                          ? options.own_handles
                          : known_handles(patches, model.positions.size()).value_or(0);
  // A handle costs vertices and is rarely the model's own when a finer grid does not show it. Of
  // the first few resolutions with the least genus the coarsest is taken, or the first that shows
  // no more handles than the model has.
  const double least = std::clamp(3.2 * std::sqrt(options.vertices), 24.0, 64.0);
  std::optional<Envelope> best;
  EnvelopeOptions bare = options; // what is filled tells nothing
  bare.fill = 0;
  constexpr std::array<double, 5> factors = {1, 1.2, 1.45, 1.75, 2.1};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    Result<Envelope> next = at_resolution(
        model, patches, bare, static_cast<int>(std::lround(least * factors[i])),
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
  constexpr std::array<double, 4> closings = {0.01, 0.02, 0.035, 0.06};
  EnvelopeOptions closed = bare;
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
  if (options.fill > 0 && best->genus > handles) {
    EnvelopeOptions filled = options;
    filled.closing = best->closing;
    return at_resolution(model, patches, filled, best->resolution, progress.part(0.9, 1));
  }
  return *std::move(best);
}

} // namespace cagewright
