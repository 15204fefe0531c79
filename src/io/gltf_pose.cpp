#include "io/gltf_pose.h"

#include <cmath>

namespace cagewright {
namespace {

std::string numbered(std::string_view what, std::size_t index) {
  return std::string(what) + ' ' + std::to_string(index);
}

/// One of the sets of four joints for each vertex.
struct JointSet {
  std::size_t accessor = 0;
  std::vector<double> joints;
  std::vector<double> weights;
};

} // namespace

Result<std::vector<std::size_t>> GltfSkins::joints(std::size_t skin) const {
  const Json& list = member(element(member(document_.json(), "skins"), skin), "joints");
  if (!list.is_array()) {
    return document_.source().error(numbered("skin", skin) + " does not exist or has no joints" +
                                    std::string(export_again));
  }
  std::vector<std::size_t> nodes;
  for (const Json& item : list) {
    const std::optional<std::size_t> node = to_size(item);
    if (!node || *node >= nodes_.count()) {
      return document_.source().error(numbered("skin", skin) +
                                      " refers to a node that does not exist" +
                                      std::string(export_again));
    }
    nodes.push_back(*node);
  }
  return nodes;
}

Result<std::vector<Eigen::Affine3d>> GltfSkins::inverse_bind_matrices(std::size_t skin) {
  const Result<std::vector<std::size_t>> nodes = joints(skin);
  if (!nodes) {
    return nodes.error();
  }
  std::vector<Eigen::Affine3d> matrices(nodes->size(), Eigen::Affine3d::Identity());
  const Json& stored =
      member(element(member(document_.json(), "skins"), skin), "inverseBindMatrices");
  if (stored.is_null()) {
    return matrices;
  }
  const std::optional<std::size_t> accessor = to_size(stored);
  if (!accessor) {
    return document_.source().error(numbered("skin", skin) +
                                    " has inverse bind matrices that do not exist" +
                                    std::string(export_again));
  }
  const Result<std::vector<double>> values = document_.read_vectors(*accessor, 16);
  if (!values) {
    return values.error();
  }
  if (values->size() / 16 < matrices.size()) {
    return document_.source().error(
        numbered("skin", skin) + " has " + counted(matrices.size(), "joint") + ", but accessor " +
        std::to_string(*accessor) + " holds " + std::to_string(values->size() / 16) +
        " inverse bind matrices" + std::string(export_again));
  }
  for (std::size_t j = 0; j < matrices.size(); ++j) { // column after column
    matrices[j].matrix().topRows<3>() =
        Eigen::Map<const Eigen::Matrix4d>(values->data() + 16 * j).topRows<3>();
  }
  return matrices;
}

Result<const std::vector<Eigen::Affine3d>*> GltfSkins::matrices(std::size_t skin) {
  if (const auto known = matrices_.find(skin); known != matrices_.end()) {
    return &known->second;
  }
  const Result<std::vector<std::size_t>> nodes = joints(skin);
  if (!nodes) {
    return nodes.error();
  }
  Result<std::vector<Eigen::Affine3d>> matrices = inverse_bind_matrices(skin);
  if (!matrices) {
    return matrices.error();
  }
  for (std::size_t j = 0; j < nodes->size(); ++j) {
    const Result<Eigen::Affine3d> world = nodes_.world((*nodes)[j]);
    if (!world) {
      return world.error();
    }
    (*matrices)[j] = *world * (*matrices)[j];
  }
  return &matrices_.emplace(skin, *std::move(matrices)).first->second;
}

Result<std::vector<Eigen::Affine3d>> GltfSkins::blend(std::size_t skin, const Json& attributes,
                                                      std::size_t count) {
  std::vector<JointSet> sets;
  for (std::size_t set = 0;; ++set) {
    const auto joints = to_size(member(attributes, ("JOINTS_" + std::to_string(set)).c_str()));
    const auto weights = to_size(member(attributes, ("WEIGHTS_" + std::to_string(set)).c_str()));
    if (!joints || !weights) {
      break;
    }
    Result<std::vector<double>> which = document_.read_vectors(*joints, 4);
    Result<std::vector<double>> how_much =
        which ? document_.read_vectors(*weights, 4) : which.error();
    if (!how_much) {
      return how_much.error();
    }
    if (which->size() != 4 * count || how_much->size() != 4 * count) {
      return document_.source().error(
          numbered("accessor", which->size() != 4 * count ? *joints : *weights) +
          " should have four joints or weights for each vertex" + std::string(export_again));
    }
    sets.push_back({*joints, *std::move(which), *std::move(how_much)});
  }
  if (sets.empty()) {
    return std::vector<Eigen::Affine3d>();
  }
  const auto found = matrices(skin);
  if (!found) {
    return found.error();
  }
  const std::vector<Eigen::Affine3d>& of_joint = **found;
  const auto no_joint = [&](std::size_t accessor, std::size_t v) {
    return document_.source().error(numbered("accessor", accessor) + ": vertex " +
                                    std::to_string(v) + " follows a joint beyond the " +
                                    std::to_string(of_joint.size()) + " of skin " +
                                    std::to_string(skin) + std::string(export_again));
  };
  using Rows = Eigen::Matrix<double, 3, 4>;
  std::vector<Eigen::Affine3d> blends(count);
  for (std::size_t v = 0; v < count; ++v) {
    Rows sum = Rows::Zero();
    double total = 0;
    for (const JointSet& set : sets) {
      for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
        const double weight = set.weights[i];
        if (weight == 0) {
          continue; // what it names is often left over
        }
        if (!(set.joints[i] >= 0 && set.joints[i] < static_cast<double>(of_joint.size()))) {
          return no_joint(set.accessor, v);
        }
        sum += weight * of_joint[static_cast<std::size_t>(set.joints[i])].affine();
        total += weight;
      }
    }
    if (total == 0) {
      const double first = sets[0].joints[4 * v];
      if (!(first >= 0 && first < static_cast<double>(of_joint.size()))) {
        return no_joint(sets[0].accessor, v);
      }
      sum = of_joint[static_cast<std::size_t>(first)].affine();
      total = 1;
    }
    blends[v] = Eigen::Affine3d::Identity();
    // Exact where the weights sum to 1 but for the rounding of the file, as they should.
    blends[v].affine() = sum / total;
  }
  return blends;
}

Result<std::vector<double>> morph_weights(const Source& source, const Json& node, const Json& mesh,
                                          const std::string& where) {
  const Json& own = member(node, "weights");
  const Json& weights = own.is_null() ? member(mesh, "weights") : own;
  std::vector<double> numbers;
  if (!read_numbers(weights, weights.size(), numbers)) {
    return source.error(where + " has weights that are no list of numbers" +
                        std::string(export_again));
  }
  return numbers;
}

GltfMorph morph_of(const Json& primitive, const char* attribute,
                   const std::vector<double>& weights) {
  GltfMorph morph;
  const Json& targets = member(primitive, "targets");
  for (std::size_t t = 0; t < weights.size(); ++t) {
    const auto accessor = to_size(member(element(targets, t), attribute));
    if (weights[t] != 0 && accessor) {
      morph.accessors.push_back(*accessor);
      morph.weights.push_back(weights[t]);
    }
  }
  return morph;
}

Result<std::vector<Vec3>> morph_shifts(GltfDocument& document, const GltfMorph& morph,
                                       std::size_t count) {
  std::vector<Vec3> shifts;
  for (std::size_t t = 0; t < morph.accessors.size(); ++t) {
    const Result<std::vector<double>> values = document.read_vectors(morph.accessors[t], 3);
    if (!values) {
      return values.error();
    }
    if (values->size() != 3 * count) {
      return document.source().error(numbered("accessor", morph.accessors[t]) +
                                     " of a morph target should have " + counted(count, "element") +
                                     ", one for each vertex" + std::string(export_again));
    }
    shifts.resize(count, Vec3::Zero());
    for (std::size_t v = 0; v < count; ++v) {
      shifts[v] += morph.weights[t] * Eigen::Map<const Vec3>(values->data() + 3 * v);
    }
  }
  return shifts;
}

} // namespace cagewright
