#include "movement.h"

#include "load.h"

#include <cagewright/deform/normals.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/write_animation.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

namespace cagewright::cli {
namespace {

// Of a point cache so much is moved at a time: weights are computed anew for each part.
constexpr std::size_t bytes_at_a_time = std::size_t{1} << 28U;

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The digits at the beginning, without zeros in front; `text` goes on after them.
std::string_view take_number(std::string_view& text) {
  const auto end = std::ranges::find_if_not(text, is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

Status write_cache(const ModelFile& file, std::span<const std::vector<Vec3>> cages,
                   const Mover& move, const FrameTimes& times, const std::string& output,
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
      seen(first + i, (*moved)[i]);
    }
  }
  return cache->commit();
}

/// A frame is a shape of its own: the middle of two frames is the middle of their shapes.
Status write_glb(const ModelFile& file, std::span<const std::vector<Vec3>> cages, const Mover& move,
                 const FrameTimes& times, const std::string& output, const FrameSeen& seen,
                 const Session& session) {
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
    seen(f, mesh.shapes[f]);
    normals.update(mesh.shapes[f]);
    mesh.normals.emplace_back(normals.normals().begin(), normals.normals().end());
    mesh.shares.emplace_back(mesh.shapes.size(), 0.0);
    mesh.shares.back()[f] = 1;
  }
  if (file.format() == MeshFormat::gltf) {
    const FileNote note{"lost", output +
                                    ": the animated model has the faces, materials and texture "
                                    "points of the original; its images, joints, nodes and "
                                    "animations are left out"};
    tell({&note, 1});
  }
  return write_animation(mesh, output, session.progress());
}

} // namespace

void add_time_options(CLI::App& command, FrameTimes& times) {
  command.add_option("--fps", times.frames_per_second, "Frames a second of a movement in one file")
      ->check(CLI::Range(0.001, 10000.0));
  command
      .add_option("--first-frame", times.first_frame,
                  "The number of the first deformed cage in a point cache")
      ->check(CLI::Range(-1e6, 1e6));
}

bool holds_movement(const std::string& output, std::size_t poses) {
  if (output.find('*') != std::string::npos || std::filesystem::is_directory(output)) {
    return false;
  }
  return is_point_cache(output) || (poses > 1 && format_of_name(output) == MeshFormat::gltf &&
                                    std::filesystem::path(output).extension() != ".gltf");
}

bool comes_before(std::string_view one, std::string_view other) {
  const std::pair whole{one, other};
  while (!one.empty() && !other.empty()) {
    if (is_digit(one.front()) && is_digit(other.front())) {
      const std::string_view a = take_number(one);
      const std::string_view b = take_number(other);
      if (a.size() != b.size() || a != b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
      }
    } else if (one.front() != other.front()) {
      return one.front() < other.front();
    } else {
      one.remove_prefix(1);
      other.remove_prefix(1);
    }
  }
  // (Names that differ in zeros alone, so that the order is total.)
  return one.empty() != other.empty() ? one.empty() : whole.first < whole.second;
}

void in_order_of_frames(std::vector<std::string>& names) {
  if (std::ranges::is_sorted(names) && !std::ranges::is_sorted(names, comes_before)) {
    std::ranges::sort(names, comes_before);
    const FileNote note{"frames_sorted",
                        fmt::format("the deformed cages are taken in the order of their numbers: "
                                    "first {}, last {}",
                                    names.front(), names.back())};
    tell({&note, 1});
  }
}

Status write_movement(const ModelFile& file, std::span<const std::vector<Vec3>> cages,
                      const Mover& move, const FrameTimes& times, const std::string& output,
                      const FrameSeen& seen, const Session& session) {
  const Status written = is_point_cache(output)
                             ? write_cache(file, cages, move, times, output, seen)
                             : write_glb(file, cages, move, times, output, seen, session);
  if (written) {
    session.say(fmt::format("{}: {} frames of {} vertices\n", output, cages.size(),
                            file.mesh().positions.size()));
  }
  return written;
}

} // namespace cagewright::cli
