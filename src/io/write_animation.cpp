#include <cagewright/io/write_animation.h>

#include "io/atomic_file.h"
#include "io/float_range.h"
#include "io/write_glb_animation.h"
#include <cagewright/io/point_cache.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace cagewright {
namespace {

Status write_cache(const MovingMesh& mesh, const std::filesystem::path& path,
                   const Progress& progress) {
  Result<PointCacheWriter> file =
      PointCacheWriter::create(path, mesh.rest.positions.size(), mesh.shares.size(),
                               {mesh.first_frame, mesh.frames_per_second});
  if (!file) {
    return file.error();
  }
  for (std::size_t f = 0; f < mesh.shares.size(); ++f) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    progress(static_cast<double>(f) / static_cast<double>(mesh.shares.size()), "writing");
    if (Status s = file->append(mesh.at(f)); !s) {
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
    if (!std::all_of(mesh.shapes[k].begin(), mesh.shapes[k].end(), fits_floats)) {
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
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".glb" && !is_point_cache(path)) {
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
  return write_cache(mesh, path, progress);
}

} // namespace cagewright
