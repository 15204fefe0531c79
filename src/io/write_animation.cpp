#include <cagewright/io/write_animation.h>

#include "io/atomic_file.h"
#include "io/write_glb_animation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace cagewright {
namespace {

template <class T> void put(std::string& bytes, T value, std::endian order) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  if (order != std::endian::native) {
    std::ranges::reverse(raw);
  }
  bytes.append(raw.data(), raw.size());
}

/// The head of the file; frames follow.
std::string head_of(const MovingMesh& mesh, bool is_pc2) {
  std::string bytes;
  const auto frames = static_cast<std::int32_t>(mesh.shares.size());
  const auto points = static_cast<std::int32_t>(mesh.rest.positions.size());
  if (is_pc2) {
    constexpr std::endian little = std::endian::little;
    bytes.append("POINTCACHE2\0", 12);
    put<std::int32_t>(bytes, 1, little); // version
    put(bytes, points, little);
    put(bytes, static_cast<float>(mesh.first_frame), little);
    put(bytes, 1.0F, little); // frames from one sample to the next
    put(bytes, frames, little);
    return bytes;
  }
  constexpr std::endian big = std::endian::big;
  put(bytes, frames, big);
  put(bytes, points, big);
  for (std::int32_t f = 0; f < frames; ++f) {
    put(bytes, static_cast<float>((mesh.first_frame + f) / mesh.frames_per_second), big);
  }
  return bytes;
}

Status write_cache(const MovingMesh& mesh, const std::filesystem::path& path, bool is_pc2,
                   const Progress& progress) {
  Result<PartFile> file = PartFile::create(path);
  if (!file) {
    return file.error();
  }
  if (Status s = file->append(head_of(mesh, is_pc2)); !s) {
    return s;
  }
  const std::endian order = is_pc2 ? std::endian::little : std::endian::big;
  std::string bytes;
  for (std::size_t f = 0; f < mesh.shares.size(); ++f) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    progress(static_cast<double>(f) / static_cast<double>(mesh.shares.size()), "writing");
    bytes.clear();
    for (const Vec3& p : mesh.at(f)) {
      for (int k = 0; k < 3; ++k) {
        put(bytes, static_cast<float>(p[k]), order);
      }
    }
    if (Status s = file->append(bytes); !s) {
      return s;
    }
  }
  return file->commit();
}

/// What is wrong with the numbers of positions, if anything is.
Status check(const MovingMesh& mesh, const std::filesystem::path& path) {
  const std::size_t count = mesh.rest.positions.size();
  const auto mismatch = [&](const std::string& what) {
    return Error{ErrorCode::mismatch, path.string() + ": " + what};
  };
  for (std::size_t k = 0; k < mesh.shapes.size(); ++k) {
    if (mesh.shapes[k].size() != count) {
      return mismatch("shape " + std::to_string(k) + " has " +
                      std::to_string(mesh.shapes[k].size()) + " vertices, the mesh has " +
                      std::to_string(count));
    }
    // (A float holds it, and it is no NaN.)
    const auto fits = [](const Vec3& p) {
      return p.cwiseAbs().maxCoeff() <= static_cast<double>(std::numeric_limits<float>::max()) &&
             p.allFinite();
    };
    if (!std::ranges::all_of(mesh.shapes[k], fits)) {
      return Error{ErrorCode::cannot_write,
                   path.string() + ": a position of shape " + std::to_string(k) +
                       " is not finite, or too large for the file's numbers"};
    }
  }
  for (const std::vector<double>& shares : mesh.shares) {
    if (shares.size() != mesh.shapes.size()) {
      return mismatch("a frame is made of " + std::to_string(shares.size()) +
                      " shapes, but there are " + std::to_string(mesh.shapes.size()));
    }
  }
  if (mesh.shapes.empty() || mesh.shares.empty()) {
    return mismatch("there is no shape, or no frame");
  }
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (count > most || mesh.shares.size() > most) {
    return Error{ErrorCode::unsupported,
                 path.string() + ": more vertices or frames than the file can count"};
  }
  return success();
}

} // namespace

std::vector<Vec3> MovingMesh::at(std::size_t frame) const {
  std::vector<Vec3> positions(rest.positions.size(), Vec3::Zero());
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const double share = shares[frame][k];
    for (std::size_t v = 0; share != 0 && v < positions.size(); ++v) {
      positions[v] += share * shapes[k][v];
    }
  }
  return positions;
}

Status write_animation(const MovingMesh& mesh, const std::filesystem::path& path,
                       const Progress& progress) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".glb" && extension != ".pc2" && extension != ".mdd") {
    return Error{ErrorCode::unsupported,
                 path.string() + ": movements are written as .glb, .pc2 or .mdd"};
  }
  if (Status s = check(mesh, path); !s) {
    return s;
  }
  if (extension == ".glb") {
    const Result<std::string> bytes = format_glb_animation(mesh, path, progress);
    return bytes ? write_file_atomically(path, *bytes) : Status(bytes.error());
  }
  return write_cache(mesh, path, extension == ".pc2", progress);
}

} // namespace cagewright
