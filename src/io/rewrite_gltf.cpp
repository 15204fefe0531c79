#include "io/rewrite_gltf.h"

#include "io/atomic_file.h"
#include "io/binary.h"
#include "io/gltf_scene.h"
#include "io/number_text.h"
#include "io/uri.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// A value in a JSON text: its bytes are [begin, end).
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Finds values in a text that the parser has accepted.
class JsonText {
public:
  explicit JsonText(std::string_view text) : text_(text) {}

  [[nodiscard]] Span whole() const { return {blanks(0), text_.size()}; }

  /// The member of the object that begins at `object`; of several of one name the last, as the
  /// parser takes it.
  [[nodiscard]] std::optional<Span> member(Span object, std::string_view name) const {
    std::optional<Span> found;
    std::size_t at = blanks(object.begin + 1);
    while (at < text_.size() && text_[at] == '"') {
      const std::size_t key_end = end_of_string(at);
      const std::string_view key = text_.substr(at + 1, key_end - at - 2);
      const std::size_t begin = blanks(blanks(key_end) + 1); // past the colon
      const std::size_t end = end_of_value(begin);
      if (key == name) {
        found = Span{begin, end};
      }
      at = next_item(end);
    }
    return found;
  }

  /// An element of the array that begins at `array`.
  [[nodiscard]] std::optional<Span> element(Span array, std::size_t index) const {
    std::size_t at = blanks(array.begin + 1);
    for (; at < text_.size() && text_[at] != ']'; --index) {
      const std::size_t end = end_of_value(at);
      if (index == 0) {
        return Span{at, end};
      }
      at = next_item(end);
    }
    return std::nullopt;
  }

  /// text[list][index][name] from the outermost object.
  [[nodiscard]] std::optional<Span> find(std::string_view list, std::size_t index,
                                         std::string_view name) const {
    const std::optional<Span> array = member(whole(), list);
    const std::optional<Span> object = array ? element(*array, index) : std::nullopt;
    return object ? member(*object, name) : std::nullopt;
  }

private:
  [[nodiscard]] std::size_t blanks(std::size_t at) const {
    return std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
  }

  [[nodiscard]] std::size_t next_item(std::size_t end) const {
    const std::size_t at = blanks(end);
    return at < text_.size() && text_[at] == ',' ? blanks(at + 1) : at;
  }

  [[nodiscard]] std::size_t end_of_string(std::size_t at) const {
    for (++at; at < text_.size() && text_[at] != '"'; ++at) {
      at += text_[at] == '\\' ? 1 : 0;
    }
    return std::min(at + 1, text_.size());
  }

  [[nodiscard]] std::size_t end_of_value(std::size_t at) const {
    std::size_t depth = 0;
    while (at < text_.size()) {
      const char c = text_[at];
      if (c == '"') {
        at = end_of_string(at);
      } else if (c == '[' || c == '{') {
        ++depth;
        ++at;
      } else if (c == ']' || c == '}') {
        if (depth == 0) {
          return at;
        }
        --depth;
        ++at;
      } else if (depth == 0 && (c == ',' || c == ' ' || c == '\t' || c == '\r' || c == '\n')) {
        return at;
      } else {
        ++at;
        continue; // within a number or a name
      }
      if (depth == 0) {
        return at;
      }
    }
    return at;
  }

  std::string_view text_;
};

using Float3 = std::array<float, 3>;

Float3 to_floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// The normals of one accessor under one placement.
struct NormalBlock {
  std::size_t placement = 0;
  std::size_t accessor = 0;
  Index base = 0; // of its first normal in FileNormals
};

struct GltfNormals {
  FileNormals file;
  std::vector<NormalBlock> blocks;
};

Vec3 shown_normal(const GltfPlacement& placement, const Vec3& stored) {
  // By the cofactors, which exist for any transform: the inverse transposed but for its scale.
  const Eigen::Matrix3d& m = placement.transform.linear();
  const Vec3 normal = m.col(1).cross(m.col(2)) * stored.x() +
                      m.col(2).cross(m.col(0)) * stored.y() + m.col(0).cross(m.col(1)) * stored.z();
  return (m.determinant() < 0 ? Vec3(-normal) : normal).stableNormalized();
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
      const Result<std::vector<double>> values = document.read_vectors(*shown.normals, 3);
      if (!values) {
        return values.error();
      }
      if (values->size() != 3 * placement.count) {
        return document.source().error("accessor " + std::to_string(*shown.normals) +
                                       " should have a normal for each vertex" +
                                       std::string(export_again));
      }
      for (std::size_t v = 0; v < placement.count; ++v) {
        const Vec3 stored((*values)[3 * v], (*values)[3 * v + 1], (*values)[3 * v + 2]);
        const Vec3 normal = shown_normal(placement, stored);
        result.file.normals.push_back(normal.allFinite() ? normal : Vec3(Vec3::Zero()));
      }
      result.blocks.push_back({shown.placement, *shown.normals, block->second});
    }
    result.file.of_corner.resize(scene.mesh.corners().size(), FileNormals::none);
    for (std::size_t c = shown.first_corner; c < shown.end_corner; ++c) {
      result.file.of_corner[c] = block->second + scene.mesh.corners()[c] - placement.base;
    }
  }
  return result;
}

/// Changes floats in the buffers of a document, and knows which are changed.
class Patcher {
public:
  explicit Patcher(GltfDocument& document) : document_(document) {}

  /// Gives elements of an accessor other values: all at once, each at most one value.
  Status set(std::size_t accessor, std::size_t components,
             const std::map<std::size_t, Float3>& values) {
    const Result<GltfDocument::Place> place = document_.place_of(accessor, components);
    if (!place) {
      return place.error();
    }
    std::string& bytes = document_.changeable_buffer(place->buffer);
    for (const auto& [element, value] : values) {
      for (std::size_t i = 0; i < 3; ++i) {
        auto stored = std::bit_cast<std::array<char, 4>>(value[i]);
        if (std::endian::native == std::endian::big) {
          std::reverse(stored.begin(), stored.end());
        }
        std::copy(stored.begin(), stored.end(),
                  bytes.begin() +
                      static_cast<std::ptrdiff_t>(place->begin + element * place->stride + 4 * i));
      }
    }
    buffers.insert(place->buffer);
    accessors.insert(accessor);
    return success();
  }

  std::set<std::size_t> buffers;
  std::set<std::size_t> accessors;

private:
  GltfDocument& document_;
};

/// New values for the elements of accessors, which several placements may share.
using Changes = std::map<std::size_t, std::map<std::size_t, Float3>>;

bool equal_but_for_rounding(const Float3& a, const Float3& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float size = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2]), 1e-30F});
    if (!(std::abs(a[i] - b[i]) <= 4e-6F * size)) {
      return false;
    }
  }
  return true;
}

Error shared(const Source& source, const GltfScene& scene, std::size_t accessor) {
  std::string nodes;
  for (const GltfPlacement& placement : scene.placements) {
    if (placement.positions == accessor) {
      nodes.append(nodes.empty() ? "" : ", ").append(std::to_string(placement.node));
    }
  }
  return source.error("the nodes " + nodes +
                          " show the same mesh, which cannot have several shapes; give each node a "
                          "mesh of its own (in Blender: Object, Relations, Make Single User), or "
                          "write OBJ",
                      ErrorCode::unsupported);
}

Result<Changes> moved_positions(GltfDocument& document, const GltfScene& scene,
                                std::span<const Vec3> positions) {
  Changes changes;
  for (const GltfPlacement& placement : scene.placements) {
    const Result<std::vector<double>> stored = document.read_vectors(placement.positions, 3);
    if (!stored) {
      return stored.error();
    }
    const Eigen::Affine3d& transform = placement.transform;
    const bool can_invert = std::abs(transform.linear().determinant()) > 0;
    const Eigen::Affine3d inverse = can_invert ? transform.inverse() : transform;
    bool any = false;
    std::vector<Float3> values;
    for (std::size_t v = 0; v < placement.count; ++v) {
      const Vec3& to = positions[placement.base + v];
      const bool stays = to == scene.mesh.positions[placement.base + v];
      any = any || !stays;
      values.push_back(
          stays ? to_floats({(*stored)[3 * v], (*stored)[3 * v + 1], (*stored)[3 * v + 2]})
                : to_floats(inverse * to));
    }
    if (any && !(can_invert && inverse.matrix().allFinite())) {
      return document.source().error("node " + std::to_string(placement.node) +
                                         " flattens its mesh, which cannot be changed in place; "
                                         "apply the scale first, or write OBJ",
                                     ErrorCode::unsupported);
    }
    const auto known = changes.find(placement.positions);
    if (known != changes.end()) {
      for (std::size_t v = 0; v < placement.count; ++v) {
        if (!equal_but_for_rounding(known->second[v], values[v])) {
          return shared(document.source(), scene, placement.positions);
        }
      }
      continue;
    }
    std::map<std::size_t, Float3>& own = changes[placement.positions];
    for (std::size_t v = 0; v < placement.count; ++v) {
      own.emplace_hint(own.end(), v, values[v]);
    }
  }
  // What is as it was needs no place of its own: it may be compressed or shared.
  for (auto change = changes.begin(); change != changes.end();) {
    const Result<std::vector<double>> stored = document.read_vectors(change->first, 3);
    if (!stored) {
      return stored.error();
    }
    std::erase_if(change->second, [&](const auto& item) {
      const auto& [v, value] = item;
      return value == to_floats({(*stored)[3 * v], (*stored)[3 * v + 1], (*stored)[3 * v + 2]});
    });
    change = change->second.empty() ? changes.erase(change) : std::next(change);
  }
  return changes;
}

/// Normals that have turned, and the tangents beside them.
Result<Changes> turned_normals(GltfDocument& document, const GltfScene& scene,
                               const GltfNormals& stored, std::span<const Vec3> normals,
                               Changes& tangents) {
  Changes changes;
  for (const NormalBlock& block : stored.blocks) {
    const GltfPlacement& placement = scene.placements[block.placement];
    const Result<std::vector<double>> values = document.read_vectors(block.accessor, 3);
    if (!values) {
      return values.error();
    }
    std::optional<std::size_t> tangent;
    for (const GltfShown& shown : scene.shown) {
      if (shown.placement == block.placement && shown.normals == block.accessor && shown.tangents) {
        tangent = shown.tangents;
      }
    }
    std::vector<double> along;
    if (tangent) {
      Result<std::vector<double>> read = document.read_vectors(*tangent, 4);
      if (!read) {
        return read.error();
      }
      along = *std::move(read);
    }
    for (std::size_t v = 0; v < placement.count; ++v) {
      const Vec3& before = stored.file.normals[block.base + v];
      const Vec3& after = normals[block.base + v];
      if ((after - before).norm() < 1e-7) {
        continue;
      }
      const Vec3 local = (placement.transform.linear().transpose() * after).stableNormalized();
      changes[block.accessor][v] = to_floats(local);
      if (4 * v + 3 < along.size()) {
        const Vec3 from(Vec3((*values)[3 * v], (*values)[3 * v + 1], (*values)[3 * v + 2]));
        const auto turn = Eigen::Quaterniond::FromTwoVectors(from, local);
        const Vec3 turned = turn * Vec3(along[4 * v], along[4 * v + 1], along[4 * v + 2]);
        if (turned.allFinite()) {
          tangents[*tangent][v] = to_floats(turned);
        }
      }
    }
  }
  return changes;
}

/// The list of three or four numbers with the least or the greatest of each component.
std::string bounds_text(const std::vector<double>& values, bool greatest) {
  std::string text(1, '[');
  for (std::size_t i = 0; i < 3; ++i) {
    double bound = values[i];
    for (std::size_t k = i; k < values.size(); k += 3) {
      bound = greatest ? std::max(bound, values[k]) : std::min(bound, values[k]);
    }
    text.append(i > 0 ? 1 : 0, ',');
    append_number(text, static_cast<float>(bound));
  }
  text.push_back(']');
  return text;
}

struct Replacement {
  Span at;
  std::string text;
};

/// The JSON with other bounds and URIs.
class JsonPatch {
public:
  explicit JsonPatch(std::string_view text) : text_(text), finder_(text) {}

  void replace(std::string_view list, std::size_t index, std::string_view name, std::string value) {
    if (const std::optional<Span> at = finder_.find(list, index, name)) {
      replacements_.push_back({*at, std::move(value)});
    }
  }

  [[nodiscard]] std::string take() && {
    std::sort(replacements_.begin(), replacements_.end(),
              [](const Replacement& a, const Replacement& b) { return a.at.begin < b.at.begin; });
    std::string result;
    std::size_t copied = 0;
    for (const Replacement& replacement : replacements_) {
      result.append(text_.substr(copied, replacement.at.begin - copied));
      result.append(replacement.text);
      copied = replacement.at.end;
    }
    return result.append(text_.substr(copied));
  }

private:
  std::string_view text_;
  JsonText finder_;
  std::vector<Replacement> replacements_;
};

void store_size(std::string& bytes, std::size_t at, std::size_t size) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[at + i] = static_cast<char>((size >> (8 * i)) & 0xffU);
  }
}

/// The file with another JSON and, in GLB, another binary chunk of the same size.
std::string assemble(const GltfDocument& document, std::string json,
                     std::optional<std::string_view> binary) {
  const std::string_view bytes = document.source().bytes;
  const std::string_view old = document.json_text();
  const auto offset = [&](std::string_view part) {
    return static_cast<std::size_t>(part.data() - bytes.data());
  };
  const bool is_glb = bytes.starts_with("glTF");
  if (is_glb && json.size() != old.size()) { // a chunk is padded with blanks
    json.erase(json.find_last_not_of(" \t\r\n") + 1);
    json.append((4 - json.size() % 4) % 4, ' ');
  }
  std::string result(bytes.substr(0, offset(old)));
  result += json;
  result += bytes.substr(offset(old) + old.size());
  const auto shift =
      static_cast<std::ptrdiff_t>(json.size()) - static_cast<std::ptrdiff_t>(old.size());
  if (is_glb) {
    store_size(result, offset(old) - 8, json.size());
    store_size(result, 8,
               static_cast<std::size_t>(
                   static_cast<std::ptrdiff_t>(load<std::uint32_t>(&bytes[8])) + shift));
  }
  if (binary) {
    const std::string_view chunk = document.binary_chunk();
    auto at = static_cast<std::ptrdiff_t>(offset(chunk));
    at += offset(chunk) > offset(old) ? shift : 0;
    std::copy(binary->begin(), binary->end(), result.begin() + at);
  }
  return result;
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

/// Reads the changed buffers again: accessors that overlap others in other ways than glTF files do
/// would have spoiled each other.
Status check_result(GltfDocument& document, std::span<const Vec3> positions) {
  const Result<GltfScene> scene = read_gltf_scene(document);
  if (!scene) {
    return scene.error();
  }
  double size = 0;
  for (const Vec3& p : positions) {
    size = std::max(size, p.lpNorm<Eigen::Infinity>());
  }
  for (const GltfPlacement& placement : scene->placements) {
    const double around = placement.transform.translation().lpNorm<Eigen::Infinity>();
    for (std::size_t v = placement.base; v < placement.base + placement.count; ++v) {
      const double error = (scene->mesh.positions[v] - positions[v]).lpNorm<Eigen::Infinity>();
      if (!(error <= 1e-5 * std::max(size, around))) {
        return document.source().error("accessor " + std::to_string(placement.positions) +
                                           " overlaps another or is too coarse, and cannot be "
                                           "changed in place; export the model again, or write OBJ",
                                       ErrorCode::unsupported);
      }
    }
  }
  return success();
}

Status write_all(GltfDocument& document, JsonPatch json, const std::set<std::size_t>& changed,
                 const std::filesystem::path& out) {
  const Json& buffers = member(document.json(), "buffers");
  const bool moves_away = !same_folder(document.folder()->native(), out.parent_path());
  std::vector<std::filesystem::path> taken;
  for (std::size_t b = 0; b < buffers.size(); ++b) {
    if (const auto file = document.file_of_buffer(b)) {
      taken.push_back(*file);
    }
  }
  std::optional<std::string_view> binary;
  std::vector<std::pair<std::filesystem::path, std::string_view>> files;
  for (std::size_t b = 0; b < buffers.size(); ++b) {
    const bool is_file = document.file_of_buffer(b).has_value();
    if (changed.count(b) == 0 && !(is_file && moves_away)) {
      continue;
    }
    const Result<std::string_view> bytes = document.bytes_of_buffer(b);
    if (!bytes) {
      return bytes.error();
    }
    if (document.is_binary_chunk(b)) {
      binary = *bytes;
    } else if (is_file) {
      const std::filesystem::path name = free_name(out, taken);
      taken.push_back(name);
      files.emplace_back(name, *bytes);
      json.replace("buffers", b, "uri", Json(encode_percent(name.filename().string())).dump());
    } else {
      const std::string uri = to_text(member(buffers[b], "uri"));
      json.replace("buffers", b, "uri",
                   Json(uri.substr(0, uri.find(',') + 1) + encode_base64(*bytes)).dump());
    }
  }
  for (const auto& [name, bytes] : files) { // first: a file that names them finds them
    if (Status status = write_file_atomically(name, bytes); !status) {
      return status;
    }
  }
  return write_file_atomically(out, assemble(document, std::move(json).take(), binary));
}

} // namespace

Result<FileNormals> read_gltf_normals(const Source& source,
                                      const std::optional<std::filesystem::path>& folder) {
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  const Result<GltfScene> scene = read_gltf_scene(*document);
  if (!scene) {
    return scene.error();
  }
  Result<GltfNormals> normals = normals_of(*document, *scene);
  return normals ? Result<FileNormals>(std::move(normals->file)) : normals.error();
}

Status rewrite_gltf(const Source& source, const std::filesystem::path& folder,
                    std::span<const Vec3> positions, std::span<const Vec3> normals,
                    const std::filesystem::path& out) {
  const bool is_glb = source.bytes.starts_with("glTF");
  const std::string extension = out.extension().string();
  if ((is_glb && extension == ".gltf") || (!is_glb && extension == ".glb")) {
    return source.error(is_glb ? "is GLB, and stays so; name the output .glb"
                               : "is glTF as JSON, and stays so; name the output .gltf",
                        ErrorCode::unsupported);
  }
  Result<GltfDocument> document = GltfDocument::open(source, folder);
  if (!document) {
    return document.error();
  }
  const Result<GltfScene> scene = read_gltf_scene(*document);
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
  const Result<Changes> moved = moved_positions(*document, *scene, positions);
  if (!moved) {
    return moved.error();
  }
  Changes tangents;
  Changes turned;
  if (!normals.empty()) {
    const Result<GltfNormals> stored = normals_of(*document, *scene);
    if (!stored) {
      return stored.error();
    }
    if (stored->file.normals.size() != normals.size()) {
      return mismatch("normal", stored->file.normals.size(), normals.size());
    }
    Result<Changes> changes = turned_normals(*document, *scene, *stored, normals, tangents);
    if (!changes) {
      return changes.error();
    }
    turned = *std::move(changes);
  }
  Patcher patcher(*document);
  for (const auto& [changes, components] :
       {std::pair<const Changes*, std::size_t>{&*moved, 3}, {&turned, 3}, {&tangents, 4}}) {
    for (const auto& [accessor, values] : *changes) {
      if (Status status = patcher.set(accessor, components, values); !status) {
        return status;
      }
    }
  }
  if (Status status = check_result(*document, positions); !status) {
    return status;
  }
  JsonPatch json(document->json_text());
  for (const std::size_t accessor : patcher.accessors) {
    if (tangents.count(accessor) != 0) {
      continue; // their bounds are not asked for, and seldom given
    }
    const Result<std::vector<double>> values = document->read_vectors(accessor, 3);
    if (!values) {
      return values.error();
    }
    json.replace("accessors", accessor, "min", bounds_text(*values, false));
    json.replace("accessors", accessor, "max", bounds_text(*values, true));
  }
  return write_all(*document, std::move(json), patcher.buffers, out);
}

} // namespace cagewright
