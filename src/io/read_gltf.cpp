#include "io/gltf_attributes.h"
#include "io/gltf_nodes.h"
#include "io/gltf_pose.h"
#include "io/gltf_scene.h"
#include "io/readers.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>

namespace cagewright {
namespace {

using Transform = Eigen::Affine3d;

// The instances of a file may multiply what it stores: beyond 22 million triangles that is a
// mistake or a trap. What a file stores once is never refused, for a corner takes at least a byte.
std::size_t most_corners(const Source& source) {
  return std::max(std::size_t{1} << 26U, source.bytes.size());
}

// glTF's numbers for what a primitive's indices mean.
enum class Mode { triangles = 4, strip = 5, fan = 6 };

class GltfReader {
public:
  GltfReader(GltfDocument& document, Pose pose)
      : document_(document), source_(document.source()), pose_(pose), nodes_(document),
        skins_(document, nodes_) {}

  Result<GltfScene> read() {
    const Result<std::vector<GltfNodes::Shown>> shown = nodes_.shown();
    if (!shown) {
      return shown.error();
    }
    for (const GltfNodes::Shown& node : *shown) {
      if (const Status status = add_mesh_of(node.node, node.transform); !status) {
        return status.error();
      }
    }
    note_other_scenes();
    note_unknown_extensions();
    if (scene_.mesh.face_count() == 0) {
      return nothing_to_see();
    }
    if (!mesh_.colors.empty()) {
      mesh_.colors.resize(mesh_.positions.size(), {1, 1, 1, 1});
    }
    return std::move(scene_);
  }

private:
  [[nodiscard]] const Json& scenes() const { return member(document_.json(), "scenes"); }

  [[nodiscard]] std::string name_of_scene(std::size_t index) const {
    const std::string name = to_text(member(scenes()[index], "name"));
    return "scene " + (name.empty() ? std::to_string(index) : in_quotes(name));
  }

  // Only scenes that show something else are worth a word.
  void note_other_scenes() {
    const std::size_t count = scenes().is_array() ? scenes().size() : 0;
    const std::size_t shown = to_size(member(document_.json(), "scene")).value_or(0);
    std::string others;
    for (std::size_t s = 0; s < count && s < most_named; ++s) {
      if (s != shown && member(scenes()[s], "nodes") != member(scenes()[shown], "nodes")) {
        others.append(others.empty() ? "" : ", ").append(name_of_scene(s));
      }
    }
    if (!others.empty()) {
      others_ = others + (count > most_named ? " and more" : "");
      scene_.notes.add(
          "other_scenes", [&] { return one_line(source_.name); },
          name_of_scene(shown) + " is read; left out: " + others_);
    }
  }

  // Of those that a file requires: materials, textures and lights change no shape, and what changes
  // it and is not supported was refused when the file was opened.
  void note_unknown_extensions() {
    constexpr std::string_view harmless[] = {
        "KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_",
        "MSFT_texture_",         "KHR_lights_",    "EXT_lights_",  "KHR_xmp"};
    const Json& required = member(document_.json(), "extensionsRequired");
    for (std::size_t i = 0; required.is_array() && i < required.size(); ++i) {
      const std::string name = to_text(required[i]);
      if (std::none_of(std::begin(harmless), std::end(harmless),
                       [&](std::string_view begin) { return name.starts_with(begin); })) {
        scene_.notes.add(
            "unknown_extension", [&] { return one_line(source_.name); },
            "needs the extension " + one_line(name) +
                ", which is not known; what it would show is left out");
      }
    }
  }

  [[nodiscard]] Error nothing_to_see() const {
    if (has_lines_) {
      return source_.error("has no faces, only points or lines; export the surface as triangles");
    }
    if (!others_.empty()) {
      return source_.error("has no faces in its scene; make another the default one (" + others_ +
                           ")");
    }
    return no_faces(source_);
  }

  Status add_mesh_of(std::size_t node, const Transform& transform) {
    const Json& json = nodes_.node(node);
    if (member(json, "mesh").is_null()) {
      return success();
    }
    const std::optional<std::size_t> index = to_size(member(json, "mesh"));
    const Json& meshes = member(document_.json(), "meshes");
    const std::string where = "node " + std::to_string(node);
    if (!index || !meshes.is_array() || *index >= meshes.size()) {
      return source_.error(where + " refers to a mesh that does not exist" +
                           std::string(export_again));
    }
    if (!member(member(json, "extensions"), "EXT_mesh_gpu_instancing").is_null()) {
      return source_.error(where + " uses the extension EXT_mesh_gpu_instancing, which is not "
                                   "supported; export the instances as nodes",
                           ErrorCode::unsupported);
    }
    User user{node, *index, {}, {}, transform};
    if (const Json& skin = member(json, "skin"); !skin.is_null()) {
      user.skin = to_size(skin);
      const Result<std::vector<std::size_t>> joints =
          skins_.joints(user.skin.value_or(~std::size_t{0}));
      if (!joints) {
        return source_.error(where + " refers to a skin that does not exist, or has no joints" +
                             std::string(export_again));
      }
    }
    if (pose_ == Pose::shown) {
      Result<std::vector<double>> weights = morph_weights(source_, json, meshes[*index], where);
      if (!weights) {
        return weights.error();
      }
      user.morph_weights = *std::move(weights);
    }
    const std::size_t faces_before = mesh_.face_count();
    known_.clear();
    const Json& primitives = member(meshes[*index], "primitives");
    for (std::size_t p = 0; primitives.is_array() && p < primitives.size(); ++p) {
      if (const Status status = add_primitive(primitives[p], p, user); !status) {
        return status;
      }
    }
    if (mesh_.face_count() > faces_before) {
      add_group(name_of(json, meshes[*index], node));
    }
    return success();
  }

  static std::string name_of(const Json& node, const Json& mesh, std::size_t index) {
    std::string name = to_text(member(node, "name"));
    name = name.empty() ? to_text(member(mesh, "name")) : name;
    return name.empty() ? "node " + std::to_string(index) : one_line(name);
  }

  void add_group(const std::string& name) {
    mesh_.face_groups.resize(mesh_.face_count(), static_cast<Index>(mesh_.group_names.size()));
    mesh_.group_names.push_back(name);
  }

  /// A node that shows a mesh.
  struct User {
    std::size_t node = 0;
    std::size_t mesh = 0;
    std::optional<std::size_t> skin;
    std::vector<double> morph_weights;
    Transform transform;
  };

  Status add_primitive(const Json& primitive, std::size_t number, const User& user) {
    const std::string where =
        "mesh " + std::to_string(user.mesh) + ", primitive " + std::to_string(number);
    const std::size_t mode = to_size(member(primitive, "mode")).value_or(4);
    if (mode < 4) {
      has_lines_ = true;
      scene_.notes.add(
          "points_and_lines", [&] { return one_line(source_.name) + ": " + where; },
          "draws points or lines, which are left out");
      return success();
    }
    if (mode > 6) {
      return source_.error(where + " has a mode that glTF does not know" +
                           std::string(export_again));
    }
    const Json& attributes = member(primitive, "attributes");
    const std::optional<std::size_t> accessor = to_size(member(attributes, "POSITION"));
    if (!accessor && !member(attributes, "POSITION").is_null()) {
      return source_.error(where + " has positions that do not exist" + std::string(export_again));
    }
    if (!accessor) {
      return success(); // allowed: extensions may give the positions
    }
    if (const Status status = check_compression(primitive, *accessor, where); !status) {
      return status;
    }
    const Result<std::size_t> placement = place_vertices(*accessor, primitive, user);
    if (!placement) {
      return placement.error();
    }
    const std::size_t count = scene_.placements[*placement].count;
    const std::size_t first_corner = mesh_.corners().size();
    const Result<std::vector<std::uint32_t>> indices = indices_of(primitive, count, where);
    if (!indices) {
      return indices.error();
    }
    if (mesh_.corners().size() + 3 * indices->size() > most_corners(source_)) {
      return source_.error("shows more than 22 million triangles; simplify the model",
                           ErrorCode::too_large);
    }
    if (mode == 4 && indices->size() % 3 != 0) {
      scene_.notes.add(
          "odd_corners", [&] { return one_line(source_.name) + ": " + where; },
          "has " + counted(indices->size(), "corner") +
              ", which make no whole triangles; what is left over is left out");
    }
    add_triangles(*indices, static_cast<Mode>(mode), scene_.placements[*placement]);
    scene_.shown.push_back(
        {user.node, user.mesh, number, *placement, to_size(member(attributes, "NORMAL")),
         to_size(member(attributes, "TANGENT")), first_corner, mesh_.corners().size()});
    return success();
  }

  // Some files hold the triangles twice, plain for those that cannot unpack; others leave the
  // plain accessors empty.
  Status check_compression(const Json& primitive, std::size_t accessor, const std::string& where) {
    const Json& positions = element(member(document_.json(), "accessors"), accessor);
    const bool is_stored = !member(positions, "bufferView").is_null();
    constexpr const char* draco = "KHR_draco_mesh_compression";
    if (is_stored || member(member(primitive, "extensions"), draco).is_null()) {
      return success();
    }
    return source_.error(where + " is compressed by the extension " + draco +
                             ", which is not supported; export the model without compression",
                         ErrorCode::unsupported);
  }

  Result<std::vector<std::uint32_t>> indices_of(const Json& primitive, std::size_t count,
                                                const std::string& where) {
    std::vector<std::uint32_t> indices;
    if (member(primitive, "indices").is_null()) {
      indices.resize(count);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = static_cast<std::uint32_t>(i);
      }
      return indices;
    }
    const std::optional<std::size_t> list = to_size(member(primitive, "indices"));
    if (!list) {
      return source_.error(where + " has indices that do not exist" + std::string(export_again));
    }
    Result<std::vector<std::uint32_t>> read = document_.read_indices(*list);
    if (!read) {
      return read.error();
    }
    const auto largest = std::max_element(read->begin(), read->end());
    if (largest != read->end() && *largest >= count) {
      return source_.error(no_such_vertex(where, std::to_string(*largest), count));
    }
    return read;
  }

  // Primitives of one mesh often share their vertices and differ in their indices.
  Result<std::size_t> place_vertices(std::size_t accessor, const Json& primitive,
                                     const User& user) {
    const Json& attributes = member(primitive, "attributes");
    const GltfMorph morph = morph_of(primitive, "POSITION", user.morph_weights);
    std::pair key(std::string(), morph.accessors);
    for (const auto& [name, value] : attributes.items()) {
      if (name == "POSITION" || name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) {
        key.first.append(name).append(value.dump());
      }
    }
    if (const auto known = known_.find(key); known != known_.end()) {
      return known->second;
    }
    const Result<std::vector<double>> values = document_.read_vectors(accessor, 3);
    if (!values) {
      return values.error();
    }
    const std::size_t count = values->size() / 3;
    if (mesh_.positions.size() + count > most_corners(source_)) {
      return source_.error("shows more than 67 million vertices; simplify the model",
                           ErrorCode::too_large);
    }
    GltfPlacement placement{
        user.node, accessor,          static_cast<Index>(mesh_.positions.size()),
        count,     user.transform,    {},
        {},        user.morph_weights};
    if (const Status status = apply_pose(morph, attributes, user, placement); !status) {
      return status.error();
    }
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3 stored((*values)[3 * v], (*values)[3 * v + 1], (*values)[3 * v + 2]);
      const Vec3 p = placement.transform_of(v) * Vec3(stored + placement.shift_of(v));
      if (!p.allFinite()) {
        return source_.error("accessor " + std::to_string(accessor) + ": vertex " +
                             std::to_string(v) + " has a coordinate that is not a finite number" +
                             std::string(export_again));
      }
      mesh_.positions.push_back(p);
    }
    if (const Status status = add_colors(attributes, count); !status) {
      return status.error();
    }
    scene_.placements.push_back(std::move(placement));
    known_.emplace(std::move(key), scene_.placements.size() - 1);
    return scene_.placements.size() - 1;
  }

  Status apply_pose(const GltfMorph& morph, const Json& attributes, const User& user,
                    GltfPlacement& placement) {
    Result<std::vector<Vec3>> shifts = morph_shifts(document_, morph, placement.count);
    if (!shifts) {
      return shifts.error();
    }
    placement.shifts = *std::move(shifts);
    if (!user.skin) {
      return success();
    }
    if (pose_ == Pose::bind) {
      // Where a mesh was bound its joints undo their inverse bind matrices, and all else is
      // ignored.
      placement.transform =
          member(attributes, "JOINTS_0").is_null() ? user.transform : Transform::Identity();
      return success();
    }
    Result<std::vector<Transform>> blends = skins_.blend(*user.skin, attributes, placement.count);
    if (!blends) {
      return blends.error();
    }
    placement.blends = *std::move(blends);
    return success();
  }

  Status add_colors(const Json& attributes, std::size_t count) {
    const std::optional<std::size_t> accessor = to_size(member(attributes, "COLOR_0"));
    if (!accessor) {
      return success();
    }
    const Json& json = element(member(document_.json(), "accessors"), *accessor);
    const std::size_t channels = to_text(member(json, "type")) == "VEC4" ? 4 : 3;
    const Result<std::vector<double>> values = document_.read_vectors(*accessor, channels);
    if (!values) {
      return values.error();
    }
    if (values->size() != count * channels) {
      return source_.error("accessor " + std::to_string(*accessor) +
                           " should have a colour for each vertex" + std::string(export_again));
    }
    mesh_.colors.resize(mesh_.positions.size() - count, {1, 1, 1, 1});
    for (std::size_t v = 0; v < count; ++v) {
      std::array<float, 4>& color = mesh_.colors.emplace_back(std::array<float, 4>{1, 1, 1, 1});
      for (std::size_t c = 0; c < channels; ++c) {
        const double value = (*values)[v * channels + c];
        color[c] = value > 0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F; // nan becomes 0
      }
    }
    return success();
  }

  // A transform that mirrors turns the triangles inside out (glTF 2.0, 3.7.4). Of a skinned mesh
  // that is the joints' doing; where they disagree over a triangle, the greater part decides.
  void add_triangles(const std::vector<std::uint32_t>& indices, Mode mode,
                     const GltfPlacement& placement) {
    const auto mirrors = [&](std::size_t v) {
      return placement.transform_of(v).linear().determinant() < 0;
    };
    const bool all_mirrored = placement.blends.empty() && mirrors(0);
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      const Index i = placement.base + indices[a];
      const Index j = placement.base + indices[b];
      const Index k = placement.base + indices[c];
      // In strips and fans a repeated corner only leads to the next part; lists are kept as stored.
      if (mode != Mode::triangles && (i == j || j == k || k == i)) {
        return;
      }
      const bool is_mirrored =
          placement.blends.empty()
              ? all_mirrored
              : mirrors(indices[a]) + mirrors(indices[b]) + mirrors(indices[c]) >= 2;
      is_mirrored ? mesh_.add_face({i, k, j}) : mesh_.add_face({i, j, k});
    };
    const std::size_t step = mode == Mode::triangles ? 3 : 1;
    for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
      if (mode == Mode::fan) {
        add(i + 1, i + 2, 0);
      } else if (mode == Mode::strip && i % 2 == 1) {
        add(i, i + 2, i + 1);
      } else {
        add(i, i + 1, i + 2);
      }
    }
  }

  static constexpr std::size_t most_named = 8; // scenes in a message

  GltfDocument& document_;
  const Source& source_;
  const Pose pose_;
  GltfNodes nodes_;
  GltfSkins skins_;
  GltfScene scene_;
  PolygonMesh& mesh_ = scene_.mesh;
  bool has_lines_ = false; // or points
  std::string others_;     // scenes that are left out
  // Placements of the node under way, by the attributes and targets that place vertices.
  std::map<std::pair<std::string, std::vector<std::size_t>>, std::size_t> known_;
};

} // namespace

Result<GltfScene> read_gltf_scene(GltfDocument& document, Pose pose) {
  return GltfReader(document, pose).read();
}

Result<PolygonMesh> read_gltf(const Source& source,
                              const std::optional<std::filesystem::path>& folder,
                              Reading& reading) {
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  Result<GltfScene> scene = read_gltf_scene(*document, reading.pose);
  if (scene) {
    reading.notes = std::move(scene->notes);
  }
  if (scene && reading.attributes != nullptr) {
    *reading.attributes = read_gltf_attributes(*document, *scene);
  }
  return scene ? Result<PolygonMesh>(std::move(scene->mesh)) : scene.error();
}

} // namespace cagewright
