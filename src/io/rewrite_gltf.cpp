#include "io/rewrite_gltf.h"

#include "io/atomic_file.h"
#include "io/binary.h"
#include "io/glb.h"
#include "io/gltf_json_text.h"
#include "io/gltf_scene.h"
#include "io/number_text.h"
#include "io/uri.h"
#include "io/write_gltf.h"
#include <cagewright/io/mesh_format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// How far a vertex may stand from where it should, relative to the largest coordinate: floats keep
// seven digits, and transforms take some.
constexpr double allowed_error = 1e-5;

/// The normals of one accessor under one placement.
struct NormalBlock {
  std::size_t placement = 0;
  std::size_t accessor = 0;
  Index base = 0;           ///< of its first normal in FileNormals
  std::vector<Vec3> stored; ///< in the mesh's frame
  std::vector<Vec3> shifts; ///< what the morph targets add, or none
};

struct GltfNormals {
  FileNormals file;
  std::vector<NormalBlock> blocks;
};

std::vector<Vec3> to_points(const std::vector<double>& values) {
  std::vector<Vec3> points;
  points.reserve(values.size() / 3);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    points.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return points;
}

Vec3 shown_normal(const Eigen::Affine3d& transform, const Vec3& stored) {
  // By the cofactors, which exist for any transform: the inverse transposed but for its scale.
  const Eigen::Matrix3d& m = transform.linear();
  const Vec3 normal = m.col(1).cross(m.col(2)) * stored.x() +
                      m.col(2).cross(m.col(0)) * stored.y() + m.col(0).cross(m.col(1)) * stored.z();
  return (m.determinant() < 0 ? Vec3(-normal) : normal).stableNormalized();
}

const Json& primitive_of(const Json& json, const GltfShown& shown) {
  return element(member(element(member(json, "meshes"), shown.mesh), "primitives"),
                 shown.primitive);
}

Result<NormalBlock> read_block(GltfDocument& document, const GltfScene& scene,
                               const GltfShown& shown, Index base) {
  const GltfPlacement& placement = scene.placements[shown.placement];
  const Result<std::vector<double>> values = document.read_vectors(*shown.normals, 3);
  if (!values) {
    return values.error();
  }
  if (values->size() != 3 * placement.count) {
    return document.source().error("accessor " + std::to_string(*shown.normals) +
                                   " should have a normal for each vertex" +
                                   std::string(export_again));
  }
  Result<std::vector<Vec3>> shifts = morph_shifts(
      document, morph_of(primitive_of(document.json(), shown), "NORMAL", placement.morph_weights),
      placement.count);
  if (!shifts) {
    return shifts.error();
  }
  return NormalBlock{shown.placement, *shown.normals, base, to_points(*values), *std::move(shifts)};
}

Result<GltfNormals> normals_of(GltfDocument& document, const GltfScene& scene) {
  GltfNormals result;
  std::map<std::pair<std::size_t, std::size_t>, Index> known;
  for (const GltfShown& shown : scene.shown) {
    if (!shown.normals) {
      continue;
    }
    const GltfPlacement& placement = scene.placements[shown.placement];
    const auto [block, is_new] = known.try_emplace({shown.placement, *shown.normals},
                                                   static_cast<Index>(result.file.normals.size()));
    if (is_new) {
      Result<NormalBlock> read = read_block(document, scene, shown, block->second);
      if (!read) {
        return read.error();
      }
      for (std::size_t v = 0; v < placement.count; ++v) {
        const Vec3 local =
            read->stored[v] + (read->shifts.empty() ? Vec3(0, 0, 0) : read->shifts[v]);
        const Vec3 normal = shown_normal(placement.transform_of(v), local);
        result.file.normals.push_back(normal.allFinite() ? normal : Vec3(Vec3::Zero()));
      }
      result.blocks.push_back(*std::move(read));
    }
    result.file.of_corner.resize(scene.mesh.corners().size(), FileNormals::none);
    for (std::size_t c = shown.first_corner; c < shown.end_corner; ++c) {
      result.file.of_corner[c] = block->second + scene.mesh.corners()[c] - placement.base;
    }
  }
  return result;
}

/// New values of an accessor, element after element; none: as they are.
using Floats = std::vector<float>;

void append(Floats& floats, const Vec3& v) {
  for (const double x : v) {
    floats.push_back(static_cast<float>(x));
  }
}

Floats to_floats(const std::vector<double>& values) {
  Floats floats;
  floats.reserve(values.size());
  for (const double value : values) {
    floats.push_back(static_cast<float>(value));
  }
  return floats;
}

/// The point that a transform takes to `to`, or as near to it as can be where it flattens.
Vec3 taken_back(const Eigen::Affine3d& transform, const Vec3& from, const Vec3& from_shown,
                const Vec3& to) {
  const Eigen::Matrix3d& m = transform.linear();
  const double size = m.lpNorm<Eigen::Infinity>();
  if (std::abs(m.determinant()) > 1e-6 * size * size * size) {
    return m.inverse() * (to - transform.translation());
  }
  // The least squares of a shift, damped: what is thinner than 1e-5 floats cannot tell from flat.
  const Eigen::Matrix3d square =
      m.transpose() * m + 1e-10 * std::max(size * size, 1e-300) * Eigen::Matrix3d::Identity();
  return from + square.inverse() * (m.transpose() * (to - from_shown));
}

double largest_coordinate(std::span<const Vec3> positions) {
  double size = 0;
  for (const Vec3& p : positions) {
    size = std::max(size, p.lpNorm<Eigen::Infinity>());
  }
  return size;
}

/// How far vertices under a placement may stand from where they should.
double tolerance(const GltfPlacement& placement, double size) {
  double around = placement.transform.translation().lpNorm<Eigen::Infinity>();
  for (const Eigen::Affine3d& blend : placement.blends) {
    around = std::max(around, blend.translation().lpNorm<Eigen::Infinity>());
  }
  return allowed_error * std::max(size, around);
}

Error flattened(const Source& source, const GltfPlacement& placement, std::size_t count,
                std::size_t first) {
  const std::string where = "node " + std::to_string(placement.node);
  return placement.blends.empty()
             ? source.error(where + " flattens its mesh, which cannot be changed in place; apply "
                                    "the scale first, or write OBJ",
                            ErrorCode::unsupported)
             : source.error(where + ": " + counted(count, "vertex") + " (the first is " +
                                std::to_string(first) +
                                ") cannot be moved there, because the joints flatten the mesh; "
                                "deform the bind pose, or write OBJ",
                            ErrorCode::unsupported);
}

/// The positions to store for one placement.
Result<std::optional<Floats>> moved_positions(GltfDocument& document, const GltfScene& scene,
                                              const GltfPlacement& placement,
                                              std::span<const Vec3> positions, double size) {
  const Result<std::vector<double>> stored = document.read_vectors(placement.positions, 3);
  if (!stored) {
    return stored.error();
  }
  const std::vector<Vec3> before = to_points(*stored);
  const double allowed = tolerance(placement, size);
  Floats values;
  values.reserve(stored->size());
  std::size_t beyond = 0;
  std::size_t first_beyond = 0;
  for (std::size_t v = 0; v < placement.count; ++v) {
    const Vec3& shown = scene.mesh.positions[placement.base + v];
    const Vec3& to = positions[placement.base + v];
    if (to == shown) {
      append(values, before[v]);
      continue;
    }
    const Eigen::Affine3d& transform = placement.transform_of(v);
    const Vec3 shift = placement.shift_of(v);
    const Vec3 local = taken_back(transform, before[v] + shift, shown, to) - shift;
    append(values, local);
    const Vec3 reached = transform * Vec3(local.cast<float>().cast<double>() + shift);
    if (!((reached - to).lpNorm<Eigen::Infinity>() <= allowed)) {
      first_beyond = beyond == 0 ? v : first_beyond;
      ++beyond;
    }
  }
  if (beyond > 0) {
    return flattened(document.source(), placement, beyond, first_beyond);
  }
  return values == to_floats(*stored) ? std::optional<Floats>() : std::optional(std::move(values));
}

/// The stored normal of unit length that, with what the morph targets add, points along `along`.
Vec3 without_shift(const Vec3& along, const Vec3& shift) {
  const double part = along.dot(shift);
  const double square = part * part + 1 - shift.squaredNorm();
  return square > 0 && part + std::sqrt(square) > 0
             ? Vec3(along * (part + std::sqrt(square)) - shift).stableNormalized()
             : along;
}

struct Turned {
  std::optional<Floats> normals;
  std::optional<Floats> tangents;
};

/// Normals that have turned, and the tangents beside them.
Result<Turned> turned_normals(GltfDocument& document, const GltfScene& scene,
                              const NormalBlock& block, const FileNormals& file,
                              std::span<const Vec3> normals, std::optional<std::size_t> tangent) {
  const GltfPlacement& placement = scene.placements[block.placement];
  std::vector<double> along;
  if (tangent) {
    Result<std::vector<double>> read = document.read_vectors(*tangent, 4);
    if (!read) {
      return read.error();
    }
    along = *std::move(read);
  }
  Floats values;
  Floats tangents = to_floats(along);
  bool any = false;
  for (std::size_t v = 0; v < placement.count; ++v) {
    const Vec3& after = normals[block.base + v];
    Vec3 local = placement.transform_of(v).linear().transpose() * after;
    local.stableNormalize();
    const bool stays = (after - file.normals[block.base + v]).norm() < 1e-7 ||
                       !(local.squaredNorm() > 0.5); // flattened away
    if (stays) {
      append(values, block.stored[v]);
      continue;
    }
    any = true;
    const Vec3 unit = block.shifts.empty() ? local : without_shift(local, block.shifts[v]);
    append(values, unit);
    if (4 * v + 3 < along.size()) {
      const auto turn = Eigen::Quaterniond::FromTwoVectors(block.stored[v], unit);
      const Vec3 turned = turn * Vec3(along[4 * v], along[4 * v + 1], along[4 * v + 2]);
      if (turned.allFinite()) {
        std::copy_n(turned.cast<float>().eval().data(), 3, &tangents[4 * v]);
      }
    }
  }
  Turned result;
  if (any) {
    result.normals = std::move(values);
    if (tangents != to_floats(along)) {
      result.tangents = std::move(tangents);
    }
  }
  return result;
}

enum Attribute : std::size_t { position, normal, tangent };
constexpr std::array<const char*, 3> attribute_names = {"POSITION", "NORMAL", "TANGENT"};
constexpr std::array<std::size_t, 3> attribute_sizes = {3, 3, 4};

/// What the attributes of a primitive are to hold under one node: numbers of values, or none where
/// they stay.
using Wants = std::array<std::optional<std::size_t>, 3>;

/// A mesh of the file with other values, or a copy of it for the nodes that show another shape.
struct MeshPlan {
  std::size_t mesh = 0; ///< of the file
  bool is_copy = false;
  std::vector<std::size_t> nodes; ///< that show it
  std::map<std::size_t, Wants> primitives;
};

/// What is to be stored, and by which meshes.
class Plan {
public:
  explicit Plan(GltfDocument& document) : document_(document) {}

  Status make(const GltfScene& scene, std::span<const Vec3> positions, const GltfNormals* stored,
              std::span<const Vec3> normals) {
    const Result<std::vector<Wants>> wants = wants_of(scene, positions, stored, normals);
    if (!wants) {
      return wants.error();
    }
    for (std::size_t first = 0; first < scene.shown.size();) {
      std::size_t end = first;
      while (end < scene.shown.size() && scene.shown[end].node == scene.shown[first].node) {
        ++end;
      }
      const Status status = add_node(std::span(scene.shown).subspan(first, end - first),
                                     std::span(*wants).subspan(first, end - first));
      if (!status) {
        return status;
      }
      first = end;
    }
    return success();
  }

  std::vector<MeshPlan> meshes;
  std::vector<Floats> values;

private:
  Result<std::vector<Wants>> wants_of(const GltfScene& scene, std::span<const Vec3> positions,
                                      const GltfNormals* stored, std::span<const Vec3> normals) {
    const double size = largest_coordinate(positions);
    std::vector<std::optional<std::size_t>> moved;
    for (const GltfPlacement& placement : scene.placements) {
      Result<std::optional<Floats>> floats =
          moved_positions(document_, scene, placement, positions, size);
      if (!floats) {
        return floats.error();
      }
      moved.push_back(add_values(*std::move(floats)));
    }
    std::vector<Wants> wants(scene.shown.size());
    using Key = std::tuple<std::size_t, std::size_t, std::optional<std::size_t>>;
    std::map<Key, Wants> known;
    for (std::size_t s = 0; s < scene.shown.size(); ++s) {
      const GltfShown& shown = scene.shown[s];
      wants[s][position] = moved[shown.placement];
      if (stored == nullptr || !shown.normals) {
        continue;
      }
      const auto [found, is_new] =
          known.try_emplace({shown.placement, *shown.normals, shown.tangents});
      if (is_new) {
        const auto block = std::find_if(
            stored->blocks.begin(), stored->blocks.end(), [&](const NormalBlock& other) {
              return other.placement == shown.placement && other.accessor == *shown.normals;
            });
        Result<Turned> turned =
            turned_normals(document_, scene, *block, stored->file, normals, shown.tangents);
        if (!turned) {
          return turned.error();
        }
        found->second[normal] = add_values(std::move(turned->normals));
        found->second[tangent] = add_values(std::move(turned->tangents));
      }
      wants[s][normal] = found->second[normal];
      wants[s][tangent] = found->second[tangent];
    }
    return wants;
  }

  std::optional<std::size_t> add_values(std::optional<Floats> floats) {
    if (!floats) {
      return std::nullopt;
    }
    values.push_back(*std::move(floats));
    return values.size() - 1;
  }

  // Nodes that show a mesh in the same shape go on sharing it.
  Status add_node(std::span<const GltfShown> shown, std::span<const Wants> wants) {
    bool is_copy = false;
    for (MeshPlan& plan : meshes) {
      if (plan.mesh != shown[0].mesh) {
        continue;
      }
      is_copy = true;
      const Result<bool> same = agrees(plan, shown, wants);
      if (!same) {
        return same.error();
      }
      if (*same) {
        plan.nodes.push_back(shown[0].node);
        return success();
      }
    }
    MeshPlan plan{shown[0].mesh, is_copy, {shown[0].node}, {}};
    for (std::size_t i = 0; i < shown.size(); ++i) {
      plan.primitives[shown[i].primitive] = wants[i];
    }
    follow_along(plan);
    meshes.push_back(std::move(plan));
    return success();
  }

  // Lines and points over the vertices of triangles go where those go.
  void follow_along(MeshPlan& plan) const {
    const Json& primitives =
        member(element(member(document_.json(), "meshes"), plan.mesh), "primitives");
    const std::map<std::size_t, Wants> shown = plan.primitives;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      if (shown.contains(p)) {
        continue;
      }
      for (std::size_t a = 0; a < attribute_names.size(); ++a) {
        const Json& own = member(member(primitives[p], "attributes"), attribute_names[a]);
        const auto leader = std::find_if(shown.begin(), shown.end(), [&](const auto& other) {
          return !own.is_null() && other.second[a] &&
                 member(member(primitives[other.first], "attributes"), attribute_names[a]) == own;
        });
        if (leader != shown.end()) {
          plan.primitives[p][a] = leader->second[a];
        }
      }
    }
  }

  Result<bool> agrees(const MeshPlan& plan, std::span<const GltfShown> shown,
                      std::span<const Wants> wants) {
    const Json& meshes_of_file = member(document_.json(), "meshes");
    const Json& primitives = member(meshes_of_file[plan.mesh], "primitives");
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const Wants& other = plan.primitives.at(shown[i].primitive);
      for (std::size_t a = 0; a < attribute_names.size(); ++a) {
        if (wants[i][a] == other[a]) {
          continue;
        }
        const std::size_t accessor =
            to_size(
                member(member(primitives[shown[i].primitive], "attributes"), attribute_names[a]))
                .value_or(0);
        const Result<std::vector<double>> stored =
            document_.read_vectors(accessor, attribute_sizes[a]);
        if (!stored) {
          return stored.error();
        }
        const Floats rest = to_floats(*stored);
        if (!equal_but_for_rounding(wants[i][a] ? values[*wants[i][a]] : rest,
                                    other[a] ? values[*other[a]] : rest, attribute_sizes[a])) {
          return false;
        }
      }
    }
    return true;
  }

  static bool equal_but_for_rounding(const Floats& a, const Floats& b, std::size_t components) {
    for (std::size_t i = 0; i < a.size(); i += components) {
      const float size = std::max({std::abs(a[i]), std::abs(a[i + 1]), std::abs(a[i + 2]), 1e-30F});
      for (std::size_t k = i; k < i + components; ++k) {
        if (!(std::abs(a[k] - b[k]) <= 4e-6F * size)) {
          return false;
        }
      }
    }
    return true;
  }

  GltfDocument& document_;
};

/// The list with the least or the greatest of each component.
std::string bounds_text(const Floats& values, std::size_t components, bool greatest) {
  std::string text(1, '[');
  for (std::size_t i = 0; i < components; ++i) {
    float bound = values[i];
    for (std::size_t k = i; k < values.size(); k += components) {
      bound = greatest ? std::max(bound, values[k]) : std::min(bound, values[k]);
    }
    text.append(i > 0 ? 1 : 0, ',');
    append_number(text, bound);
  }
  text.push_back(']');
  return text;
}

void store(const Floats& values, char* to) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto stored = std::bit_cast<std::array<char, 4>>(values[i]);
    if (std::endian::native == std::endian::big) {
      std::reverse(stored.begin(), stored.end());
    }
    std::copy(stored.begin(), stored.end(), to + 4 * i);
  }
}

/// Carries a plan out: in buffers and in the JSON.
class Editor {
public:
  Editor(GltfDocument& document, const Plan& plan)
      : document_(document), plan_(plan), json_(document.json_text()),
        accessors_(size_of("accessors")), views_(size_of("bufferViews")),
        meshes_(size_of("meshes")) {}

  Status carry_out() {
    find_users();
    for (const auto& [accessor, users] : users_) {
      if (users.wanted.empty()) {
        continue;
      }
      const bool all_alike = users.wanted.size() == 1 && !users.as_stored;
      for (const auto& [value, components] : users.wanted) {
        const Status status = all_alike ? change(accessor, value, components)
                                        : add_accessor(accessor, value, components);
        if (!status) {
          return status;
        }
      }
    }
    for (const MeshPlan& mesh : plan_.meshes) {
      patch_mesh(mesh);
    }
    return success();
  }

  JsonPatch& json() { return json_; }

  /// The whole JSON, at the end.
  std::string take_json() {
    if (is_longer_) {
      json_.replace("buffers", 0, "byteLength",
                    std::to_string(document_.changeable_buffer(0).size()));
    }
    return std::move(json_).take();
  }

  /// Buffers that are not as they were; the last may be new.
  std::set<std::size_t> changed;
  std::optional<std::size_t> added_buffer;

private:
  struct Users {
    std::map<std::size_t, std::size_t> wanted; // numbers of values, and their components
    bool as_stored = false;                    // somebody needs it as it is
  };

  [[nodiscard]] std::size_t size_of(const char* list) const {
    const Json& array = member(document_.json(), list);
    return array.is_array() ? array.size() : 0;
  }

  void needs_as_stored(const Json& accessor) {
    if (const std::optional<std::size_t> index = to_size(accessor)) {
      users_[*index].as_stored = true;
    }
  }

  void find_users() {
    const Json& json = document_.json();
    std::vector<const MeshPlan*> own(meshes_);
    for (const MeshPlan& plan : plan_.meshes) {
      if (!plan.is_copy) {
        own[plan.mesh] = &plan;
      } else {
        find_users_in(plan.mesh, &plan);
      }
    }
    for (std::size_t m = 0; m < meshes_; ++m) {
      find_users_in(m, own[m]);
    }
    for (const Json& skin : list_of(json, "skins")) {
      needs_as_stored(member(skin, "inverseBindMatrices"));
    }
    for (const Json& animation : list_of(json, "animations")) {
      for (const Json& sampler : list_of(animation, "samplers")) {
        needs_as_stored(member(sampler, "input"));
        needs_as_stored(member(sampler, "output"));
      }
    }
    for (const Json& node : list_of(json, "nodes")) {
      for (const Json& instances :
           list_of(member(member(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes")) {
        needs_as_stored(instances);
      }
    }
  }

  static const Json& list_of(const Json& object, const char* name) { return member(object, name); }

  void find_users_in(std::size_t mesh, const MeshPlan* plan) {
    const Json& primitives =
        member(element(member(document_.json(), "meshes"), mesh), "primitives");
    for (std::size_t p = 0; primitives.is_array() && p < primitives.size(); ++p) {
      Wants wants;
      if (plan != nullptr && plan->primitives.contains(p)) {
        wants = plan->primitives.at(p);
      }
      const Json& attributes = member(primitives[p], "attributes");
      for (const auto& [name, accessor] : attributes.items()) {
        std::size_t a = 0;
        while (a < attribute_names.size() && name != attribute_names[a]) {
          ++a;
        }
        const std::optional<std::size_t> index = to_size(accessor);
        if (index && a < attribute_names.size() && wants[a]) {
          users_[*index].wanted[*wants[a]] = attribute_sizes[a];
        } else {
          needs_as_stored(accessor);
        }
      }
      needs_as_stored(member(primitives[p], "indices"));
      for (const Json& target : list_of(primitives[p], "targets")) {
        for (const Json& accessor : target) {
          needs_as_stored(accessor);
        }
      }
    }
  }

  /// Gives an accessor other values: where they are, or else in a place of their own.
  Status change(std::size_t accessor, std::size_t value, std::size_t components) {
    const Floats& floats = plan_.values[value];
    const Result<std::optional<GltfDocument::Place>> place =
        document_.place_of(accessor, components);
    if (!place) {
      return place.error();
    }
    if (!*place) {
      json_.replace("accessors", accessor, description(accessor, value, components).dump());
      return space_;
    }
    std::string& bytes = document_.changeable_buffer((*place)->buffer);
    for (std::size_t i = 0; i < (*place)->count; ++i) {
      store(Floats(floats.begin() + static_cast<std::ptrdiff_t>(i * components),
                   floats.begin() + static_cast<std::ptrdiff_t>((i + 1) * components)),
            &bytes[(*place)->begin + i * (*place)->stride]);
    }
    changed.insert((*place)->buffer);
    if (components == 3) { // the bounds of tangents are not asked for, and seldom given
      json_.replace("accessors", accessor, "min", bounds_text(floats, components, false));
      json_.replace("accessors", accessor, "max", bounds_text(floats, components, true));
    }
    return success();
  }

  Status add_accessor(std::size_t original, std::size_t value, std::size_t components) {
    json_.append("accessors", description(original, value, components).dump());
    replaced_[{original, value}] = accessors_++;
    return space_;
  }

  /// An accessor for values in a new place; the rest, such as the name, as in the original.
  Json description(std::size_t original, std::size_t value, std::size_t components) {
    const Floats& floats = plan_.values[value];
    Json accessor = member(document_.json(), "accessors")[original];
    for (const char* name : {"byteOffset", "sparse", "normalized"}) {
      accessor.erase(name);
    }
    accessor["bufferView"] = add_view(floats);
    accessor["componentType"] = 5126; // float
    if (components == 3) {
      accessor["min"] = Json::parse(bounds_text(floats, components, false));
      accessor["max"] = Json::parse(bounds_text(floats, components, true));
    } else {
      accessor.erase("min");
      accessor.erase("max");
    }
    return accessor;
  }

  std::size_t add_view(const Floats& floats) {
    const bool has_chunk =
        size_of("buffers") > 0 && document_.is_binary_chunk(0) && !document_.binary_chunk().empty();
    const std::size_t buffer = has_chunk ? 0 : size_of("buffers");
    if (!has_chunk && !added_buffer) {
      added_buffer = buffer;
      document_.reserve_buffers(buffer + 1);
    }
    std::string& bytes = document_.changeable_buffer(buffer);
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const std::size_t begin = bytes.size();
    bytes.resize(begin + 4 * floats.size());
    store(floats, &bytes[begin]);
    changed.insert(buffer);
    is_longer_ = has_chunk;
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max() - (std::size_t{1} << 28U)) {
      space_ = document_.source().error("would become larger than GLB files can be; write OBJ",
                                        ErrorCode::too_large);
    }
    json_.append("bufferViews", Json{{"buffer", buffer},
                                     {"byteOffset", begin},
                                     {"byteLength", 4 * floats.size()},
                                     {"target", 34962}} // vertices
                                    .dump());
    return views_++;
  }

  void patch_mesh(const MeshPlan& plan) {
    Json mesh = member(document_.json(), "meshes")[plan.mesh];
    for (const auto& [p, wants] : plan.primitives) {
      Json& primitive = mesh["primitives"][p];
      bool differs = false;
      for (std::size_t a = 0; a < attribute_names.size(); ++a) {
        if (!wants[a]) {
          continue;
        }
        Json& accessor = primitive["attributes"][attribute_names[a]];
        const auto found = replaced_.find({to_size(accessor).value_or(0), *wants[a]});
        if (found != replaced_.end()) {
          accessor = found->second;
          differs = true;
        }
        differs = drop_compressed_copy(primitive) || differs;
      }
      if (differs && !plan.is_copy) {
        json_.replace_element("meshes", plan.mesh, "primitives", p, primitive.dump());
      }
    }
    if (plan.is_copy) {
      json_.append("meshes", mesh.dump());
      for (const std::size_t node : plan.nodes) {
        json_.replace("nodes", node, "mesh", std::to_string(meshes_));
      }
      ++meshes_;
    }
  }

  // The same vertices once more, as they were.
  static bool drop_compressed_copy(Json& primitive) {
    constexpr const char* draco = "KHR_draco_mesh_compression";
    if (member(member(primitive, "extensions"), draco).is_null()) {
      return false;
    }
    primitive["extensions"].erase(draco);
    if (primitive["extensions"].empty()) {
      primitive.erase("extensions");
    }
    return true;
  }

  GltfDocument& document_;
  const Plan& plan_;
  JsonPatch json_;
  std::map<std::size_t, Users> users_;                                  // by accessor
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> replaced_; // (accessor, values)
  std::size_t accessors_;
  std::size_t views_;
  std::size_t meshes_;
  bool is_longer_ = false;   // the binary chunk
  Status space_ = success(); // unless the file becomes too long
};

/// The file with another JSON and, in GLB, another binary chunk.
std::string assemble(const GltfDocument& document, std::string json,
                     std::optional<std::string_view> binary) {
  const std::string_view bytes = document.source().bytes;
  if (!bytes.starts_with("glTF")) {
    const auto begin = static_cast<std::size_t>(document.json_text().data() - bytes.data());
    return std::string(bytes.substr(0, begin)) + json;
  }
  if (json == document.json_text() && (!binary || *binary == document.binary_chunk())) {
    return std::string(bytes);
  }
  if (json.size() != document.json_text().size()) { // without the blanks that padded it
    json.erase(json.find_last_not_of(" \t\r\n") + 1);
  }
  std::string result("glTF");
  append_glb_size(result, 2);
  append_glb_size(result, 0);
  for (const GltfDocument::Chunk& chunk : document.chunks()) {
    if (chunk.content.data() + chunk.content.size() ==
        document.json_text().data() + document.json_text().size()) {
      append_glb_chunk(result, chunk.type, json, ' ');
    } else if (binary && chunk.content.data() == document.binary_chunk().data()) {
      append_glb_chunk(result, chunk.type, *binary, '\0');
    } else {
      append_glb_chunk(result, chunk.type, chunk.content, '\0');
    }
  }
  std::string length;
  append_glb_size(length, result.size());
  return result.replace(8, 4, length);
}

/// A name beside `out` for a buffer, which no file that the original refers to has.
std::filesystem::path free_name(const std::filesystem::path& out,
                                const std::vector<std::filesystem::path>& taken) {
  for (int i = 0;; ++i) {
    std::filesystem::path name = out.parent_path() / out.stem();
    if (i > 0) {
      name += '-';
      name += std::to_string(i);
    }
    name += ".bin";
    std::error_code ignored;
    if (std::none_of(taken.begin(), taken.end(), [&](const std::filesystem::path& other) {
          return name == other || std::filesystem::equivalent(name, other, ignored);
        })) {
      return name;
    }
  }
}

bool same_folder(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  const auto named = [](const std::filesystem::path& path) {
    return path.empty() ? std::filesystem::path(".") : path;
  };
  return std::filesystem::equivalent(named(a), named(b), ignored);
}

/// Reads the changed file again: accessors that overlap others in other ways than glTF files do
/// would have spoiled each other.
Status check_result(GltfDocument& document, const GltfScene& before,
                    std::span<const Vec3> positions, Pose pose) {
  const Result<GltfScene> scene = read_gltf_scene(document, pose);
  if (!scene) {
    return scene.error();
  }
  const double size = largest_coordinate(positions);
  const auto spoiled = [&](std::size_t accessor) {
    return document.source().error("accessor " + std::to_string(accessor) +
                                       " overlaps another or is too coarse, and cannot be "
                                       "changed in place; export the model again, or write OBJ",
                                   ErrorCode::unsupported);
  };
  if (!std::equal(scene->mesh.corners().begin(), scene->mesh.corners().end(),
                  before.mesh.corners().begin(), before.mesh.corners().end()) ||
      scene->mesh.positions.size() != positions.size()) {
    return spoiled(before.placements[0].positions);
  }
  for (const GltfPlacement& placement : scene->placements) {
    const double allowed = tolerance(placement, size);
    for (std::size_t v = placement.base; v < placement.base + placement.count; ++v) {
      const double error = (scene->mesh.positions[v] - positions[v]).lpNorm<Eigen::Infinity>();
      if (!(error <= allowed)) {
        return spoiled(placement.positions);
      }
    }
  }
  return success();
}

/// Files beside the one that is written, by their buffers.
using BufferFiles = std::map<std::size_t, std::filesystem::path>;

/// Gives the buffers that have changed, or that move to another folder, other URIs.
/// \param embeds  all of them hold their data, in no other file
Result<BufferFiles> place_buffers(GltfDocument& document, Editor& editor,
                                  const std::filesystem::path& out, bool embeds) {
  const Json& buffers = member(document.json(), "buffers");
  const bool moves_away = !same_folder(document.folder()->native(), out.parent_path());
  std::vector<std::filesystem::path> taken;
  for (std::size_t b = 0; b < buffers.size(); ++b) {
    if (const auto file = document.file_of_buffer(b)) {
      taken.push_back(*file);
    }
  }
  const bool uses_files = !taken.empty() && !embeds;
  BufferFiles files;
  const auto uri_of_new_file = [&](std::size_t buffer) {
    files[buffer] = free_name(out, taken);
    taken.push_back(files[buffer]);
    return Json(encode_percent(files[buffer].filename().string()));
  };
  for (std::size_t b = 0; b < buffers.size(); ++b) {
    const bool is_file = document.file_of_buffer(b).has_value();
    const bool stays = !editor.changed.contains(b) && !(is_file && (moves_away || embeds));
    if (stays || document.is_binary_chunk(b)) {
      continue;
    }
    const Result<std::string_view> bytes = document.bytes_of_buffer(b);
    if (!bytes) {
      return bytes.error();
    }
    const Json uri = is_file && !embeds ? uri_of_new_file(b) : Json(data_uri(*bytes));
    editor.json().replace("buffers", b, "uri", uri.dump());
  }
  if (editor.added_buffer) {
    const std::string_view bytes = document.changeable_buffer(*editor.added_buffer);
    const Json uri = uses_files ? uri_of_new_file(*editor.added_buffer) : Json(data_uri(bytes));
    editor.json().append("buffers", Json{{"uri", uri}, {"byteLength", bytes.size()}}.dump());
  }
  return files;
}

/// The document as JSON alone, with the binary chunk in it.
Result<std::string> as_json(GltfDocument& document) {
  Json json = document.json();
  if (!document.binary_chunk().empty() && document.is_binary_chunk(0)) {
    const Result<std::string_view> bytes = document.bytes_of_buffer(0);
    if (!bytes) {
      return bytes.error();
    }
    json["buffers"][0]["uri"] = data_uri(*bytes);
  }
  return json.dump(1) + '\n';
}

/// The document as GLB, with its first buffer as the binary chunk.
Result<std::string> as_glb(GltfDocument& document) {
  Json json = document.json();
  std::string_view binary;
  if (element(member(json, "buffers"), 0).is_object()) {
    const Result<std::string_view> bytes = document.bytes_of_buffer(0);
    if (!bytes) {
      return bytes.error();
    }
    binary = *bytes;
    json["buffers"][0].erase("uri");
  }
  Result<std::string> bytes = glb_of(json.dump(), binary);
  return bytes ? std::move(bytes) : document.source().error(bytes.error().message);
}

Status write_all(GltfDocument& document, std::string json, const BufferFiles& files,
                 const std::filesystem::path& out) {
  for (const auto& [buffer, name] : files) { // first: a file that names them finds them
    const Result<std::string_view> bytes = document.bytes_of_buffer(buffer);
    const Status status = bytes ? write_file_atomically(name, *bytes) : bytes.error();
    if (!status) {
      return status;
    }
  }
  std::optional<std::string_view> binary;
  if (!document.binary_chunk().empty() && document.is_binary_chunk(0)) {
    binary = document.whole_buffer(0);
  }
  return write_file_atomically(out, assemble(document, std::move(json), binary));
}

} // namespace

Result<FileNormals> read_gltf_normals(const Source& source,
                                      const std::optional<std::filesystem::path>& folder,
                                      Pose pose) {
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  const Result<GltfScene> scene = read_gltf_scene(*document, pose);
  if (!scene) {
    return scene.error();
  }
  return read_gltf_normals(*document, *scene);
}

Result<FileNormals> read_gltf_normals(GltfDocument& document, const GltfScene& scene) {
  Result<GltfNormals> normals = normals_of(document, scene);
  return normals ? Result<FileNormals>(std::move(normals->file)) : normals.error();
}

Status rewrite_gltf(const Source& source, const std::filesystem::path& folder, Pose pose,
                    std::span<const Vec3> positions, std::span<const Vec3> normals,
                    const std::filesystem::path& out) {
  const bool is_glb = source.bytes.starts_with("glTF");
  const bool changes_container =
      format_of_name(out) == MeshFormat::gltf && is_glb == is_gltf_json_name(out);
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  const Result<GltfScene> scene = read_gltf_scene(*document, pose);
  if (!scene) {
    return scene.error();
  }
  const auto mismatch = [&](std::string_view noun, std::size_t in_file, std::size_t given) {
    return source.error("has " + counted(in_file, noun) + ", but " + std::to_string(given) +
                            " are to be written; check that this is the model they were made from",
                        ErrorCode::mismatch);
  };
  if (scene->mesh.positions.size() != positions.size()) {
    return mismatch("vertex", scene->mesh.positions.size(), positions.size());
  }
  GltfNormals stored;
  if (!normals.empty()) {
    Result<GltfNormals> read = normals_of(*document, *scene);
    if (!read) {
      return read.error();
    }
    stored = *std::move(read);
    if (stored.file.normals.size() != normals.size()) {
      return mismatch("normal", stored.file.normals.size(), normals.size());
    }
  }
  Plan plan(*document);
  if (Status status = plan.make(*scene, positions, normals.empty() ? nullptr : &stored, normals);
      !status) {
    return status;
  }
  Editor editor(*document, plan);
  if (Status status = editor.carry_out(); !status) {
    return status;
  }
  const Result<BufferFiles> files = place_buffers(*document, editor, out, changes_container);
  if (!files) {
    return files.error();
  }
  const std::string json = editor.take_json();
  if (Status status = document->replace_json(json); !status) {
    return status;
  }
  if (Status status = check_result(*document, *scene, positions, pose); !status) {
    return status;
  }
  if (changes_container) {
    const Result<std::string> bytes = is_glb ? as_json(*document) : as_glb(*document);
    return bytes ? write_file_atomically(out, *bytes) : bytes.error();
  }
  return write_all(*document, json, *files, out);
}

} // namespace cagewright
