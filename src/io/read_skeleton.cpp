#include <cagewright/io/read_skeleton.h>

#include "io/gltf_document.h"
#include "io/gltf_nodes.h"
#include "io/gltf_pose.h"
#include "io/read_file.h"
#include "io/source.h"
#include <cagewright/io/mesh_format.h>

#include <cmath>
#include <map>
#include <optional>

namespace cagewright {
namespace {

class SkeletonReader {
public:
  SkeletonReader(GltfDocument& document, Pose pose)
      : document_(document), pose_(pose), nodes_(document), skins_(document, nodes_) {}

  Result<Skeleton> read() {
    const Result<std::vector<GltfNodes::Shown>> shown = nodes_.shown();
    if (!shown) {
      return shown.error();
    }
    for (const GltfNodes::Shown& node : *shown) {
      const Json& json = nodes_.node(node.node);
      if (member(json, "mesh").is_null() || member(json, "skin").is_null()) {
        continue;
      }
      const Status status = add_skin(to_size(member(json, "skin")).value_or(~std::size_t{0}));
      if (!status) {
        return status.error();
      }
    }
    return in_order();
  }

private:
  Status add_skin(std::size_t skin) {
    if (read_.contains(skin)) {
      return success();
    }
    read_[skin] = true;
    const Result<std::vector<std::size_t>> joints = skins_.joints(skin);
    if (!joints) {
      return joints.error();
    }
    const Result<std::vector<Eigen::Affine3d>> inverses = skins_.inverse_bind_matrices(skin);
    if (!inverses) {
      return inverses.error();
    }
    for (std::size_t j = 0; j < joints->size(); ++j) {
      const Result<Eigen::Affine3d> world = nodes_.world((*joints)[j]);
      if (!world) {
        return world.error();
      }
      Vec3 position = world->translation();
      const Eigen::Affine3d& inverse = (*inverses)[j];
      if (pose_ == Pose::bind && std::abs(inverse.linear().determinant()) > 0) {
        position = inverse.inverse().translation();
      }
      if (!position.allFinite()) {
        return document_.source().error("node " + std::to_string((*joints)[j]) +
                                        " is a joint that does not stand at a finite place" +
                                        std::string(export_again));
      }
      positions_.emplace((*joints)[j], position);
    }
    return success();
  }

  /// The nearest joint above a node; none beyond the scene's own nodes, which may stand below
  /// themselves.
  [[nodiscard]] std::optional<std::size_t> joint_above(std::size_t node) const {
    std::optional<std::size_t> above = nodes_.parent(node);
    for (std::size_t steps = 0; above && !positions_.contains(*above); ++steps) {
      above = steps < nodes_.count() ? nodes_.parent(*above) : std::nullopt;
    }
    return above;
  }

  // By the number of the node, but for parents, which come first.
  [[nodiscard]] Skeleton in_order() const {
    Skeleton skeleton;
    std::map<std::size_t, Index> numbers;
    for (const auto& [node, unused] : positions_) {
      std::vector<std::size_t> chain;
      for (std::optional<std::size_t> n = node;
           n && !numbers.contains(*n) && chain.size() <= positions_.size(); n = joint_above(*n)) {
        chain.push_back(*n);
      }
      for (auto n = chain.rbegin(); n != chain.rend(); ++n) {
        if (numbers.contains(*n)) {
          continue; // of a cycle
        }
        const std::optional<std::size_t> parent = joint_above(*n);
        const bool has_parent = parent && numbers.contains(*parent);
        numbers[*n] = static_cast<Index>(skeleton.joints.size());
        skeleton.joints.push_back(
            {name_of(*n), positions_.at(*n), has_parent ? numbers.at(*parent) : Joint::none});
      }
    }
    return skeleton;
  }

  [[nodiscard]] std::string name_of(std::size_t node) const {
    const std::string name = to_text(member(nodes_.node(node), "name"));
    return name.empty() ? "node " + std::to_string(node) : one_line(name);
  }

  GltfDocument& document_;
  const Pose pose_;
  GltfNodes nodes_;
  GltfSkins skins_;
  std::map<std::size_t, Vec3> positions_; // by node
  std::map<std::size_t, bool> read_;      // skins
};

} // namespace

Result<Skeleton> read_skeleton(const std::filesystem::path& path, Pose pose) {
  const Result<FileBytes> file = read_file(path);
  if (!file) {
    return file.error();
  }
  const std::string name = path.string();
  const Source source{name, file->view()};
  if (format_of_content(source.bytes).value_or(MeshFormat::obj) != MeshFormat::gltf) {
    return Skeleton();
  }
  Result<GltfDocument> document = GltfDocument::open(source, path.parent_path());
  if (!document) {
    return document.error();
  }
  return SkeletonReader(*document, pose).read();
}

} // namespace cagewright
