/// \file
/// The kinds of mesh files.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace cagewright {

enum class MeshFormat {
  obj,  ///< Wavefront OBJ
  ply,  ///< Stanford PLY, text or binary of either byte order
  stl,  ///< STL, text or binary
  off,  ///< Geomview OFF and its variants, text or binary
  gltf, ///< glTF 2.0, as JSON (.gltf) or in one file (.glb)
};

/// "OBJ", "PLY", "STL", "OFF" or "glTF".
constexpr std::string_view name_of(MeshFormat format) {
  switch (format) {
  case MeshFormat::obj:
    return "OBJ";
  case MeshFormat::ply:
    return "PLY";
  case MeshFormat::stl:
    return "STL";
  case MeshFormat::off:
    return "OFF";
  case MeshFormat::gltf:
    return "glTF";
  }
  return "unknown"; // no default above: the compiler points here when a format is added
}

/// The format that a file's name promises: its extension in upper or lower case (.obj, .ply, .stl,
/// .off, .glb, .gltf); none for other extensions.
std::optional<MeshFormat> format_of_name(const std::filesystem::path& path);

/// The format that a file's first bytes show, whatever its name says; none when they show nothing:
/// an OBJ file has no mark of its own, and only its first word may tell.
std::optional<MeshFormat> format_of_content(std::string_view bytes);

} // namespace cagewright
