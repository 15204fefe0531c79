#include <cagewright/io/skinned_cage.h>

#include "io/gltf_document.h"
#include "io/gltf_nodes.h"
#include "io/gltf_pose.h"
#include "io/gltf_scene.h"
#include "io/read_file.h"
#include "io/source.h"
#include "io/uri.h"
#include "io/write_gltf.h"
#include <cagewright/io/mesh_format.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// So many vertices of the model, at most, say what a vertex of the cage follows: enough for a mean
// over both sides of a limb, few enough to leave the next limb out.
constexpr std::size_t vertices_near = 8;
// glTF viewers must heed four joints a vertex, and need not heed more.
constexpr std::size_t most_joints = 4;

enum ComponentType { unsigned_short = 5123, unsigned_int = 5125, real = 5126 };

/// Parts of the whole, by the node that is followed.
using Shares = std::map<std::size_t, double>;

/// What the vertices of a model follow.
class Rig {
public:
  Rig(GltfDocument& document, Pose pose)
      : document_(document), pose_(pose), nodes_(document), skins_(document, nodes_) {}

  Status read() {
    Result<GltfScene> scene = read_gltf_scene(document_, pose_);
    if (!scene) {
      return scene.error();
    }
    points_ = std::move(scene->mesh.positions);
    shares_.resize(points_.size());
    bool has_skin = false;
    std::vector<bool> is_known(scene->placements.size(), false);
    for (const GltfShown& shown : scene->shown) {
      if (is_known[shown.placement]) {
        continue;
      }
      is_known[shown.placement] = true;
      const Result<bool> skinned = add(scene->placements[shown.placement], shown);
      if (!skinned) {
        return skinned.error();
      }
      has_skin = has_skin || *skinned;
    }
    if (!has_skin) {
      return document_.source().error(
          "has no joints that a cage could follow: no mesh of it has a skin",
          ErrorCode::unsupported);
    }
    return success();
  }

  /// What a point near the model follows: at most four nodes, with the sum 1.
  [[nodiscard]] Shares at(const Vec3& point) const {
    std::vector<std::pair<double, std::size_t>> near(points_.size());
    for (std::size_t v = 0; v < points_.size(); ++v) {
      near[v] = {(points_[v] - point).squaredNorm(), v};
    }
    const std::size_t count = std::min(vertices_near, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    Shares sum;
    const double nearest = std::sqrt(near.front().first);
    for (std::size_t i = 0; i < count; ++i) {
      // Nearer ones count more; the least distance keeps one from counting alone.
      const double distance = std::sqrt(near[i].first) + nearest + 1e-30;
      const double weight = 1 / (distance * distance);
      for (const auto& [node, share] : shares_[near[i].second]) {
        sum[node] += weight * share;
      }
    }
    return the_most(sum);
  }

  /// From the frame of each followed node to where it was bound, by node. Errors: unsupported.
  Result<std::map<std::size_t, Eigen::Affine3d>> binds() {
    std::map<std::size_t, Eigen::Affine3d> result;
    for (const std::size_t node : followed_) {
      const auto stored = stored_binds_.find(node);
      if (pose_ == Pose::bind && stored != stored_binds_.end()) {
        result[node] = stored->second;
        continue;
      }
      const Result<Eigen::Affine3d> world = nodes_.world(node);
      if (!world) {
        return world.error();
      }
      if (!(std::abs(world->linear().determinant()) > 0)) {
        return document_.source().error(
            "node " + std::to_string(node) +
                " flattens what follows it (a scale of zero), so no cage can be bound to it; give "
                "it another scale, or take its bind pose",
            ErrorCode::unsupported);
      }
      result[node] = world->inverse();
    }
    return result;
  }

private:
  /// \returns whether it has a skin
  Result<bool> add(const GltfPlacement& placement, const GltfShown& shown) {
    const Json& node = nodes_.node(placement.node);
    const std::optional<std::size_t> skin = to_size(member(node, "skin"));
    if (!skin) {
      follow(placement.node);
      for (std::size_t v = 0; v < placement.count; ++v) {
        shares_[placement.base + v][placement.node] = 1;
      }
      return false;
    }
    const Result<std::vector<std::size_t>> joints = skins_.joints(*skin);
    if (!joints) {
      return joints.error();
    }
    const Result<std::vector<Eigen::Affine3d>> binds = skins_.inverse_bind_matrices(*skin);
    if (!binds) {
      return binds.error();
    }
    for (std::size_t j = 0; j < joints->size(); ++j) {
      stored_binds_.emplace((*joints)[j], (*binds)[j]);
    }
    const Json& mesh = element(member(document_.json(), "meshes"), shown.mesh);
    const Json& attributes =
        member(element(member(mesh, "primitives"), shown.primitive), "attributes");
    for (std::size_t set = 0;; ++set) {
      const auto which = to_size(member(attributes, ("JOINTS_" + std::to_string(set)).c_str()));
      const auto weights = to_size(member(attributes, ("WEIGHTS_" + std::to_string(set)).c_str()));
      if (!which || !weights) {
        break;
      }
      if (Status s = add_set(placement, *joints, *which, *weights); !s) {
        return s.error();
      }
    }
    for (std::size_t v = 0; v < placement.count; ++v) {
      normalize(shares_[placement.base + v]);
    }
    return true;
  }

  // Whether joints and weights are as many as vertices, and joints exist, read_gltf_scene() asked.
  Status add_set(const GltfPlacement& placement, const std::vector<std::size_t>& joints,
                 std::size_t which, std::size_t weights) {
    const Result<std::vector<double>> numbers = document_.read_vectors(which, 4);
    const Result<std::vector<double>> parts =
        numbers ? document_.read_vectors(weights, 4) : numbers.error();
    if (!parts) {
      return parts.error();
    }
    for (std::size_t i = 0; i < std::min(numbers->size(), 4 * placement.count); ++i) {
      const auto joint = static_cast<std::size_t>((*numbers)[i]);
      if ((*parts)[i] > 0 && joint < joints.size()) {
        follow(joints[joint]);
        shares_[placement.base + i / 4][joints[joint]] += (*parts)[i];
      }
    }
    return success();
  }

  void follow(std::size_t node) {
    if (std::find(followed_.begin(), followed_.end(), node) == followed_.end()) {
      followed_.push_back(node);
    }
  }

  static void normalize(Shares& shares) {
    double sum = 0;
    for (const auto& [node, share] : shares) {
      sum += share;
    }
    for (auto& [node, share] : shares) {
      share /= sum;
    }
  }

  static Shares the_most(const Shares& shares) {
    std::vector<std::pair<double, std::size_t>> sorted;
    for (const auto& [node, share] : shares) {
      sorted.emplace_back(-share, node);
    }
    std::sort(sorted.begin(), sorted.end());
    sorted.resize(std::min(sorted.size(), most_joints));
    Shares result;
    for (const auto& [share, node] : sorted) {
      result[node] = -share;
    }
    normalize(result);
    return result;
  }

  GltfDocument& document_;
  const Pose pose_;
  GltfNodes nodes_;
  GltfSkins skins_;
  std::vector<Vec3> points_;
  std::vector<Shares> shares_;        // of each point
  std::vector<std::size_t> followed_; // nodes, in the order of the file
  std::map<std::size_t, Eigen::Affine3d> stored_binds_;
};

/// The new file.
class Writer {
public:
  Writer(GltfDocument& document, const PolygonMesh& cage) : document_(document), cage_(cage) {}

  Result<std::string> write(const Rig& rig, const std::map<std::size_t, Eigen::Affine3d>& binds,
                            bool as_json) {
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "Cagewright"}}}};
    copy_nodes();
    add_skin(binds);
    add_cage(rig, binds);
    if (Status s = copy_animations(); !s) {
      return s.error();
    }
    binary_.resize((binary_.size() + 3) / 4 * 4);
    json_["buffers"] = Json::array({Json{{"byteLength", binary_.size()}}});
    if (!as_json) {
      return glb_of(json_.dump(), binary_);
    }
    json_["buffers"][0]["uri"] = data_uri(binary_);
    return json_.dump(1) + '\n';
  }

private:
  /// What a node shows goes; where it is stays.
  void copy_nodes() {
    json_["nodes"] = Json::array();
    for (const Json& node : member(document_.json(), "nodes")) {
      Json copy = Json::object();
      for (const char* key :
           {"name", "children", "translation", "rotation", "scale", "matrix", "extras"}) {
        if (const Json& value = member(node, key); !value.is_null()) {
          copy[key] = value;
        }
      }
      json_["nodes"].push_back(copy);
    }
    const std::size_t own = json_["nodes"].size();
    json_["nodes"].push_back({{"name", "Cage"}, {"mesh", 0}, {"skin", 0}});
    const std::size_t scene = to_size(member(document_.json(), "scene")).value_or(0);
    const Json& shown = element(member(document_.json(), "scenes"), scene);
    Json roots = member(shown, "nodes");
    if (!roots.is_array()) {
      roots = Json::array();
    }
    roots.push_back(own);
    json_["scenes"] = Json::array({Json{{"nodes", roots}}});
    json_["scene"] = 0;
  }

  void add_skin(const std::map<std::size_t, Eigen::Affine3d>& binds) {
    std::vector<float> matrices;
    Json joints = Json::array();
    for (const auto& [node, bind] : binds) {
      joint_of_node_[node] = joints.size();
      joints.push_back(node);
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
          matrices.push_back(row < 3 ? static_cast<float>(bind.matrix()(row, column))
                                     : (column < 3 ? 0.0F : 1.0F));
        }
      }
    }
    json_["skins"] = Json::array(
        {Json{{"joints", joints}, {"inverseBindMatrices", add_floats(matrices, 16, "MAT4")}}});
  }

  void add_cage(const Rig& rig, const std::map<std::size_t, Eigen::Affine3d>& binds) {
    std::vector<float> positions;
    std::vector<float> weights;
    std::vector<std::uint32_t> joints;
    for (const Vec3& p : cage_.positions) {
      positions.insert(positions.end(), {static_cast<float>(p.x()), static_cast<float>(p.y()),
                                         static_cast<float>(p.z())});
      std::size_t used = 0;
      for (const auto& [node, share] : rig.at(p)) {
        if (binds.contains(node)) {
          joints.push_back(static_cast<std::uint32_t>(joint_of_node_.at(node)));
          weights.push_back(static_cast<float>(share));
          ++used;
        }
      }
      for (; used < most_joints; ++used) {
        joints.push_back(0);
        weights.push_back(0);
      }
    }
    std::vector<std::uint32_t> corners;
    for (const Triangle& triangle : triangulate(cage_).triangles) {
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    Json attributes;
    attributes["POSITION"] = add_floats(positions, 3, "VEC3", target_vertices);
    set_bounds(positions, 3);
    attributes["JOINTS_0"] = add_integers(joints, 4, "VEC4", ComponentType::unsigned_short);
    attributes["WEIGHTS_0"] = add_floats(weights, 4, "VEC4", target_vertices);
    const std::size_t indices =
        add_integers(corners, 1, "SCALAR", ComponentType::unsigned_int, target_indices);
    json_["meshes"] = Json::array({Json{
        {"name", "Cage"},
        {"primitives", Json::array({Json{{"attributes", attributes}, {"indices", indices}}})}}});
  }

  /// All but those of morph targets, which go with their meshes.
  Status copy_animations() {
    for (const Json& animation : member(document_.json(), "animations")) {
      Json copy = {{"channels", Json::array()}, {"samplers", Json::array()}};
      if (const Json& name = member(animation, "name"); !name.is_null()) {
        copy["name"] = name;
      }
      std::map<std::pair<std::size_t, std::size_t>, std::size_t> samplers;
      for (const Json& channel : member(animation, "channels")) {
        if (Status s = copy_channel(animation, channel, samplers, copy); !s) {
          return s;
        }
      }
      if (!copy["channels"].empty()) {
        json_["animations"].push_back(copy);
      }
    }
    return success();
  }

  Status copy_channel(const Json& animation, const Json& channel,
                      std::map<std::pair<std::size_t, std::size_t>, std::size_t>& samplers,
                      Json& copy) {
    const std::string path = to_text(member(member(channel, "target"), "path"));
    const auto node = to_size(member(member(channel, "target"), "node"));
    const auto number = to_size(member(channel, "sampler"));
    const std::size_t components = path == "rotation"                         ? 4
                                   : path == "translation" || path == "scale" ? 3
                                                                              : 0;
    if (components == 0 || !node || !number) {
      return success();
    }
    const Json& sampler = element(member(animation, "samplers"), *number);
    const auto input = to_size(member(sampler, "input"));
    const auto output = to_size(member(sampler, "output"));
    if (!input || !output) {
      return success();
    }
    const auto [known, is_new] =
        samplers.try_emplace({*number, components}, copy["samplers"].size());
    if (is_new) {
      const Result<std::size_t> times = copy_accessor(*input, 1, "SCALAR");
      if (!times) {
        return times.error();
      }
      const Result<std::size_t> values =
          copy_accessor(*output, components, components == 4 ? "VEC4" : "VEC3");
      if (!values) {
        return values.error();
      }
      Json made = {{"input", *times}, {"output", *values}};
      if (const Json& how = member(sampler, "interpolation"); !how.is_null()) {
        made["interpolation"] = how;
      }
      copy["samplers"].push_back(made);
    }
    copy["channels"].push_back(
        {{"sampler", known->second}, {"target", {{"node", *node}, {"path", path}}}});
    return success();
  }

  /// Each once, however many samplers use it.
  Result<std::size_t> copy_accessor(std::size_t accessor, std::size_t components,
                                    const char* type) {
    if (const auto known = accessors_.find({accessor, components}); known != accessors_.end()) {
      return known->second;
    }
    const Result<std::vector<double>> values = document_.read_vectors(accessor, components);
    if (!values) {
      return values.error();
    }
    const std::vector<float> floats(values->begin(), values->end());
    const std::size_t made = add_floats(floats, components, type);
    if (components == 1) {
      set_bounds(floats, 1); // of times, as the specification wants
    }
    accessors_[{accessor, components}] = made;
    return made;
  }

  static constexpr int target_vertices = 34962;
  static constexpr int target_indices = 34963;

  std::size_t begin(int target) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}};
    if (target != 0) {
      view["target"] = target;
    }
    json_["bufferViews"].push_back(view);
    return json_["bufferViews"].size() - 1;
  }

  std::size_t end(std::size_t view, ComponentType component, std::size_t count, const char* type) {
    Json& made = json_["bufferViews"][view];
    made["byteLength"] = binary_.size() - made["byteOffset"].get<std::size_t>();
    json_["accessors"].push_back({{"bufferView", view},
                                  {"componentType", static_cast<int>(component)},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
  }

  void append(std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      binary_.push_back(static_cast<char>((value >> (8 * i)) & 0xffU));
    }
  }

  std::size_t add_floats(const std::vector<float>& values, std::size_t components, const char* type,
                         int target = 0) {
    const std::size_t view = begin(target);
    for (const float value : values) {
      append(std::bit_cast<std::uint32_t>(value), 4);
    }
    return end(view, ComponentType::real, values.size() / components, type);
  }

  std::size_t add_integers(const std::vector<std::uint32_t>& values, std::size_t components,
                           const char* type, ComponentType component,
                           int target = target_vertices) {
    const std::size_t view = begin(target);
    for (const std::uint32_t value : values) {
      append(value, component == ComponentType::unsigned_short ? 2 : 4);
    }
    return end(view, component, values.size() / components, type);
  }

  /// Of the accessor that was added last.
  void set_bounds(const std::vector<float>& values, std::size_t components) {
    Json low = Json::array();
    Json high = Json::array();
    for (std::size_t k = 0; k < components && !values.empty(); ++k) {
      float least = values[k];
      float most = values[k];
      for (std::size_t i = k; i < values.size(); i += components) {
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
      }
      low.push_back(least);
      high.push_back(most);
    }
    json_["accessors"].back()["min"] = low;
    json_["accessors"].back()["max"] = high;
  }

  GltfDocument& document_;
  const PolygonMesh& cage_;
  Json json_;
  std::string binary_;
  std::map<std::size_t, std::size_t> joint_of_node_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> accessors_; // of the animations
};

} // namespace

Result<std::string> format_skinned_cage(const std::filesystem::path& model, Pose pose,
                                        const PolygonMesh& cage, bool as_json) {
  const Result<FileBytes> file = read_file(model);
  if (!file) {
    return file.error();
  }
  const std::string name = model.string();
  const Source source{name, file->view()};
  if (format_of_content(source.bytes).value_or(MeshFormat::obj) != MeshFormat::gltf) {
    return source.error("has no joints that a cage could follow: only glTF files have",
                        ErrorCode::unsupported);
  }
  Result<GltfDocument> document = GltfDocument::open(source, model.parent_path());
  if (!document) {
    return document.error();
  }
  Rig rig(*document, pose);
  if (Status s = rig.read(); !s) {
    return s.error();
  }
  const auto binds = rig.binds();
  if (!binds) {
    return binds.error();
  }
  return Writer(*document, cage).write(rig, *binds, as_json);
}

} // namespace cagewright
