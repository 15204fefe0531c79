#include "io/write_glb_animation.h"

#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace cagewright {
namespace {

static_assert(std::endian::native == std::endian::little, "the binary chunk is little endian");

using Json = nlohmann::ordered_json;

// Of glTF.
constexpr int component_float = 5126;
constexpr int component_uint = 5125;
constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;

/// The vertices of the file: one for each vertex of the mesh and each texture point that its
/// corners have.
struct SplitVertices {
  std::vector<Index> mesh_vertex;             ///< of each
  std::vector<Index> texture_point;           ///< of each; empty: there are none
  std::vector<std::vector<std::uint32_t>> of; ///< corners of triangles, for each material
  std::vector<Index> materials;               ///< of each list; MeshAttributes::none: none
};

SplitVertices split_vertices(const PolygonMesh& mesh, const MeshAttributes& attributes) {
  const bool textured = attributes.texture_of_corner.size() == mesh.corners().size();
  const bool dressed = attributes.face_materials.size() == mesh.face_count();
  SplitVertices split;
  std::map<std::pair<Index, Index>, std::uint32_t> number;
  std::map<Index, std::size_t> list_of_material;
  std::vector<std::size_t> first_corner(mesh.face_count() + 1, 0);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    first_corner[f + 1] = first_corner[f] + mesh.face(f).size();
  }
  const Triangulation cut = triangulate(mesh);
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const Index f = cut.face_of[t];
    const Index material = dressed ? attributes.face_materials[f] : MeshAttributes::none;
    const auto [list, is_new_list] = list_of_material.try_emplace(material, split.of.size());
    if (is_new_list) {
      split.of.emplace_back();
      split.materials.push_back(material);
    }
    for (const Index v : cut.triangles[t]) {
      Index texture = MeshAttributes::none;
      if (textured) {
        const auto face = mesh.face(f);
        const auto corner =
            static_cast<std::size_t>(std::find(face.begin(), face.end(), v) - face.begin());
        texture = attributes.texture_of_corner[first_corner[f] + corner];
      }
      const auto [place, is_new] =
          number.try_emplace({v, texture}, static_cast<std::uint32_t>(split.mesh_vertex.size()));
      if (is_new) {
        split.mesh_vertex.push_back(v);
        if (textured) {
          split.texture_point.push_back(texture);
        }
      }
      split.of[list->second].push_back(place->second);
    }
  }
  return split;
}

/// The file as it grows: a buffer, and what the JSON says of it.
class Glb {
public:
  /// \returns the number of the accessor
  int add(const void* data, std::size_t bytes, std::size_t count, const char* type, int component,
          int target) {
    while (buffer_.size() % 4 != 0) {
      buffer_.push_back('\0');
    }
    Json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}};
    if (target != 0) {
      view["target"] = target;
    }
    buffer_.append(static_cast<const char*>(data), bytes);
    json["bufferViews"].push_back(view);
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int add_vectors(const std::vector<std::array<float, 3>>& values, bool with_bounds) {
    const int accessor = add(values.data(), values.size() * sizeof(values[0]), values.size(),
                             "VEC3", component_float, target_vertices);
    if (with_bounds) {
      std::array<float, 3> low = values[0];
      std::array<float, 3> high = values[0];
      for (const auto& v : values) {
        for (std::size_t k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], v[k]);
          high[k] = std::max(high[k], v[k]);
        }
      }
      json["accessors"].back()["min"] = low;
      json["accessors"].back()["max"] = high;
    }
    return accessor;
  }

  int add_scalars(const std::vector<float>& values, bool with_bounds) {
    const int accessor = add(values.data(), values.size() * sizeof(float), values.size(), "SCALAR",
                             component_float, 0);
    if (with_bounds) {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      json["accessors"].back()["min"] = {*low};
      json["accessors"].back()["max"] = {*high};
    }
    return accessor;
  }

  /// Errors: unsupported (beyond what its 32 bits can count).
  Result<std::string> bytes(const std::filesystem::path& path) {
    while (buffer_.size() % 4 != 0) {
      buffer_.push_back('\0');
    }
    json["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    std::string text = json.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    const std::size_t total = 12 + 8 + text.size() + 8 + buffer_.size();
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      return Error{ErrorCode::unsupported,
                   path.string() + ": the movement takes more than the 4 GB that a GLB file can "
                                   "hold; use fewer keyframes, or a point cache (.pc2, .mdd)"};
    }
    std::string file;
    file.reserve(total);
    const auto put = [&](std::size_t value) {
      const auto number = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&number), sizeof(number));
    };
    file += "glTF";
    put(2);
    put(total);
    put(text.size());
    file += "JSON";
    file += text;
    put(buffer_.size());
    file.append("BIN\0", 4);
    file += buffer_;
    return file;
  }

  Json json = {{"asset", {{"version", "2.0"}, {"generator", "Cagewright"}}},
               {"scene", 0},
               {"scenes", Json::array({{{"nodes", {0}}}})}};

private:
  std::string buffer_;
};

/// One value for each vertex of the file, less what is taken away.
template <class Value>
std::vector<std::array<float, 3>> gathered(const SplitVertices& split, const Value& value) {
  std::vector<std::array<float, 3>> result;
  result.reserve(split.mesh_vertex.size());
  for (const Index v : split.mesh_vertex) {
    const Vec3 p = value(v);
    result.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return result;
}

void add_materials(const SplitVertices& split, const MeshAttributes& attributes, Glb& glb) {
  for (const Index material : split.materials) {
    Json entry = {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
                  {"doubleSided", true}};
    if (material < attributes.material_names.size()) {
      entry["name"] = attributes.material_names[material];
    }
    glb.json["materials"].push_back(entry);
  }
}

} // namespace

Result<std::string> format_glb_animation(const MovingMesh& mesh, const std::filesystem::path& path,
                                         const Progress& progress) {
  const SplitVertices split = split_vertices(mesh.rest, mesh.attributes);
  if (split.mesh_vertex.empty()) {
    return Error{ErrorCode::unsupported, path.string() + ": a GLB file needs a face"};
  }
  const std::vector<Vec3>& rest = mesh.rest.positions;
  const Vec3 middle = bounding_box(rest).center();
  Glb glb;
  Json shared_attributes;
  shared_attributes["POSITION"] =
      glb.add_vectors(gathered(split, [&](Index v) -> Vec3 { return rest[v] - middle; }), true);
  const bool has_normals = mesh.rest_normals.size() == rest.size();
  if (has_normals) {
    // (glTF wants length one, also where a vertex has no face to take it from.)
    shared_attributes["NORMAL"] =
        glb.add_vectors(gathered(split,
                                 [&](Index v) -> Vec3 {
                                   const Vec3& n = mesh.rest_normals[v];
                                   return n.norm() > 0 ? n.normalized() : Vec3(Vec3::UnitY());
                                 }),
                        false);
  }
  if (!split.texture_point.empty()) {
    std::vector<std::array<float, 2>> points;
    for (const Index t : split.texture_point) {
      const std::array<double, 2> p = t < mesh.attributes.texture_points.size()
                                          ? mesh.attributes.texture_points[t]
                                          : std::array<double, 2>{0, 1};
      points.push_back({static_cast<float>(p[0]), static_cast<float>(1 - p[1])}); // v downwards
    }
    shared_attributes["TEXCOORD_0"] =
        glb.add(points.data(), points.size() * sizeof(points[0]), points.size(), "VEC2",
                component_float, target_vertices);
  }
  Json targets = Json::array();
  for (std::size_t k = 0; k < mesh.shapes.size(); ++k) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    progress(static_cast<double>(k) / static_cast<double>(mesh.shapes.size()), "writing");
    Json target;
    target["POSITION"] = glb.add_vectors(
        gathered(split, [&](Index v) -> Vec3 { return mesh.shapes[k][v] - rest[v]; }), true);
    if (has_normals && k < mesh.normals.size() && mesh.normals[k].size() == rest.size()) {
      target["NORMAL"] = glb.add_vectors(
          gathered(split,
                   [&](Index v) -> Vec3 { return mesh.normals[k][v] - mesh.rest_normals[v]; }),
          false);
    }
    targets.push_back(target);
  }
  add_materials(split, mesh.attributes, glb);
  Json primitives = Json::array();
  for (std::size_t list = 0; list < split.of.size(); ++list) {
    const std::vector<std::uint32_t>& corners = split.of[list];
    const int indices = glb.add(corners.data(), corners.size() * sizeof(corners[0]), corners.size(),
                                "SCALAR", component_uint, target_indices);
    primitives.push_back({{"attributes", shared_attributes},
                          {"indices", indices},
                          {"material", list},
                          {"targets", targets}});
  }
  glb.json["meshes"] = Json::array({{{"name", path.stem().string()},
                                     {"primitives", primitives},
                                     {"weights", std::vector<float>(mesh.shapes.size(), 0.0F)}}});
  glb.json["nodes"] = Json::array({{{"name", path.stem().string()},
                                    {"mesh", 0},
                                    {"translation", {middle.x(), middle.y(), middle.z()}}}});
  std::vector<float> times;
  std::vector<float> weights;
  for (std::size_t f = 0; f < mesh.shares.size(); ++f) {
    times.push_back(static_cast<float>(static_cast<double>(f) / mesh.frames_per_second));
    for (const double share : mesh.shares[f]) {
      weights.push_back(static_cast<float>(share));
    }
  }
  const int input = glb.add_scalars(times, true);
  const int output = glb.add_scalars(weights, false);
  glb.json["animations"] = Json::array(
      {{{"name", "Time line"},
        {"samplers",
         Json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}})},
        {"channels",
         Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}}});
  return glb.bytes(path);
}

} // namespace cagewright
