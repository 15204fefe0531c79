#include "io/gltf_document.h"

#include "io/binary.h"
#include "io/uri.h"

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

constexpr std::size_t largest_json = std::size_t{128} << 20U; // grows tenfold and more when parsed
constexpr std::size_t deepest_json = 64;                      // glTF itself needs about ten levels

const Json& null() {
  static const Json value;
  return value;
}

// The parser nests no calls, but what it makes is destroyed level by level.
bool is_too_deep(std::string_view text) {
  std::size_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      i += c == '\\' ? 1 : 0;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > deepest_json) {
        return true;
      }
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
  return false;
}

struct Container {
  std::string_view json;
  std::string_view binary;
  std::vector<GltfDocument::Chunk> chunks;
};

// The byte order mark of UTF-8, which editors put in front.
std::string_view without_mark(std::string_view text) {
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
}

constexpr std::string_view binary_type("BIN\0", 4);

// Chunks begin at multiples of four, and their lengths say so. Some writers pad without counting
// the padding, others neither pad nor count.
std::size_t begin_of_chunk(std::string_view bytes, std::size_t at) {
  const auto is_known = [&](std::size_t begin) {
    const std::string_view type = bytes.substr(std::min(begin + 4, bytes.size()), 4);
    return type == "JSON" || type == binary_type;
  };
  const std::size_t padded = (at + 3) / 4 * 4;
  return padded + 8 <= bytes.size() && !is_known(at) && is_known(padded) ? padded : at;
}

// GLB: "glTF", version, length; then chunks of length, type and content.
Result<Container> open_container(const Source& source) {
  const std::string_view bytes = source.bytes;
  if (!bytes.starts_with("glTF")) {
    return Container{without_mark(bytes), {}, {}};
  }
  if (bytes.size() < 20) {
    return source.error_at_byte(bytes.size(), "the file ends within the GLB header; it is cut "
                                              "short" +
                                                  std::string(export_again));
  }
  const auto version = load<std::uint32_t>(&bytes[4]);
  if (version != 2) {
    return source.error_at_byte(
        4, "this is GLB version " + std::to_string(version) + "; export the model as glTF 2.0",
        ErrorCode::unsupported);
  }
  const auto length = load<std::uint32_t>(&bytes[8]);
  if (length > bytes.size()) {
    return source.error_at_byte(8, "the header promises " + std::to_string(length) +
                                       " bytes, but the file has " + std::to_string(bytes.size()) +
                                       "; it is cut short" + std::string(export_again));
  }
  Container container;
  for (std::size_t at = 12; at + 8 <= length;) {
    at = begin_of_chunk(bytes.substr(0, length), at);
    const auto size = load<std::uint32_t>(&bytes[at]);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (size > length - at - 8) {
      return source.error_at_byte(at, "a chunk of " + std::to_string(size) +
                                          " bytes reaches beyond the end of the file; it is cut "
                                          "short" +
                                          std::string(export_again));
    }
    const std::string_view content = bytes.substr(at + 8, size);
    if (type == "JSON" && container.json.empty()) {
      container.json = without_mark(content);
    } else if (type == binary_type && container.binary.empty()) {
      container.binary = content;
    }
    container.chunks.push_back({type, content});
    at += 8 + size;
  }
  return container;
}

Result<Json> parse(const Source& source, std::string_view text) {
  const std::size_t begin =
      text.empty() ? 0 : static_cast<std::size_t>(text.data() - source.bytes.data());
  if (text.size() > largest_json) {
    return source.error("has " + std::to_string(text.size()) +
                            " bytes of JSON, too much to parse; save the model as GLB",
                        ErrorCode::too_large);
  }
  if (is_too_deep(text)) {
    return source.error("the JSON is nested too deeply for glTF" + std::string(export_again));
  }
  try {
    Json json = Json::parse(text);
    if (json.is_object()) {
      return json;
    }
  } catch (const Json::parse_error& error) {
    return source.error_at_byte(begin + (error.byte > 0 ? error.byte - 1 : 0),
                                "the JSON is not valid here" + std::string(export_again));
  } catch (const Json::exception&) { // a number beyond the range of double
    return source.error("the JSON holds a number that is too large" + std::string(export_again));
  }
  return source.error_at_byte(begin, "the JSON is no object" + std::string(export_again));
}

Status check_version(const Source& source, const Json& json) {
  const std::string version = to_text(member(member(json, "asset"), "version"));
  if (version.starts_with("2.")) {
    return success();
  }
  if (version.empty()) {
    return source.error("has no glTF version; check that this is a glTF file");
  }
  return source.error("this is glTF version " + one_line(version, 20) +
                          "; export the model as glTF 2.0",
                      ErrorCode::unsupported);
}

// Extensions without which the triangles are not what the file shows. Others, on materials and
// textures, do not matter here.
Status check_extensions(const Source& source, const Json& json) {
  struct Known {
    std::string_view name;
    std::string_view remedy;
  };
  constexpr Known refused[] = {
      {"KHR_draco_mesh_compression", "export the model without compression"},
      {"EXT_meshopt_compression", "export the model without compression"},
      {"KHR_meshopt_compression", "export the model without compression"},
      {"EXT_mesh_gpu_instancing", "export the instances as nodes"},
  };
  const Json& required = member(json, "extensionsRequired");
  for (std::size_t i = 0; required.is_array() && i < required.size(); ++i) {
    const std::string name = to_text(required[i]);
    for (const Known& extension : refused) {
      if (name == extension.name) {
        return source.error("needs the extension " + name + ", which is not supported; " +
                                std::string(extension.remedy),
                            ErrorCode::unsupported);
      }
    }
  }
  return success();
}

// Sizes and places are whole numbers from 0, where they are given at all.
Status check_places(const Source& source, const Json& json) {
  for (const char* list : {"accessors", "bufferViews", "buffers"}) {
    const Json& items = member(json, list);
    for (std::size_t i = 0; items.is_array() && i < items.size(); ++i) {
      for (const char* name : {"byteOffset", "byteLength", "byteStride", "buffer"}) {
        const Json& number = member(items[i], name);
        if (!number.is_null() && !to_size(number)) {
          return source.error(std::string(list) + '[' + std::to_string(i) + "]: '" + name +
                              "' is no whole number from 0" + std::string(export_again));
        }
      }
    }
  }
  return success();
}

// glTF's numbers for the types of components.
enum class Component : std::uint16_t {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126,
};

std::optional<Component> component_of(const Json& value) {
  const std::size_t number = to_size(value).value_or(0);
  return (number >= 5120 && number <= 5123) || number == 5125 || number == 5126
             ? std::optional(static_cast<Component>(number))
             : std::nullopt;
}

std::size_t size_of(Component type) {
  switch (type) {
  case Component::int8:
  case Component::uint8:
    return 1;
  case Component::int16:
  case Component::uint16:
    return 2;
  case Component::uint32:
  case Component::float32:
    return 4;
  }
  return 4;
}

bool is_index_type(Component type) {
  return type == Component::uint8 || type == Component::uint16 || type == Component::uint32;
}

double load_component(const char* from, Component type, bool normalized) {
  // Signed fractions: the lowest value stands for -1, as the next one does (glTF 2.0, 3.11).
  switch (type) {
  case Component::int8: {
    const double value = load<std::int8_t>(from);
    return normalized ? std::max(value / 127, -1.0) : value;
  }
  case Component::uint8:
    return load<std::uint8_t>(from) / (normalized ? 255.0 : 1.0);
  case Component::int16: {
    const double value = load<std::int16_t>(from);
    return normalized ? std::max(value / 32767, -1.0) : value;
  }
  case Component::uint16:
    return load<std::uint16_t>(from) / (normalized ? 65535.0 : 1.0);
  case Component::uint32:
    return load<std::uint32_t>(from);
  case Component::float32:
    return load<float>(from);
  }
  return 0;
}

std::uint32_t load_index(const char* from, Component type) {
  return type == Component::uint8    ? load<std::uint8_t>(from)
         : type == Component::uint16 ? load<std::uint16_t>(from)
                                     : load<std::uint32_t>(from);
}

std::size_t components_of(const std::string& type) {
  return type == "SCALAR" ? 1
         : type == "VEC2" ? 2
         : type == "VEC3" ? 3
         : type == "VEC4" ? 4
         : type == "MAT4" ? 16
                          : 0;
}

std::string numbered(std::string_view what, std::size_t index) {
  return std::string(what) + ' ' + std::to_string(index);
}

} // namespace

const Json& member(const Json& object, const char* key) {
  if (!object.is_object()) {
    return null();
  }
  const auto found = object.find(key);
  return found != object.end() ? *found : null();
}

const Json& element(const Json& array, std::size_t index) {
  return array.is_array() && index < array.size() ? array[index] : null();
}

std::optional<std::size_t> to_size(const Json& value) {
  if (!value.is_number()) {
    return std::nullopt;
  }
  const auto number = value.get<double>();
  constexpr double largest = sizeof(std::size_t) > 4 ? 0x1p53 : 0x1p32 - 1;
  if (!(number >= 0 && number <= largest) || number != std::floor(number)) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(number);
}

std::string to_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

struct GltfDocument::Layout {
  std::size_t count = 0; // elements
  std::size_t components = 0;
  Component type = Component::float32;
  bool normalized = false;

  [[nodiscard]] std::size_t element_size() const { return components * size_of(type); }
};

Result<GltfDocument> GltfDocument::open(const Source& source,
                                        std::optional<std::filesystem::path> folder) {
  const Result<Container> container = open_container(source);
  if (!container) {
    return container.error();
  }
  Result<Json> json = parse(source, container->json);
  if (!json) {
    return json.error();
  }
  if (const Status status = check_version(source, *json); !status) {
    return status.error();
  }
  if (const Status status = check_extensions(source, *json); !status) {
    return status.error();
  }
  if (const Status status = check_places(source, *json); !status) {
    return status.error();
  }
  GltfDocument document;
  document.source_ = source;
  document.folder_ = std::move(folder);
  document.json_ = *std::move(json);
  document.json_text_ = container->json;
  document.binary_chunk_ = container->binary;
  document.chunks_ = container->chunks;
  const Json& buffers = member(document.json_, "buffers");
  document.loaded_.resize(buffers.is_array() ? buffers.size() : 0);
  return document;
}

Result<std::string_view> GltfDocument::buffer(std::size_t index) {
  const std::string where = numbered("buffer", index);
  const Json& description = element(member(json_, "buffers"), index);
  if (!description.is_object()) {
    return source_.error(where + " does not exist" + std::string(export_again));
  }
  const std::size_t length = to_size(member(description, "byteLength")).value_or(0);
  std::string_view bytes = binary_chunk_;
  if (!is_binary_chunk(index) || loaded_[index]) {
    if (!loaded_[index]) {
      Result<std::string> loaded = load_buffer(description, where);
      if (!loaded) {
        return loaded.error();
      }
      loaded_[index] = *std::move(loaded);
    }
    bytes = *loaded_[index];
  }
  return bytes.substr(0, length); // or what there is: it may be enough
}

bool GltfDocument::is_binary_chunk(std::size_t buffer) const {
  return buffer == 0 && !member(element(member(json_, "buffers"), buffer), "uri").is_string();
}

std::optional<std::filesystem::path> GltfDocument::file_of_buffer(std::size_t buffer) const {
  const std::string uri = to_text(member(element(member(json_, "buffers"), buffer), "uri"));
  return uri.empty() || is_data_uri(uri) ? std::nullopt : file_of_uri(uri);
}

std::string& GltfDocument::changeable_buffer(std::size_t index) {
  if (!loaded_[index]) {
    loaded_[index] = is_binary_chunk(index) ? std::string(binary_chunk_) : std::string();
  }
  return *loaded_[index];
}

Result<std::optional<GltfDocument::Place>> GltfDocument::place_of(std::size_t index,
                                                                  std::size_t components) {
  const std::string where = numbered("accessor", index);
  const Json& accessor = element(member(json_, "accessors"), index);
  const Result<Layout> layout = layout_of(accessor, components, where);
  if (!layout) {
    return layout.error();
  }
  const Json& view_index = member(accessor, "bufferView");
  if (layout->type != Component::float32 || !member(accessor, "sparse").is_null() ||
      view_index.is_null()) {
    return std::optional<Place>();
  }
  const std::size_t offset = to_size(member(accessor, "byteOffset")).value_or(0);
  const Result<Slice> from = slice(view_index, offset, *layout, true, where);
  if (!from) {
    return from.error();
  }
  const Json& view = element(member(json_, "bufferViews"), to_size(view_index).value_or(0));
  const Place place{to_size(member(view, "buffer")).value_or(0),
                    to_size(member(view, "byteOffset")).value_or(0) + offset, from->stride,
                    layout->count};
  return shares_bytes(index, place, layout->element_size()) ? std::optional<Place>()
                                                            : std::optional(place);
}

// Whether another accessor holds some of the bytes of this one. Interleaved attributes of one
// stride may lie between each other; of different strides they count as one piece each.
bool GltfDocument::shares_bytes(std::size_t accessor, const Place& place, std::size_t size) const {
  const std::size_t end =
      place.count == 0 ? place.begin : place.begin + (place.count - 1) * place.stride + size;
  const Json& accessors = member(json_, "accessors");
  const auto touches = [&](const Json& view, std::size_t offset, const Layout& layout) {
    if (layout.count == 0 || to_size(member(view, "buffer")) != place.buffer) {
      return false;
    }
    const std::size_t stride = to_size(member(view, "byteStride")).value_or(layout.element_size());
    const std::size_t from = to_size(member(view, "byteOffset")).value_or(0) + offset;
    if (from >= end) {
      return false;
    }
    const std::size_t reach = end - from; // of interest
    const bool ends_before =
        (layout.count - 1) <= reach / std::max<std::size_t>(stride, 1) &&
        from + (layout.count - 1) * stride + layout.element_size() <= place.begin;
    if (ends_before) {
      return false;
    }
    if (stride != place.stride || stride == 0) {
      return true;
    }
    // Places within one stride, of which either may reach over its end.
    const std::size_t shift = (from % stride + stride - place.begin % stride) % stride;
    return shift < size || shift + layout.element_size() > stride;
  };
  for (std::size_t a = 0; accessors.is_array() && a < accessors.size(); ++a) {
    const Json& other = accessors[a];
    const auto view_of = [&](const Json& user) -> const Json& {
      return element(member(json_, "bufferViews"),
                     to_size(member(user, "bufferView")).value_or(~std::size_t{0}));
    };
    const std::optional<std::size_t> count = to_size(member(other, "count"));
    const std::optional<Component> type = component_of(member(other, "componentType"));
    const std::size_t components = components_of(to_text(member(other, "type")));
    if (!count || !type) {
      continue;
    }
    if (a != accessor && touches(view_of(other), to_size(member(other, "byteOffset")).value_or(0),
                                 Layout{*count, components, *type, false})) {
      return true;
    }
    const Json& sparse = member(other, "sparse");
    const std::optional<std::size_t> few = to_size(member(sparse, "count"));
    const Json& indices = member(sparse, "indices");
    const Json& values = member(sparse, "values");
    const std::optional<Component> index_type = component_of(member(indices, "componentType"));
    if (few && index_type &&
        (touches(view_of(indices), to_size(member(indices, "byteOffset")).value_or(0),
                 Layout{*few, 1, *index_type, false}) ||
         touches(view_of(values), to_size(member(values, "byteOffset")).value_or(0),
                 Layout{*few, components, *type, false}))) {
      return true;
    }
  }
  return false;
}

Status GltfDocument::replace_json(std::string_view text) {
  Result<Json> json = parse(source_, text);
  if (!json) {
    return json.error();
  }
  json_ = *std::move(json);
  loaded_.resize(std::max(loaded_.size(), member(json_, "buffers").size()));
  return success();
}

Result<std::string> GltfDocument::load_buffer(const Json& buffer, const std::string& where) {
  const std::string uri = to_text(member(buffer, "uri"));
  if (uri.empty()) {
    return source_.error(where + " has no data" + std::string(export_again));
  }
  if (is_data_uri(uri)) {
    std::optional<std::string> bytes = decode_data_uri(uri);
    return bytes ? Result<std::string>(*std::move(bytes))
                 : source_.error(where + " is not valid base64" + std::string(export_again));
  }
  return load_file(uri, where);
}

// A URI, but exporters also write names as they are, and those of Windows with its separators.
Result<std::string> GltfDocument::load_file(const std::string& uri, const std::string& where) {
  const std::optional<std::filesystem::path> path = file_of_uri(uri);
  if (!path) {
    return source_.error(where + " is kept at " + in_quotes(uri) +
                             ", which cannot be reached; save the model as GLB",
                         ErrorCode::unsupported);
  }
  const Result<FileBytes> file = read_file(*path);
  if (!file) {
    return Error{file.error().code, source_.error(where + ": " + file.error().message).message};
  }
  return std::string(file->view());
}

std::optional<std::filesystem::path> GltfDocument::file_of_uri(const std::string& uri) const {
  const std::filesystem::path decoded = decode_percent(uri);
  if (!folder_ || uri.find("://") != uri.npos || decoded.is_absolute() ||
      decoded.native().find('\0') != std::string::npos) {
    return std::nullopt;
  }
  std::string slashes = decoded.string();
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code ignored;
  for (const std::filesystem::path& name :
       {decoded, std::filesystem::path(uri), std::filesystem::path(slashes)}) {
    if (name.is_relative() && std::filesystem::exists(*folder_ / name, ignored)) {
      return *folder_ / name;
    }
  }
  return *folder_ / decoded;
}

Result<GltfDocument::Layout> GltfDocument::layout_of(const Json& accessor, std::size_t components,
                                                     const std::string& where) const {
  const std::optional<std::size_t> count = to_size(member(accessor, "count"));
  const std::optional<Component> type = component_of(member(accessor, "componentType"));
  if (!count || !type) {
    return source_.error(where + " has no count or no known component type" +
                         std::string(export_again));
  }
  if (components_of(to_text(member(accessor, "type"))) != components) {
    return source_.error(where + " should have " + counted(components, "number") +
                         " for each element" + std::string(export_again));
  }
  const Json& normalized = member(accessor, "normalized");
  return Layout{*count, components, *type, normalized.is_boolean() && normalized.get<bool>()};
}

Result<GltfDocument::Slice> GltfDocument::slice(const Json& view_index, std::size_t offset,
                                                const Layout& layout, bool may_interleave,
                                                const std::string& where) {
  const std::optional<std::size_t> index = to_size(view_index);
  const Json& view = element(member(json_, "bufferViews"), index.value_or(~std::size_t{0}));
  const std::optional<std::size_t> buffer_index = to_size(member(view, "buffer"));
  if (!buffer_index) {
    return source_.error(where + " refers to a buffer view that does not exist" +
                         std::string(export_again));
  }
  const Json& extensions = member(view, "extensions");
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    if (!member(extensions, name).is_null()) {
      return source_.error(where + " is compressed by the extension " + std::string(name) +
                               ", which is not supported; export the model without compression",
                           ErrorCode::unsupported);
    }
  }
  const Result<std::string_view> bytes = buffer(*buffer_index);
  if (!bytes) {
    return bytes.error();
  }
  const std::size_t begin = to_size(member(view, "byteOffset")).value_or(0);
  const std::size_t length = to_size(member(view, "byteLength")).value_or(0);
  const std::size_t stride =
      may_interleave ? to_size(member(view, "byteStride")).value_or(layout.element_size())
                     : layout.element_size();
  // Each comparison is such that none of the numbers, up to 2^53, can overflow.
  const bool fits = begin <= bytes->size() && length <= bytes->size() - begin && offset <= length &&
                    stride >= layout.element_size() &&
                    (layout.count == 0 ||
                     (layout.element_size() <= length - offset &&
                      (layout.count - 1) <= (length - offset - layout.element_size()) / stride));
  const std::size_t promised =
      to_size(member(element(member(json_, "buffers"), *buffer_index), "byteLength")).value_or(0);
  if (!fits && bytes->size() < promised) {
    return source_.error(numbered("buffer", *buffer_index) + " should have " +
                         std::to_string(promised) + " bytes, but has " +
                         std::to_string(bytes->size()) + std::string(export_again));
  }
  if (!fits) {
    return source_.error(where + " with " + counted(layout.count, "element") +
                         " reaches beyond its buffer" + std::string(export_again));
  }
  return Slice{bytes->substr(begin + offset, length - offset), stride};
}

Result<std::vector<double>> GltfDocument::read_vectors(std::size_t index, std::size_t components) {
  const std::string where = numbered("accessor", index);
  const Json& accessor = element(member(json_, "accessors"), index);
  const Result<Layout> layout = layout_of(accessor, components, where);
  if (!layout) {
    return layout.error();
  }
  std::vector<double> values;
  const Json& view = member(accessor, "bufferView");
  if (!view.is_null()) {
    const std::size_t offset = to_size(member(accessor, "byteOffset")).value_or(0);
    const Result<Slice> from = slice(view, offset, *layout, true, where);
    if (!from) {
      return from.error();
    }
    values.reserve(layout->count * components);
    for (std::size_t i = 0; i < layout->count; ++i) {
      for (std::size_t c = 0; c < components; ++c) {
        values.push_back(
            load_component(from->bytes.data() + i * from->stride + c * size_of(layout->type),
                           layout->type, layout->normalized));
      }
    }
  } else if (layout->count > source_.bytes.size()) {
    // Zeros that are not stored: no more of them than the file has bytes.
    return source_.error(where + " promises " + counted(layout->count, "element") +
                         " but stores none" + std::string(export_again));
  } else {
    values.resize(layout->count * components);
  }
  const Json& sparse = member(accessor, "sparse");
  if (!sparse.is_null()) {
    if (const Status status = apply_sparse(sparse, *layout, where, values); !status) {
      return status.error();
    }
  }
  return values;
}

Status GltfDocument::apply_sparse(const Json& sparse, const Layout& layout,
                                  const std::string& where, std::vector<double>& values) {
  const Json& indices = member(sparse, "indices");
  const Json& replacements = member(sparse, "values");
  const std::optional<std::size_t> count = to_size(member(sparse, "count"));
  const std::optional<Component> type = component_of(member(indices, "componentType"));
  if (!count || !type || !is_index_type(*type)) {
    return source_.error(where + " has sparse values without a count or type of index" +
                         std::string(export_again));
  }
  const Result<Slice> at =
      slice(member(indices, "bufferView"), to_size(member(indices, "byteOffset")).value_or(0),
            Layout{*count, 1, *type, false}, false, where);
  if (!at) {
    return at.error();
  }
  const Result<Slice> from = slice(
      member(replacements, "bufferView"), to_size(member(replacements, "byteOffset")).value_or(0),
      Layout{*count, layout.components, layout.type, false}, false, where);
  if (!from) {
    return from.error();
  }
  for (std::size_t i = 0; i < *count; ++i) {
    const std::size_t target = load_index(at->bytes.data() + i * at->stride, *type);
    if (target >= layout.count) {
      return source_.error(where + " replaces element " + std::to_string(target) +
                           ", but there are " + std::to_string(layout.count) +
                           std::string(export_again));
    }
    for (std::size_t c = 0; c < layout.components; ++c) {
      values[target * layout.components + c] =
          load_component(from->bytes.data() + i * from->stride + c * size_of(layout.type),
                         layout.type, layout.normalized);
    }
  }
  return success();
}

Result<std::vector<std::uint32_t>> GltfDocument::read_indices(std::size_t index) {
  const std::string where = numbered("accessor", index);
  const Json& accessor = element(member(json_, "accessors"), index);
  const Result<Layout> layout = layout_of(accessor, 1, where);
  if (!layout) {
    return layout.error();
  }
  if (!is_index_type(layout->type)) {
    return source_.error(where + " holds indices of a type that glTF does not allow" +
                         std::string(export_again));
  }
  if (!member(accessor, "sparse").is_null()) {
    return source_.error(where + " holds sparse indices, which are not supported; export the "
                                 "model without them",
                         ErrorCode::unsupported);
  }
  const Result<Slice> from =
      slice(member(accessor, "bufferView"), to_size(member(accessor, "byteOffset")).value_or(0),
            *layout, true, where);
  if (!from) {
    return from.error();
  }
  std::vector<std::uint32_t> indices(layout->count);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    indices[i] = load_index(from->bytes.data() + i * from->stride, layout->type);
  }
  return indices;
}

} // namespace cagewright
