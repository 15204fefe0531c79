#include <cagewright/io/rewrite_positions.h>

#include "io/atomic_file.h"
#include "io/binary.h"
#include "io/number_text.h"
#include "io/off_header.h"
#include "io/off_text.h"
#include "io/ply_values.h"
#include "io/readers.h"
#include "io/rewrite_gltf.h"
#include "io/rewrite_obj.h"
#include "io/stl_text.h"
#include "io/text_copy.h"
#include "io/text_cursor.h"
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/write_mesh.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

struct Geometry {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals; // or none
};

// All of the following are called with a file that the reader has accepted, and with as many
// positions as it gave.

bool has_three_numbers(TextCursor cursor) {
  for (int i = 0; i < 3; ++i) {
    cursor.skip_blanks();
    if (!cursor.any_number()) {
      return false;
    }
  }
  return true;
}

/// From behind the first word of an OFF file to the first vertex. Returns the number of vertices.
std::size_t skip_off_counts(TextCursor& cursor, const OffHeader& header) {
  if (header.has_size) {
    cursor.next_word_of_file();
    cursor.integer();
  }
  cursor.next_word_of_file();
  const auto vertices = static_cast<std::size_t>(cursor.integer().value_or(0));
  cursor.next_word_of_file();
  cursor.integer();
  skip_off_edges(cursor);
  cursor.skip_blanks();
  if (!cursor.at_line_end()) {
    cursor.integer(); // edges
  }
  return vertices;
}

void skip_number(TextCursor& cursor) {
  cursor.skip_blanks();
  cursor.any_number();
}

std::string rewrite_off_text(const Source& source, TextCursor cursor, const OffHeader& header,
                             const Geometry& geometry) {
  TextCopy copy(source);
  const std::size_t vertices = skip_off_counts(cursor, header);
  const OffLayout layout = off_layout(cursor, header, vertices);
  for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
    cursor.next_word_of_file();
    copy.replace_numbers(cursor, geometry.positions[v]);
    std::size_t at = 3;
    if (header.has_weight) { // the position is x / w, y / w, z / w
      cursor.skip_blanks();
      const std::size_t begin = cursor.offset();
      cursor.any_number();
      copy.replace(begin, cursor.offset(), std::int64_t{1});
      ++at;
    }
    if (!geometry.normals.empty()) {
      for (; at < layout.normal; ++at) {
        skip_number(cursor);
      }
      if (has_three_numbers(cursor)) {
        copy.replace_numbers(cursor, geometry.normals[v]);
      }
    }
    cursor.next_line();
  }
  return std::move(copy).take();
}

template <class Number>
void store(std::string& bytes, std::size_t at, double value, std::endian order) {
  auto stored = std::bit_cast<std::array<char, sizeof(Number)>>(static_cast<Number>(value));
  if (order != std::endian::native) {
    std::reverse(stored.begin(), stored.end());
  }
  std::copy(stored.begin(), stored.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
}

void store_floats(std::string& bytes, std::size_t at, const Vec3& values, std::endian order) {
  for (const double value : values) {
    store<float>(bytes, at, value, order);
    at += sizeof(float);
  }
}

std::string rewrite_off_binary(const Source& source, std::size_t begin, const OffHeader& header,
                               const Geometry& geometry) {
  std::string bytes(source.bytes);
  std::size_t at = begin + 12;
  for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
    store_floats(bytes, at, geometry.positions[v], std::endian::big);
    if (!geometry.normals.empty()) {
      store_floats(bytes, at + 12, geometry.normals[v], std::endian::big);
    }
    at += off_vertex_size(header);
  }
  return bytes;
}

std::string rewrite_off(const Source& source, const Geometry& geometry) {
  TextCursor cursor(source);
  const OffHeader header = take_off_header(cursor).value_or(OffHeader{});
  cursor.skip_blanks();
  if (cursor.peek_word() == "BINARY") {
    cursor.next_line();
    return rewrite_off_binary(source, cursor.offset(), header, geometry);
  }
  return rewrite_off_text(source, cursor, header, geometry);
}

/// A normal for each vertex of an OFF file, if it has them.
std::vector<Vec3> normals_of_off(const Source& source, std::size_t vertices) {
  TextCursor cursor(source);
  const std::optional<OffHeader> header = take_off_header(cursor);
  std::vector<Vec3> normals;
  if (!header || !header->has_normal) {
    return normals;
  }
  cursor.skip_blanks();
  if (cursor.peek_word() == "BINARY") {
    cursor.next_line();
    std::size_t at = cursor.offset() + 12;
    for (std::size_t v = 0; v < vertices; ++v, at += off_vertex_size(*header)) {
      const char* from = source.bytes.data() + at + 12;
      normals.emplace_back(load<float>(from, std::endian::big),
                           load<float>(from + 4, std::endian::big),
                           load<float>(from + 8, std::endian::big));
    }
    return normals;
  }
  skip_off_counts(cursor, *header);
  const OffLayout layout = off_layout(cursor, *header, vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    cursor.next_word_of_file();
    for (std::size_t at = 0; at < layout.normal; ++at) {
      skip_number(cursor);
    }
    if (!has_three_numbers(cursor)) {
      return {};
    }
    Vec3& normal = normals.emplace_back();
    for (double& x : normal) {
      cursor.skip_blanks();
      x = cursor.any_number().value_or(0);
    }
    cursor.next_line();
  }
  return normals;
}

std::string rewrite_stl_binary(const Source& source, const Geometry& geometry) {
  std::string bytes(source.bytes);
  const std::span<const Vec3> p = geometry.positions;
  for (std::size_t v = 0; v < p.size(); v += 3) {
    const std::size_t facet = 84 + 50 * (v / 3);
    store_floats(bytes, facet, facet_normal(p[v], p[v + 1], p[v + 2]), std::endian::little);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      store_floats(bytes, facet + 12 * (1 + corner), p[v + corner], std::endian::little);
    }
  }
  return bytes;
}

std::string rewrite_stl_text(const Source& source, const Geometry& geometry) {
  TextCopy copy(source);
  TextCursor cursor(source);
  const std::span<const Vec3> p = geometry.positions;
  StlWalker walker(cursor);
  std::size_t vertex = 0;
  for (StlStatement next = walker.next(); next != StlStatement::end_of_file; next = walker.next()) {
    if (next == StlStatement::vertex) {
      copy.replace_numbers(cursor, p[vertex++]);
    } else if (next == StlStatement::facet && walker.has_normal() && vertex + 3 <= p.size() &&
               has_three_numbers(cursor)) {
      copy.replace_numbers(cursor, facet_normal(p[vertex], p[vertex + 1], p[vertex + 2]));
    }
  }
  return std::move(copy).take();
}

// Calls use(vertex, axis, value, type, begin, end) for each coordinate of each vertex (axes 0 to 2)
// and of its normal (3 to 5).
template <class Values, class Use>
void walk_ply_vertices(const PlyHeader& header, Values values, Use use) {
  for (const PlyElement& element : header.elements) {
    const bool is_vertex = element.name == "vertex";
    const std::array<std::optional<std::size_t>, 6> axes = {element.find("x"),  element.find("y"),
                                                            element.find("z"),  element.find("nx"),
                                                            element.find("ny"), element.find("nz")};
    const std::size_t rows = element.properties.empty() ? 0 : element.count;
    for (std::size_t row = 0; row < rows; ++row) {
      values.begin_row();
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        double items = 1;
        if (property.count_type) {
          items = values.value(*property.count_type).value_or(0);
        }
        double value = 0;
        for (; items > 0; --items) {
          value = values.value(property.type).value_or(0);
        }
        const auto axis = std::find(axes.begin(), axes.end(), std::optional(i));
        if (is_vertex && axis != axes.end()) {
          use(row, static_cast<std::size_t>(axis - axes.begin()), value, property.type,
              values.begin(), values.end());
        }
      }
      values.end_row();
    }
    if (is_vertex) {
      return;
    }
  }
}

// The new value of an axis, if it has one.
std::optional<double> value_of_axis(const Geometry& geometry, std::size_t vertex,
                                    std::size_t axis) {
  if (axis < 3) {
    return geometry.positions[vertex][static_cast<Eigen::Index>(axis)];
  }
  return geometry.normals.empty()
             ? std::nullopt
             : std::optional(geometry.normals[vertex][static_cast<Eigen::Index>(axis - 3)]);
}

std::string rewrite_ply_text(const Source& source, const PlyHeader& header,
                             const Geometry& geometry) {
  TextCopy copy(source);
  walk_ply_vertices(header, PlyText(source, header),
                    [&](std::size_t vertex, std::size_t axis, double, PlyType, std::size_t begin,
                        std::size_t end) {
                      if (const auto value = value_of_axis(geometry, vertex, axis)) {
                        copy.replace(begin, end, *value);
                      }
                    });
  return std::move(copy).take();
}

std::string rewrite_ply_binary(const Source& source, const PlyHeader& header, std::endian order,
                               const Geometry& geometry) {
  std::string bytes(source.bytes);
  walk_ply_vertices(header, PlyBinary(source, header.end, order),
                    [&](std::size_t vertex, std::size_t axis, double, PlyType type,
                        std::size_t begin, std::size_t) {
                      const auto value = value_of_axis(geometry, vertex, axis);
                      if (value && type == PlyType::float32) {
                        store<float>(bytes, begin, *value, order);
                      } else if (value) {
                        store<double>(bytes, begin, *value, order);
                      }
                    });
  return bytes;
}

bool is_integer(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

/// A normal for each vertex of a PLY file, if it has them as floats.
std::vector<Vec3> normals_of_ply(const Source& source, std::size_t vertices) {
  const Result<PlyHeader> header = read_ply_header(source);
  if (!header) {
    return {};
  }
  for (const PlyElement& element : header->elements) {
    for (const char* name : {"nx", "ny", "nz"}) {
      const std::optional<std::size_t> at = element.find(name);
      if (element.name == "vertex" &&
          (!at || is_integer(element.properties[*at].type) || element.properties[*at].count_type)) {
        return {};
      }
    }
  }
  std::vector<Vec3> normals(vertices, Vec3::Zero());
  const auto keep = [&](std::size_t vertex, std::size_t axis, double value, PlyType, std::size_t,
                        std::size_t) {
    if (axis >= 3 && vertex < vertices) {
      normals[vertex][static_cast<Eigen::Index>(axis - 3)] = value;
    }
  };
  switch (header->encoding) {
  case PlyHeader::Encoding::text:
    walk_ply_vertices(*header, PlyText(source, *header), keep);
    break;
  case PlyHeader::Encoding::little_endian:
    walk_ply_vertices(*header, PlyBinary(source, header->end, std::endian::little), keep);
    break;
  case PlyHeader::Encoding::big_endian:
    walk_ply_vertices(*header, PlyBinary(source, header->end, std::endian::big), keep);
    break;
  }
  return normals;
}

Result<std::string> rewrite_ply(const Source& source, const Geometry& geometry) {
  const Result<PlyHeader> header = read_ply_header(source);
  if (!header) {
    return header.error();
  }
  for (const PlyElement& element : header->elements) {
    for (const PlyProperty& property : element.properties) {
      if (element.name == "vertex" && is_integer(property.type) &&
          (property.name == "x" || property.name == "y" || property.name == "z")) {
        return source.error("the coordinates are integers and cannot be changed in place; convert "
                            "the model to OBJ",
                            ErrorCode::unsupported);
      }
    }
  }
  if (header->encoding == PlyHeader::Encoding::text) {
    return rewrite_ply_text(source, *header, geometry);
  }
  const bool is_little = header->encoding == PlyHeader::Encoding::little_endian;
  return rewrite_ply_binary(source, *header, is_little ? std::endian::little : std::endian::big,
                            geometry);
}

Result<std::string> rewritten_as(MeshFormat format, const Source& source, const Geometry& geometry,
                                 const FileNormals& stored) {
  switch (format) {
  case MeshFormat::obj:
    return rewrite_obj(source, geometry.positions, geometry.normals, stored);
  case MeshFormat::off:
    return rewrite_off(source, geometry);
  case MeshFormat::ply:
    return rewrite_ply(source, geometry);
  case MeshFormat::stl:
    return is_stl_text(source) ? rewrite_stl_text(source, geometry)
                               : rewrite_stl_binary(source, geometry);
  case MeshFormat::gltf:
    break;
  }
  return source.error("is glTF, which rewrite_gltf() writes",
                      ErrorCode::unsupported); // not reached
}

Status check_count(const Source& source, std::string_view noun, std::size_t in_file,
                   std::size_t given) {
  if (in_file == given) {
    return success();
  }
  return source.error("has " + counted(in_file, noun) + ", but " + std::to_string(given) +
                          " are to be written; check that this is the model they were made from",
                      ErrorCode::mismatch);
}

bool all_finite(std::span<const Vec3> vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const Vec3& v) { return v.allFinite(); });
}

/// The normals of a file in which each vertex has its own, or none.
Result<FileNormals> vertex_normals_in(const Source& source, MeshFormat format) {
  FileNormals result;
  if (format != MeshFormat::ply && format != MeshFormat::off) {
    return result;
  }
  Reading reading;
  const Result<PolygonMesh> mesh = read_as(format, source, {}, reading);
  if (!mesh) {
    return mesh.error();
  }
  const std::size_t vertices = mesh->positions.size();
  result.normals = format == MeshFormat::ply ? normals_of_ply(source, vertices)
                                             : normals_of_off(source, vertices);
  if (!result.normals.empty()) {
    result.of_corner.assign(mesh->corners().begin(), mesh->corners().end());
  }
  return result;
}

Result<FileNormals> obj_normals_in(const Source& source) {
  FileNormals normals;
  Reading reading;
  reading.normals = &normals;
  const Result<PolygonMesh> mesh = read_obj(source, reading);
  return mesh ? Result<FileNormals>(std::move(normals)) : mesh.error();
}

} // namespace

Result<FileNormals> normals_in(const Source& source, MeshFormat format,
                               const std::optional<std::filesystem::path>& folder, Pose pose) {
  if (format == MeshFormat::gltf) {
    return read_gltf_normals(source, folder, pose);
  }
  Result<FileNormals> result =
      format == MeshFormat::obj ? obj_normals_in(source) : vertex_normals_in(source, format);
  if (result) {
    const auto is_wrong = [](const Vec3& normal) { return !normal.allFinite(); };
    std::replace_if(result->normals.begin(), result->normals.end(), is_wrong, Vec3(Vec3::Zero()));
  }
  return result;
}

Status rewrite_as(MeshFormat format, const Source& source, const PolygonMesh& mesh,
                  const std::filesystem::path& folder, Pose pose, std::span<const Vec3> positions,
                  const FileNormals& stored, std::span<const Vec3> normals,
                  const std::filesystem::path& out) {
  if (!all_finite(positions) || !all_finite(normals)) {
    return Error{ErrorCode::cannot_write, one_line(out.string()) +
                                              ": a position or normal is not finite; check where "
                                              "it was computed"};
  }
  if (format == MeshFormat::gltf) {
    return rewrite_gltf(source, folder, pose, positions, normals, out);
  }
  const Status vertices = check_count(source, "vertex", mesh.positions.size(), positions.size());
  if (!vertices) {
    return vertices;
  }
  if (!normals.empty()) {
    if (Status same = check_count(source, "normal", stored.normals.size(), normals.size()); !same) {
      return same;
    }
  }
  const Result<std::string> bytes = rewritten_as(format, source, {positions, normals}, stored);
  return bytes ? write_file_atomically(out, *bytes) : bytes.error();
}

Result<FileNormals> read_normals(const std::filesystem::path& path, Pose pose) {
  const Result<ModelFile> file = ModelFile::open(path, pose);
  return file ? file->normals() : file.error();
}

Status rewrite_positions(const std::filesystem::path& original, std::span<const Vec3> positions,
                         std::span<const Vec3> normals, const std::filesystem::path& out,
                         Pose pose) {
  const Result<ModelFile> file = ModelFile::open(original, pose);
  return file ? file->rewrite(positions, normals, out) : file.error();
}

} // namespace cagewright
