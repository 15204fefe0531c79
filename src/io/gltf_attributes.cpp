#include "io/gltf_attributes.h"

#include "io/rewrite_gltf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace cagewright {
namespace {

/// Fills the lists for the corners and faces of one primitive after the other.
class Dresser {
public:
  Dresser(GltfDocument& document, const GltfScene& scene) : document_(document), scene_(scene) {}

  MeshAttributes dress() {
    add_normals();
    for (const GltfShown& shown : scene_.shown) {
      add_texture_points(primitive_of(shown), shown);
      add_material(primitive_of(shown), shown);
    }
    add_others();
    return std::move(attributes_);
  }

private:
  void add_normals() {
    Result<FileNormals> normals = read_gltf_normals(document_, scene_);
    if (normals) {
      attributes_.normals = std::move(normals->normals);
      attributes_.normal_of_corner = std::move(normals->of_corner);
    } else { // the shape does not need them
      attributes_.others.emplace_back("normals, which are damaged");
    }
  }

  void add_texture_points(const Json& primitive, const GltfShown& shown) {
    const auto accessor = to_size(member(member(primitive, "attributes"), "TEXCOORD_0"));
    if (!accessor) {
      return;
    }
    const GltfPlacement& placement = scene_.placements[shown.placement];
    const auto [known, is_new] = texture_bases_.try_emplace(
        {shown.placement, *accessor}, static_cast<Index>(attributes_.texture_points.size()));
    if (is_new) {
      const Result<std::vector<double>> values = document_.read_vectors(*accessor, 2);
      if (!values || values->size() != 2 * placement.count) {
        texture_bases_.erase(known);
        return;
      }
      for (std::size_t v = 0; v < placement.count; ++v) { // glTF has v downwards
        const std::array<double, 2> point = {(*values)[2 * v], 1 - (*values)[2 * v + 1]};
        const bool is_point = std::isfinite(point[0]) && std::isfinite(point[1]);
        attributes_.texture_points.push_back(is_point ? point : std::array<double, 2>{0, 0});
      }
    }
    attributes_.texture_of_corner.resize(scene_.mesh.corners().size(), MeshAttributes::none);
    for (std::size_t c = shown.first_corner; c < shown.end_corner; ++c) {
      attributes_.texture_of_corner[c] = known->second + scene_.mesh.corners()[c] - placement.base;
    }
  }

  void add_material(const Json& primitive, const GltfShown& shown) {
    const std::optional<std::size_t> index = to_size(member(primitive, "material"));
    const Json& material =
        element(member(document_.json(), "materials"), index.value_or(~std::size_t{0}));
    if (!material.is_object()) {
      return;
    }
    const auto [known, is_new] =
        materials_.try_emplace(*index, static_cast<Index>(attributes_.material_names.size()));
    if (is_new) {
      const std::string name = to_text(member(material, "name"));
      attributes_.material_names.push_back(name.empty() ? "material " + std::to_string(*index)
                                                        : one_line(name));
    }
    attributes_.face_materials.resize(scene_.mesh.face_count(), MeshAttributes::none);
    for (std::size_t f = shown.first_corner / 3; f < shown.end_corner / 3; ++f) {
      attributes_.face_materials[f] = known->second; // all faces are triangles
    }
  }

  [[nodiscard]] const Json& primitive_of(const GltfShown& shown) const {
    return element(member(element(member(document_.json(), "meshes"), shown.mesh), "primitives"),
                   shown.primitive);
  }

  void lose(bool has, std::string what) {
    if (has && std::find(attributes_.others.begin(), attributes_.others.end(), what) ==
                   attributes_.others.end()) {
      attributes_.others.push_back(std::move(what));
    }
  }

  void add_others() {
    for (const char* list : {"skins", "animations", "textures", "cameras"}) {
      lose(!member(document_.json(), list).empty(), list);
    }
    const Json& materials = member(document_.json(), "materials");
    lose(std::any_of(materials.begin(), materials.end(),
                     [](const Json& m) { return m.size() > m.contains("name"); }),
         "colours of materials");
    for (const GltfShown& shown : scene_.shown) {
      lose(!member(primitive_of(shown), "targets").empty(), "morph targets");
      for (const auto& [name, accessor] : member(primitive_of(shown), "attributes").items()) {
        add_other_attribute(name);
      }
    }
  }

  void add_other_attribute(const std::string& name) {
    if (name.starts_with("TEXCOORD_")) {
      lose(name != "TEXCOORD_0", "further sets of texture coordinates");
    } else if (name.starts_with("COLOR_")) {
      lose(name != "COLOR_0", "further sets of colours");
    } else if (name == "TANGENT") {
      lose(true, "tangents");
    } else if (name.starts_with('_')) {
      lose(true, "the values " + in_quotes(name) + " of vertices");
    }
  }

  GltfDocument& document_;
  const GltfScene& scene_;
  MeshAttributes attributes_;
  std::map<std::pair<std::size_t, std::size_t>, Index> texture_bases_; // (placement, accessor)
  std::map<std::size_t, Index> materials_;
};

} // namespace

MeshAttributes read_gltf_attributes(GltfDocument& document, const GltfScene& scene) {
  return Dresser(document, scene).dress();
}

} // namespace cagewright
