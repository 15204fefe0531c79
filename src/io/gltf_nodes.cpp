#include "io/gltf_nodes.h"

namespace cagewright {

GltfNodes::GltfNodes(const GltfDocument& document)
    : document_(document.json()), source_(document.source()), nodes_(member(document_, "nodes")) {
  parents_.resize(nodes_.is_array() ? nodes_.size() : 0);
  world_.resize(parents_.size());
  for (std::size_t n = 0; n < parents_.size(); ++n) {
    const Json& children = member(nodes_[n], "children");
    for (std::size_t i = 0; children.is_array() && i < children.size(); ++i) {
      const std::optional<std::size_t> child = to_size(children[i]);
      if (child && *child < parents_.size() && !parents_[*child]) {
        parents_[*child] = n;
      }
    }
  }
}

Result<std::vector<std::size_t>> GltfNodes::roots() {
  const Json& scenes = member(document_, "scenes");
  if (scenes.is_array() && !scenes.empty()) {
    const std::size_t scene = to_size(member(document_, "scene")).value_or(0);
    if (scene >= scenes.size()) {
      return source_.error("the default scene does not exist" + std::string(export_again));
    }
    return list(member(scenes[scene], "nodes"), "scene " + std::to_string(scene));
  }
  std::vector<std::size_t> found;
  for (std::size_t n = 0; n < parents_.size(); ++n) {
    if (!parents_[n]) {
      found.push_back(n);
    }
  }
  return found;
}

Result<std::vector<std::size_t>> GltfNodes::list(const Json& nodes,
                                                 const std::string& where) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; nodes.is_array() && i < nodes.size(); ++i) {
    const std::optional<std::size_t> node = to_size(nodes[i]);
    if (!node || *node >= parents_.size()) {
      return source_.error(where + " refers to a node that does not exist" +
                           std::string(export_again));
    }
    found.push_back(*node);
  }
  return found;
}

Result<std::vector<std::size_t>> GltfNodes::children(std::size_t node) const {
  return list(member(nodes_[node], "children"), "node " + std::to_string(node));
}

// A node that is met twice belongs to two parents or to itself.
Result<std::vector<GltfNodes::Shown>> GltfNodes::shown() {
  const Result<std::vector<std::size_t>> first = roots();
  if (!first) {
    return first.error();
  }
  std::vector<char> visited(parents_.size(), 0);
  std::vector<Shown> stack; // with the transform of the parent
  for (auto root = first->rbegin(); root != first->rend(); ++root) {
    stack.push_back({*root, Transform::Identity()});
  }
  std::vector<Shown> order;
  while (!stack.empty()) {
    const Shown visit = stack.back();
    stack.pop_back();
    if (visited[visit.node] != 0) {
      return source_.error("node " + std::to_string(visit.node) + " stands in the scene twice" +
                           std::string(export_again));
    }
    visited[visit.node] = 1;
    const Result<Transform> own = local(visit.node);
    const Result<std::vector<std::size_t>> below = children(visit.node);
    if (!own || !below) {
      return own ? below.error() : own.error();
    }
    const Transform transform = visit.transform * *own;
    world_[visit.node] = transform;
    order.push_back({visit.node, transform});
    for (auto child = below->rbegin(); child != below->rend(); ++child) {
      stack.push_back({*child, transform});
    }
  }
  return order;
}

Result<GltfNodes::Transform> GltfNodes::world(std::size_t node) {
  std::vector<std::size_t> unknown; // from the node upwards
  for (std::optional<std::size_t> n = node; n && !world_[*n]; n = parents_[*n]) {
    if (unknown.size() > parents_.size()) {
      return source_.error("node " + std::to_string(node) + " stands below itself" +
                           std::string(export_again));
    }
    unknown.push_back(*n);
  }
  for (auto n = unknown.rbegin(); n != unknown.rend(); ++n) {
    const Result<Transform> own = local(*n);
    if (!own) {
      return own.error();
    }
    world_[*n] = parents_[*n] ? *world_[*parents_[*n]] * *own : *own;
  }
  return *world_[node];
}

Result<GltfNodes::Transform> GltfNodes::local(std::size_t node) const {
  const Json& json = nodes_[node];
  Transform transform = Transform::Identity();
  std::vector<double> m;
  std::vector<double> t;
  std::vector<double> r;
  std::vector<double> s;
  if (!read_numbers(member(json, "matrix"), 16, m) ||
      !read_numbers(member(json, "translation"), 3, t) ||
      !read_numbers(member(json, "rotation"), 4, r) || !read_numbers(member(json, "scale"), 3, s)) {
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

bool read_numbers(const Json& list, std::size_t count, std::vector<double>& numbers) {
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

} // namespace cagewright
