#include "io/write_gltf.h"

#include "io/glb.h"
#include "io/gltf_document.h"
#include "io/number_text.h"
#include "io/uri.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// From so many sizes of the model away from the origin on its nodes move it: floats have 24 bits,
// and up to here they place vertices within a millionth of the size.
constexpr double far_away = 8;

enum ComponentType {
  unsigned_byte = 5121,
  unsigned_short = 5123,
  unsigned_int = 5125,
  real = 5126
};
enum ViewTarget { vertices = 34962, indices = 34963 };

/// One corner of a triangle with what glTF stores for a vertex.
struct DressedCorner {
  Index vertex = 0;
  std::array<float, 2> texture{}; // v downwards
  std::array<float, 3> normal{};
  std::size_t place = 0; // among the corners of the group's triangles

  [[nodiscard]] auto look() const { return std::tie(vertex, texture, normal); }
};

class GltfWriter {
public:
  GltfWriter(const PolygonMesh& mesh, const MeshAttributes& attributes)
      : mesh_(mesh), attributes_(attributes), triangulation_(triangulate(mesh)) {
    const Box3 box = bounding_box(mesh.positions);
    const double reach = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    if (reach > far_away * box.diagonal().norm()) {
      shift_ = box.center();
    }
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      first_corner_.push_back(
          first_corner_.empty() ? 0 : first_corner_.back() + mesh.face(f - 1).size());
    }
  }

  Result<std::string> write(bool as_json) {
    const bool fits =
        std::all_of(mesh_.positions.begin(), mesh_.positions.end(), [&](const Vec3& p) {
          return (p - shift_).cwiseAbs().maxCoeff() <= std::numeric_limits<float>::max();
        });
    if (!fits) {
      return Error{ErrorCode::cannot_write, "the coordinates are too large for the floats of glTF; "
                                            "write .obj, .ply, .off or .stl"};
    }
    add_materials();
    add_groups();
    finish();
    if (!as_json) {
      return glb_of(json_.dump(), binary_);
    }
    json_["buffers"][0]["uri"] = data_uri(binary_);
    return json_.dump(1) + '\n';
  }

private:
  void add_materials() {
    for (const std::string& name : attributes_.material_names) {
      json_["materials"].push_back(Json{{"name", as_utf8(name)}});
    }
  }

  void add_groups() {
    std::vector<std::vector<std::size_t>> triangles(std::max<std::size_t>(1, group_count()));
    for (std::size_t t = 0; t < triangulation_.triangles.size(); ++t) {
      const Index face = triangulation_.face_of[t];
      triangles[mesh_.face_groups.empty() ? 0 : mesh_.face_groups[face]].push_back(t);
    }
    for (std::size_t g = 0; g < triangles.size(); ++g) {
      if (!triangles[g].empty()) {
        add_node(g, add_mesh(g, triangles[g]));
      }
    }
  }

  [[nodiscard]] std::size_t group_count() const {
    return mesh_.face_groups.empty() ? 0 : mesh_.group_names.size();
  }

  [[nodiscard]] std::string name_of_group(std::size_t g) const {
    return group_count() == 0 ? std::string("mesh") : as_utf8(mesh_.group_names[g]);
  }

  void add_node(std::size_t group, std::size_t mesh) {
    Json node{{"mesh", mesh}, {"name", name_of_group(group)}};
    if (!shift_.isZero(0)) {
      node["translation"] = Json::array({shift_.x(), shift_.y(), shift_.z()});
    }
    const std::size_t index = nodes_.size();
    nodes_.push_back(std::move(node));
    const std::string object = group < attributes_.group_objects.size() && group_count() > 0
                                   ? as_utf8(attributes_.group_objects[group])
                                   : std::string();
    if (object.empty()) {
      roots_.push_back(index);
      return;
    }
    const auto [known, is_new] = objects_.try_emplace(object, nodes_.size());
    if (is_new) {
      nodes_.push_back(Json{{"name", object}, {"children", Json::array()}});
      roots_.push_back(known->second);
    }
    nodes_[known->second]["children"].push_back(index);
  }

  /// \returns its number
  std::size_t add_mesh(std::size_t group, const std::vector<std::size_t>& triangles) {
    std::vector<DressedCorner> corners = dressed(triangles);
    std::sort(corners.begin(), corners.end(),
              [](const DressedCorner& a, const DressedCorner& b) { return a.look() < b.look(); });
    std::vector<std::uint32_t> vertex_of_corner(corners.size());
    std::vector<DressedCorner> vertices;
    for (const DressedCorner& corner : corners) {
      if (vertices.empty() || vertices.back().look() != corner.look()) {
        vertices.push_back(corner);
      }
      vertex_of_corner[corner.place] = static_cast<std::uint32_t>(vertices.size() - 1);
    }
    const Json attributes = add_attributes(vertices);
    Json primitives = Json::array();
    for (const auto& [material, list] : by_material(triangles)) {
      Json primitive{{"attributes", attributes},
                     {"indices", add_indices(list, vertex_of_corner, vertices.size())}};
      if (material != MeshAttributes::none) {
        primitive["material"] = material;
      }
      primitives.push_back(std::move(primitive));
    }
    json_["meshes"].push_back(Json{{"name", name_of_group(group)}, {"primitives", primitives}});
    return json_["meshes"].size() - 1;
  }

  /// The places of the group's triangles by their material, `none` last.
  [[nodiscard]] std::map<Index, std::vector<std::size_t>>
  by_material(const std::vector<std::size_t>& triangles) const {
    std::map<Index, std::vector<std::size_t>> lists;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const Index face = triangulation_.face_of[triangles[i]];
      lists[attributes_.face_materials.empty() ? MeshAttributes::none
                                               : attributes_.face_materials[face]]
          .push_back(i);
    }
    return lists;
  }

  std::vector<DressedCorner> dressed(const std::vector<std::size_t>& triangles) {
    has_texture_ = false;
    has_normals_ = false;
    std::vector<DressedCorner> corners;
    corners.reserve(3 * triangles.size());
    for (const std::size_t t : triangles) {
      const Triangle& triangle = triangulation_.triangles[t];
      const Vec3 flat = facet_normal(mesh_.positions[triangle[0]], mesh_.positions[triangle[1]],
                                     mesh_.positions[triangle[2]]);
      for (const Index vertex : triangle) {
        const std::size_t corner = corner_of(triangulation_.face_of[t], vertex);
        DressedCorner& made = corners.emplace_back();
        made.vertex = vertex;
        made.place = corners.size() - 1;
        made.texture = texture_at(corner);
        made.normal = normal_at(corner, flat);
      }
    }
    for (DressedCorner& corner : corners) { // what none has must not split vertices
      corner.normal = has_normals_ ? corner.normal : std::array<float, 3>{};
    }
    return corners;
  }

  [[nodiscard]] std::size_t corner_of(Index face, Index vertex) const {
    const std::span<const Index> corners = mesh_.face(face);
    return first_corner_[face] +
           static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) -
                                    corners.begin());
  }

  std::array<float, 2> texture_at(std::size_t corner) {
    if (attributes_.texture_of_corner.empty() ||
        attributes_.texture_of_corner[corner] == MeshAttributes::none) {
      return {};
    }
    has_texture_ = true;
    const auto& [u, v] = attributes_.texture_points[attributes_.texture_of_corner[corner]];
    const bool is_point = std::abs(u) < 1e30 && std::abs(v) < 1e30;
    return is_point ? std::array{static_cast<float>(u), static_cast<float>(1 - v)}
                    : std::array<float, 2>{};
  }

  std::array<float, 3> normal_at(std::size_t corner, const Vec3& flat) {
    Vec3 normal = Vec3::Zero();
    if (!attributes_.normal_of_corner.empty() &&
        attributes_.normal_of_corner[corner] != MeshAttributes::none) {
      normal = attributes_.normals[attributes_.normal_of_corner[corner]].stableNormalized();
    }
    if (normal.allFinite() && !normal.isZero(0)) {
      has_normals_ = true;
    } else {
      normal = flat.isZero(0) ? Vec3(0, 0, 1) : flat; // any unit vector will do without an area
    }
    return {static_cast<float>(normal.x()), static_cast<float>(normal.y()),
            static_cast<float>(normal.z())};
  }

  Json add_attributes(const std::vector<DressedCorner>& vertices) {
    Json result;
    std::vector<float> values;
    for (const DressedCorner& vertex : vertices) {
      const Vec3 p = mesh_.positions[vertex.vertex] - shift_;
      values.insert(values.end(), {static_cast<float>(p.x()), static_cast<float>(p.y()),
                                   static_cast<float>(p.z())});
    }
    result["POSITION"] = add_accessor(values, 3, "VEC3");
    set_bounds(values);
    if (has_normals_) {
      values.clear();
      for (const DressedCorner& vertex : vertices) {
        values.insert(values.end(), vertex.normal.begin(), vertex.normal.end());
      }
      result["NORMAL"] = add_accessor(values, 3, "VEC3");
    }
    if (has_texture_) {
      values.clear();
      for (const DressedCorner& vertex : vertices) {
        values.insert(values.end(), vertex.texture.begin(), vertex.texture.end());
      }
      result["TEXCOORD_0"] = add_accessor(values, 2, "VEC2");
    }
    if (!mesh_.colors.empty()) {
      values.clear();
      for (const DressedCorner& vertex : vertices) {
        const auto& color = mesh_.colors[vertex.vertex];
        values.insert(values.end(), color.begin(), color.end());
      }
      result["COLOR_0"] = add_colors(values);
    }
    return result;
  }

  std::size_t add_accessor(const std::vector<float>& values, std::size_t components,
                           const char* type) {
    const std::size_t view = begin_view(ViewTarget::vertices);
    for (const float value : values) {
      append(std::bit_cast<std::uint32_t>(value), 4);
    }
    return end_view(view, ComponentType::real, values.size() / components, type);
  }

  /// In bytes where that loses nothing.
  std::size_t add_colors(const std::vector<float>& values) {
    const bool are_bytes = std::all_of(values.begin(), values.end(), [](float channel) {
      return std::round(channel * 255) / 255 == channel;
    });
    if (!are_bytes) {
      return add_accessor(values, 4, "VEC4");
    }
    const std::size_t view = begin_view(ViewTarget::vertices);
    for (const float value : values) {
      append(static_cast<std::uint32_t>(std::lround(value * 255)), 1);
    }
    const std::size_t accessor =
        end_view(view, ComponentType::unsigned_byte, values.size() / 4, "VEC4");
    json_["accessors"][accessor]["normalized"] = true;
    return accessor;
  }

  std::size_t add_indices(const std::vector<std::size_t>& triangles,
                          const std::vector<std::uint32_t>& vertex_of_corner, std::size_t count) {
    // The largest number of a type ends a strip, and may not be a vertex.
    const bool are_short = count <= std::numeric_limits<std::uint16_t>::max();
    const std::size_t view = begin_view(ViewTarget::indices);
    for (const std::size_t triangle : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        append(vertex_of_corner[3 * triangle + k], are_short ? 2 : 4);
      }
    }
    return end_view(view, are_short ? ComponentType::unsigned_short : ComponentType::unsigned_int,
                    3 * triangles.size(), "SCALAR");
  }

  void append(std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      binary_.push_back(static_cast<char>((value >> (8 * i)) & 0xffU));
    }
  }

  std::size_t begin_view(ViewTarget target) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    json_["bufferViews"].push_back(
        Json{{"buffer", 0}, {"byteOffset", binary_.size()}, {"target", static_cast<int>(target)}});
    return json_["bufferViews"].size() - 1;
  }

  std::size_t end_view(std::size_t view, ComponentType component, std::size_t count,
                       const char* type) {
    Json& made = json_["bufferViews"][view];
    made["byteLength"] = binary_.size() - made["byteOffset"].get<std::size_t>();
    json_["accessors"].push_back(Json{{"bufferView", view},
                                      {"componentType", static_cast<int>(component)},
                                      {"count", count},
                                      {"type", type}});
    return json_["accessors"].size() - 1;
  }

  /// Of the accessor that was added last.
  void set_bounds(const std::vector<float>& values) {
    std::array<float, 3> low = {values[0], values[1], values[2]};
    std::array<float, 3> high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], values[i]);
      high[i % 3] = std::max(high[i % 3], values[i]);
    }
    json_["accessors"].back()["min"] = low;
    json_["accessors"].back()["max"] = high;
  }

  void finish() {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    json_["asset"] = {{"version", "2.0"}, {"generator", "Cagewright"}};
    json_["buffers"] = Json::array({Json{{"byteLength", binary_.size()}}});
    json_["nodes"] = nodes_;
    json_["scenes"] = Json::array({Json{{"nodes", roots_}}});
    json_["scene"] = 0;
  }

  /// A name as JSON can hold it: bytes that are no UTF-8 are taken for Latin-1.
  static std::string as_utf8(const std::string& name) {
    try {
      (void)Json(name).dump();
      return name;
    } catch (const Json::exception&) {
    }
    std::string text;
    for (const char c : name) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x80) {
        text.push_back(c);
      } else {
        text.push_back(static_cast<char>(0xc0 | (byte >> 6)));
        text.push_back(static_cast<char>(0x80 | (byte & 0x3f)));
      }
    }
    return text;
  }

  const PolygonMesh& mesh_;
  const MeshAttributes& attributes_;
  Triangulation triangulation_;
  std::vector<std::size_t> first_corner_; // of each face
  Vec3 shift_ = Vec3::Zero();
  Json json_ = Json::object();
  std::vector<Json> nodes_;
  std::vector<std::size_t> roots_;
  std::map<std::string, std::size_t> objects_; // their nodes
  std::string binary_;
  bool has_texture_ = false; // the group under way
  bool has_normals_ = false;
};

} // namespace

bool is_gltf_json_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".gltf";
}

Result<std::string> glb_of(std::string_view json, std::string_view binary) {
  const std::size_t length = 12 + 8 + padded_glb_size(json.size()) +
                             (binary.empty() ? 0 : 8 + padded_glb_size(binary.size()));
  if (length > std::numeric_limits<std::uint32_t>::max()) {
    return Error{ErrorCode::too_large,
                 "would be larger than the 4 GiB that GLB files can have; write .ply"};
  }
  std::string bytes("glTF");
  append_glb_size(bytes, 2);
  append_glb_size(bytes, length);
  append_glb_chunk(bytes, "JSON", json, ' ');
  if (!binary.empty()) {
    append_glb_chunk(bytes, std::string_view("BIN\0", 4), binary, '\0');
  }
  return bytes;
}

Result<std::string> format_gltf(const PolygonMesh& mesh, const MeshAttributes& attributes,
                                bool as_json) {
  return GltfWriter(mesh, attributes).write(as_json);
}

} // namespace cagewright
