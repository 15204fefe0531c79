#include <cagewright/deform/write_movement.h>

#include <cagewright/deform/normals.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/write_animation.h>

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

// Of a point cache so much is moved at a time: weights are computed anew for each part.
constexpr std::size_t bytes_at_a_time = std::size_t{1} << 28U;

Status write_cache(const ModelFile& file, std::span<const std::vector<Vec3>> cages,
                   const Mover& move, const FrameTimes& times, const std::filesystem::path& output,
                   const FrameSeen& seen) {
  const std::size_t points = file.mesh().positions.size();
  Result<PointCacheWriter> cache = PointCacheWriter::create(output, points, cages.size(), times);
  if (!cache) {
    return cache.error();
  }
  const std::size_t at_a_time =
      std::max<std::size_t>(1, bytes_at_a_time / (sizeof(Vec3) * std::max<std::size_t>(1, points)));
  for (std::size_t first = 0; first < cages.size(); first += at_a_time) {
    const auto moved = move(cages.subspan(first, std::min(at_a_time, cages.size() - first)));
    if (!moved) {
      return moved.error();
    }
    for (std::size_t i = 0; i < moved->size(); ++i) {
      if (Status s = cache->append((*moved)[i]); !s) {
        return s;
      }
      if (seen) {
        seen(first + i, (*moved)[i]);
      }
    }
  }
  return cache->commit();
}

/// A frame is a shape of its own: the middle of two frames is the middle of their shapes.
Result<std::vector<FileNote>> write_glb(const ModelFile& file,
                                        std::span<const std::vector<Vec3>> cages, const Mover& move,
                                        const FrameTimes& times,
                                        const std::filesystem::path& output,
                                        const Progress& progress, const FrameSeen& seen) {
  auto moved = move(cages);
  if (!moved) {
    return moved.error();
  }
  Result<MeshAttributes> attributes = file.attributes();
  if (!attributes) {
    return attributes.error();
  }
  MovingMesh mesh;
  mesh.rest = file.mesh();
  mesh.attributes = *std::move(attributes);
  mesh.first_frame = times.first_frame;
  mesh.frames_per_second = times.frames_per_second;
  NormalField normals(mesh.rest, smooth_normals(mesh.rest));
  normals.update(mesh.rest.positions);
  mesh.rest_normals.assign(normals.normals().begin(), normals.normals().end());
  mesh.shapes = *std::move(moved);
  for (std::size_t f = 0; f < mesh.shapes.size(); ++f) {
    if (seen) {
      seen(f, mesh.shapes[f]);
    }
    normals.update(mesh.shapes[f]);
    mesh.normals.emplace_back(normals.normals().begin(), normals.normals().end());
    mesh.shares.emplace_back(mesh.shapes.size(), 0.0);
    mesh.shares.back()[f] = 1;
  }
  std::vector<FileNote> notes;
  if (file.format() == MeshFormat::gltf) {
    notes.push_back({"lost", output.string() +
                                 ": the animated model has the faces, materials and texture points "
                                 "of the original; its images, joints, nodes and animations are "
                                 "left out"});
  }
  if (const Status written = write_animation(mesh, output, progress); !written) {
    return written.error();
  }
  return notes;
}

} // namespace

bool holds_movement(const std::filesystem::path& output, std::size_t poses) {
  return is_point_cache(output) ||
         (poses > 1 && format_of_name(output) == MeshFormat::gltf && output.extension() != ".gltf");
}

Result<std::vector<FileNote>> write_movement(const ModelFile& file,
                                             std::span<const std::vector<Vec3>> cages,
                                             const Mover& move, const FrameTimes& times,
                                             const std::filesystem::path& output,
                                             const Progress& progress, const FrameSeen& seen) {
  if (!is_point_cache(output)) {
    return write_glb(file, cages, move, times, output, progress, seen);
  }
  const Status written = write_cache(file, cages, move, times, output, seen);
  return written ? Result<std::vector<FileNote>>(std::vector<FileNote>()) : written.error();
}

} // namespace cagewright
