#include "io/gltf_dress.h"

#include "io/gltf_document.h"

#include <optional>

namespace cagewright {

void list_gltf_dress(const Source& source, MeshAttributes& attributes) {
  const Result<GltfDocument> document = GltfDocument::open(source, std::nullopt);
  if (!document) {
    return;
  }
  const Json& json = document->json();
  const auto has = [&](const char* list) {
    return member(json, list).is_array() && !member(json, list).empty();
  };
  bool has_texture = false;
  bool has_targets = false;
  const Json& meshes = member(json, "meshes");
  for (std::size_t m = 0; meshes.is_array() && m < meshes.size(); ++m) {
    const Json& primitives = member(meshes[m], "primitives");
    for (std::size_t p = 0; primitives.is_array() && p < primitives.size(); ++p) {
      has_texture |= !member(member(primitives[p], "attributes"), "TEXCOORD_0").is_null();
      has_targets |= !member(primitives[p], "targets").is_null();
    }
  }
  const auto lose = [&](bool is_there, const char* what) {
    if (is_there) {
      attributes.others.emplace_back(what);
    }
  };
  lose(has_texture, "texture coordinates");
  lose(has("materials"), "materials");
  lose(has("skins"), "skins");
  lose(has_targets, "morph targets");
  lose(has("animations"), "animations");
}

} // namespace cagewright
