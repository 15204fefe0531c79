/// \file
/// A glTF file with other positions, and all else as it was.
#pragma once

#include "io/gltf_scene.h"
#include "io/source.h"
#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/io/rewrite_positions.h>

#include <filesystem>
#include <optional>
#include <span>

namespace cagewright {

/// The normals of all vertices as the scene shows them, of unit length.
Result<FileNormals> read_gltf_normals(const Source& source,
                                      const std::optional<std::filesystem::path>& folder,
                                      Pose pose);

/// The same of a document that is open.
Result<FileNormals> read_gltf_normals(GltfDocument& document, const GltfScene& scene);

/// See rewrite_positions().
Status rewrite_gltf(const Source& source, const std::filesystem::path& folder, Pose pose,
                    std::span<const Vec3> positions, std::span<const Vec3> normals,
                    const std::filesystem::path& out);

} // namespace cagewright
