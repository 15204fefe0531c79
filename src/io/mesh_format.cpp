#include <cagewright/io/mesh_format.h>

#include "io/off_header.h"
#include "io/ply_header.h"
#include "io/readers.h"
#include "io/text_cursor.h"

#include <algorithm>
#include <array>
#include <string>

namespace cagewright {

std::optional<MeshFormat> format_of_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  struct Known {
    std::string_view extension;
    MeshFormat format;
  };
  constexpr Known known[] = {{".obj", MeshFormat::obj},  {".ply", MeshFormat::ply},
                             {".stl", MeshFormat::stl},  {".off", MeshFormat::off},
                             {".glb", MeshFormat::gltf}, {".gltf", MeshFormat::gltf}};
  for (const Known& kind : known) {
    if (extension == kind.extension) {
      return kind.format;
    }
  }
  return std::nullopt;
}

std::optional<MeshFormat> format_of_content(std::string_view bytes) {
  if (bytes.starts_with("glTF")) {
    return MeshFormat::gltf;
  }
  if (begins_ply(bytes)) {
    return MeshFormat::ply;
  }
  if (has_the_size_of_binary_stl(bytes)) {
    return MeshFormat::stl;
  }
  TextCursor cursor(Source{{}, bytes.substr(0, 4096)}); // comments may stand first, but not forever
  if (!cursor.next_word_of_file()) {
    return std::nullopt;
  }
  const std::string_view word = cursor.word();
  if (off_header(word)) {
    return MeshFormat::off;
  }
  if (const std::string lower = stl_keyword(word); lower == "solid" || lower == "facet") {
    return MeshFormat::stl;
  }
  if (word.starts_with('{')) {
    return MeshFormat::gltf;
  }
  constexpr auto obj_words =
      std::to_array<std::string_view>({"v", "vt", "vn", "f", "o", "g", "s", "mtllib", "usemtl"});
  if (std::find(obj_words.begin(), obj_words.end(), word) != obj_words.end()) {
    return MeshFormat::obj;
  }
  return std::nullopt;
}

} // namespace cagewright
