#include "io/gltf_scene.h"
#include "io/readers.h"

#include <algorithm>
#include <map>
#include <string>

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
  explicit GltfReader(GltfDocument& document)
      : document_(document), source_(document.source()), nodes_(member(document.json(), "nodes")) {}

  Result<GltfScene> read() {
    const Result<std::vector<std::size_t>> roots = find_roots();
    if (!roots) {
      return roots.error();
    }
    if (const Status status = visit_nodes(*roots); !status) {
      return status.error();
    }
    if (mesh_.face_count() == 0) {
      return no_faces(source_);
    }
    if (!mesh_.colors.empty()) {
      mesh_.colors.resize(mesh_.positions.size(), {1, 1, 1, 1});
    }
    return GltfScene{std::move(mesh_), std::move(placements_), std::move(shown_)};
  }

private:
  struct Visit {
    std::size_t node;
    Transform transform; // of the parent
  };

  // The nodes of the default scene; of the first where none is; all that are no one's child where
  // there is no scene.
  Result<std::vector<std::size_t>> find_roots() {
    const std::size_t count = nodes_.is_array() ? nodes_.size() : 0;
    const std::size_t scene = to_size(member(document_.json(), "scene")).value_or(0);
    const Json& scenes = member(document_.json(), "scenes");
    if (scenes.is_array() && !scenes.empty()) {
      if (scene >= scenes.size()) {
        return source_.error("the default scene does not exist" + std::string(export_again));
      }
      return node_list(member(scenes[scene], "nodes"), "scene " + std::to_string(scene));
    }
    std::vector<char> is_child(count, 0);
    for (std::size_t n = 0; n < count; ++n) {
      const Result<std::vector<std::size_t>> children = children_of(n);
      if (!children) {
        return children.error();
      }
      for (const std::size_t child : *children) {
        is_child[child] = 1;
      }
    }
    std::vector<std::size_t> roots;
    for (std::size_t n = 0; n < count; ++n) {
      if (is_child[n] == 0) {
        roots.push_back(n);
      }
    }
    return roots;
  }

  Result<std::vector<std::size_t>> children_of(std::size_t node) {
    return node_list(member(nodes_[node], "children"), "node " + std::to_string(node));
  }

  Result<std::vector<std::size_t>> node_list(const Json& list, const std::string& where) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; list.is_array() && i < list.size(); ++i) {
      const std::optional<std::size_t> node = to_size(list[i]);
      if (!node || !nodes_.is_array() || *node >= nodes_.size()) {
        return source_.error(where + " refers to a node that does not exist" +
                             std::string(export_again));
      }
      found.push_back(*node);
    }
    return found;
  }

  // Depth first, children in their order. A node that is met twice belongs to two parents or to
  // itself.
  Status visit_nodes(const std::vector<std::size_t>& roots) {
    std::vector<char> visited(nodes_.is_array() ? nodes_.size() : 0, 0);
    std::vector<Visit> stack;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
      stack.push_back({*root, Transform::Identity()});
    }
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (visited[visit.node] != 0) {
        return source_.error("node " + std::to_string(visit.node) + " stands in the scene twice" +
                             std::string(export_again));
      }
      visited[visit.node] = 1;
      const Result<Transform> local = transform_of(visit.node);
      const Result<std::vector<std::size_t>> children = children_of(visit.node);
      if (!local || !children) {
        return local ? children.error() : local.error();
      }
      const Transform global = visit.transform * *local;
      if (const Status status = add_mesh_of(visit.node, global); !status) {
        return status;
      }
      for (auto child = children->rbegin(); child != children->rend(); ++child) {
        stack.push_back({*child, global});
      }
    }
    return success();
  }

  Result<Transform> transform_of(std::size_t node) {
    const Json& json = nodes_[node];
    Transform transform = Transform::Identity();
    std::vector<double> m;
    std::vector<double> t;
    std::vector<double> r;
    std::vector<double> s;
    if (!read_numbers(member(json, "matrix"), 16, m) ||
        !read_numbers(member(json, "translation"), 3, t) ||
        !read_numbers(member(json, "rotation"), 4, r) ||
        !read_numbers(member(json, "scale"), 3, s)) {
      return source_.error("node " + std::to_string(node) + " has a transform that is not one" +
                           std::string(export_again));
    }
    if (!m.empty()) { // column after column
      transform.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix4d>(m.data()).topRows<3>();
      return transform;
    }
    if (!t.empty()) {
      transform.translate(Vec3(t[0], t[1], t[2]));
    }
    if (!r.empty()) {
      const Eigen::Quaterniond rotation(r[3], r[0], r[1], r[2]);
      if (rotation.squaredNorm() > 0) {
        transform.rotate(rotation.normalized());
      }
    }
    if (!s.empty()) {
      transform.scale(Vec3(s[0], s[1], s[2]));
    }
    return transform;
  }

  // A list of `count` numbers, or none where the member is missing; false for anything else.
  static bool read_numbers(const Json& list, std::size_t count, std::vector<double>& numbers) {
    if (list.is_null()) {
      return true;
    }
    if (!list.is_array() || list.size() != count) {
      return false;
    }
    for (const Json& item : list) {
      if (!item.is_number()) {
        return false;
      }
      numbers.push_back(item.get<double>());
    }
    return true;
  }

  // Rigged meshes are treated like others. By the letter of glTF the joints place them and their
  // own node does not; but exporters put mesh and joints under the same root, and at rest the
  // joints undo their own bind pose. What is left is the root's transform, such as the turn from
  // z up to y up, and that is what the node's chain gives, without knowing any pose.
  Status add_mesh_of(std::size_t node, const Transform& transform) {
    const Json& json = nodes_[node];
    if (member(json, "mesh").is_null()) {
      return success();
    }
    const std::optional<std::size_t> index = to_size(member(json, "mesh"));
    const Json& meshes = member(document_.json(), "meshes");
    if (!index || !meshes.is_array() || *index >= meshes.size()) {
      return source_.error("node " + std::to_string(node) +
                           " refers to a mesh that does not exist" + std::string(export_again));
    }
    if (!member(member(json, "extensions"), "EXT_mesh_gpu_instancing").is_null()) {
      return source_.error("node " + std::to_string(node) +
                               " uses the extension EXT_mesh_gpu_instancing, which is not "
                               "supported; export the instances as nodes",
                           ErrorCode::unsupported);
    }
    const std::size_t faces_before = mesh_.face_count();
    bases_.clear();
    node_ = node;
    const Json& primitives = member(meshes[*index], "primitives");
    for (std::size_t p = 0; primitives.is_array() && p < primitives.size(); ++p) {
      const std::string where =
          "mesh " + std::to_string(*index) + ", primitive " + std::to_string(p);
      if (const Status status = add_primitive(primitives[p], transform, where); !status) {
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

  Status add_primitive(const Json& primitive, const Transform& transform,
                       const std::string& where) {
    const std::size_t mode = to_size(member(primitive, "mode")).value_or(4);
    if (mode < 4) {
      return success(); // points and lines
    }
    if (mode > 6) {
      return source_.error(where + " has a mode that glTF does not know" +
                           std::string(export_again));
    }
    const Json& attributes = member(primitive, "attributes");
    const std::optional<std::size_t> accessor = to_size(member(attributes, "POSITION"));
    if (!accessor) {
      return success(); // allowed: extensions may give the positions
    }
    if (const Status status = check_compression(primitive, *accessor, where); !status) {
      return status;
    }
    const Result<Vertices> vertices = add_vertices(*accessor, attributes, transform);
    if (!vertices) {
      return vertices.error();
    }
    const std::size_t first_corner = mesh_.corners().size();
    std::vector<std::uint32_t> indices;
    if (member(primitive, "indices").is_null()) {
      indices.resize(vertices->count);
      for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = static_cast<std::uint32_t>(i);
      }
    } else {
      const std::optional<std::size_t> list = to_size(member(primitive, "indices"));
      Result<std::vector<std::uint32_t>> read =
          list
              ? document_.read_indices(*list)
              : source_.error(where + " has indices that do not exist" + std::string(export_again));
      if (!read) {
        return read.error();
      }
      indices = *std::move(read);
    }
    const auto largest = std::max_element(indices.begin(), indices.end());
    if (largest != indices.end() && *largest >= vertices->count) {
      return source_.error(no_such_vertex(where, std::to_string(*largest), vertices->count));
    }
    if (mesh_.corners().size() + 3 * indices.size() > most_corners(source_)) {
      return source_.error("shows more than 22 million triangles; simplify the model",
                           ErrorCode::too_large);
    }
    // A transform that mirrors turns the triangles inside out (glTF 2.0, 3.7.4).
    add_triangles(indices, static_cast<Mode>(mode), vertices->base,
                  transform.linear().determinant() < 0);
    shown_.push_back({vertices->placement, to_size(member(attributes, "NORMAL")),
                      to_size(member(attributes, "TANGENT")), first_corner,
                      mesh_.corners().size()});
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

  struct Vertices {
    Index base = 0;
    std::size_t count = 0;
    std::size_t placement = 0;
  };

  // Primitives of one mesh often share their vertices and differ in their indices.
  Result<Vertices> add_vertices(std::size_t accessor, const Json& attributes,
                                const Transform& transform) {
    if (const auto known = bases_.find(accessor); known != bases_.end()) {
      return known->second;
    }
    const Result<std::vector<double>> values = document_.read_vectors(accessor, 3);
    if (!values) {
      return values.error();
    }
    const Vertices vertices{static_cast<Index>(mesh_.positions.size()), values->size() / 3,
                            placements_.size()};
    if (mesh_.positions.size() + vertices.count > most_corners(source_)) {
      return source_.error("shows more than 67 million vertices; simplify the model",
                           ErrorCode::too_large);
    }
    for (std::size_t v = 0; v < vertices.count; ++v) {
      const Vec3 p = transform * Vec3((*values)[3 * v], (*values)[3 * v + 1], (*values)[3 * v + 2]);
      if (!p.allFinite()) {
        return source_.error("accessor " + std::to_string(accessor) + ": vertex " +
                             std::to_string(v) + " has a coordinate that is not a finite number" +
                             std::string(export_again));
      }
      mesh_.positions.push_back(p);
    }
    if (const Status status = add_colors(attributes, vertices.count); !status) {
      return status.error();
    }
    bases_.emplace(accessor, vertices);
    placements_.push_back({node_, accessor, vertices.base, vertices.count, transform});
    return vertices;
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

  void add_triangles(const std::vector<std::uint32_t>& indices, Mode mode, Index base,
                     bool is_mirrored) {
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      const Index i = base + indices[a];
      const Index j = base + indices[b];
      const Index k = base + indices[c];
      // In strips and fans a repeated corner only leads to the next part; lists are kept as stored.
      if (mode == Mode::triangles || (i != j && j != k && k != i)) {
        is_mirrored ? mesh_.add_face({i, k, j}) : mesh_.add_face({i, j, k});
      }
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

  GltfDocument& document_;
  const Source& source_;
  const Json& nodes_;
  PolygonMesh mesh_;
  std::vector<GltfPlacement> placements_;
  std::vector<GltfShown> shown_;
  std::size_t node_ = 0;                  // under way
  std::map<std::size_t, Vertices> bases_; // of the mesh under way, by accessor
};

} // namespace

Result<GltfScene> read_gltf_scene(GltfDocument& document) {
  return GltfReader(document).read();
}

Result<PolygonMesh> read_gltf(const Source& source,
                              const std::optional<std::filesystem::path>& folder,
                              Reading& reading) {
  static_cast<void>(reading);
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  Result<GltfScene> scene = read_gltf_scene(*document);
  return scene ? Result<PolygonMesh>(std::move(scene->mesh)) : scene.error();
}

} // namespace cagewright
