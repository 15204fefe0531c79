#include <cagewright/deform/weights_file.h>

#include "core/parallel.h"
#include "deform/npz.h"
#include "deform/weights_text.h"
#include "io/read_file.h"
#include "io/source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr std::int64_t current_version = 1;
constexpr const char* kind_name = "kind";
constexpr const char* options_name = "options";
constexpr const char* columns_name = "columns";
constexpr std::size_t tile_points = FloatWeights::tile_points;
constexpr std::size_t block_tiles = 8; // 4096 rows: a few megabytes

/// The weights of up to 64 points to rows of a matrix.
constexpr std::size_t points_at_once = 64;
void copy_rows(std::span<const float> weights, std::size_t columns, std::size_t count,
               float* rows) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < columns; ++k) {
      rows[i * columns + k] = weights[k * points_at_once + i];
    }
  }
}

/// Rows of a matrix to a tile.
void copy_tile(const float* rows, std::size_t columns, std::size_t count, std::span<float> tile) {
  std::fill(tile.begin(), tile.end(), 0.0F);
  for (std::size_t first = 0; first < count; first += 16) { // as many rows as stay in the cache
    const std::size_t end = std::min(first + 16, count);
    for (std::size_t k = 0; k < columns; ++k) {
      for (std::size_t i = first; i < end; ++i) {
        tile[k * tile_points + i] = rows[i * columns + k];
      }
    }
  }
}

/// Text as NumPy has it: four bytes a character.
Status add_text(NpzWriter& file, std::string_view name, std::string_view text) {
  std::vector<std::uint32_t> characters(text.begin(), text.end());
  characters.resize(std::max<std::size_t>(1, characters.size())); // NumPy has no text of 0 bytes
  if (Status s =
          file.begin(name, {"<U" + std::to_string(characters.size()), {}}, 4 * characters.size());
      !s) {
    return s;
  }
  if (Status s = file.write(std::as_bytes(std::span(characters))); !s) {
    return s;
  }
  return file.end();
}

Status add_faces(NpzWriter& file, const PolygonMesh& cage) {
  std::size_t width = 3;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    width = std::max(width, cage.face(f).size());
  }
  std::vector<std::int32_t> corners(cage.face_count() * width, -1);
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    std::copy(cage.face(f).begin(), cage.face(f).end(),
              corners.begin() + static_cast<std::ptrdiff_t>(f * width));
  }
  return file.add<std::int32_t>("cage_faces", {"<i4", {cage.face_count(), width}}, corners);
}

/// All but the weights.
Status add_identity(NpzWriter& file, const WeightsIdentity& identity) {
  const std::vector<Vec3>& cage = identity.cage.positions;
  const std::int64_t version = current_version;
  const std::uint64_t sum = checksum(identity.points);
  if (Status s = file.add("version", {"<i8", {}}, std::span(&version, 1)); !s) {
    return s;
  }
  for (const auto& [name, text] : {std::pair(kind_name, identity.settings.name()),
                                   {options_name, identity.settings.text()},
                                   {columns_name, text_of(identity.rule.groups())}}) {
    if (Status s = add_text(file, name, text); !s) {
      return s;
    }
  }
  if (Status s = file.add("model_checksum", {"<u8", {}}, std::span(&sum, 1)); !s) {
    return s;
  }
  if (Status s = file.add("cage_positions", {"<f8", {cage.size(), 3}},
                          std::span(cage.data()->data(), 3 * cage.size()));
      !s) {
    return s;
  }
  return add_faces(file, identity.cage);
}

class NpzSink : public RowSink {
public:
  static Result<std::unique_ptr<RowSink>> create(const WeightsIdentity& identity,
                                                 const std::filesystem::path& path) {
    Result<NpzWriter> file = NpzWriter::create(path);
    if (!file) {
      return file.error();
    }
    if (Status s = add_identity(*file, identity); !s) {
      return s.error();
    }
    if (Status s = file->begin(
            "weights", {"<f4", {identity.points.size(), identity.rule.columns()}}, sizeof(float));
        !s) {
      return s.error();
    }
    return std::unique_ptr<RowSink>(new NpzSink(*std::move(file)));
  }

  Status rows(std::span<const float> block) override { return file_.write(std::as_bytes(block)); }
  Status finish() override {
    Status status = file_.end();
    return status ? file_.finish() : status;
  }

private:
  explicit NpzSink(NpzWriter file) : file_(std::move(file)) {}

  NpzWriter file_;
};

/// The rows of the points, one after the other.
PointCounts solve_rows(const Coordinates& coordinates, std::span<const Vec3> points,
                       std::span<float> rows) {
  const std::size_t width = coordinates.columns();
  return parallel_reduce_ordered(
      0, points.size(), points_at_once, PointCounts(),
      [&](std::size_t begin, std::size_t end) {
        AlignedBuffer<float> weights(points_at_once * width);
        const PointCounts counts = solve_block(coordinates, points.subspan(begin, end - begin),
                                               weights.span(), points_at_once);
        copy_rows(weights.span(), width, end - begin, rows.data() + begin * width);
        return counts;
      },
      [](PointCounts& a, const PointCounts& b) { a.add(b); });
}

Result<PolygonMesh> read_cage(NpzReader& file) {
  Result<NpzReader::Array> positions = file.array("cage_positions");
  if (!positions) {
    return positions.error();
  }
  const NpyHeader header = positions->header();
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  if (header.type != "<f8" || header.shape.size() != 2 || header.shape[1] != 3 ||
      header.shape[0] == 0 || header.shape[0] > most) {
    return file.unexpected("cage_positions", header);
  }
  Result<std::vector<double>> values = file.read<double>("cage_positions", "<f8", header.count());
  if (!values) {
    return values.error();
  }
  PolygonMesh cage;
  for (std::size_t i = 0; i < values->size(); i += 3) {
    cage.positions.emplace_back((*values)[i], (*values)[i + 1], (*values)[i + 2]);
  }
  Result<NpzReader::Array> faces = file.array("cage_faces");
  if (!faces) {
    return faces.error();
  }
  const NpyHeader shape = faces->header();
  if (shape.type != "<i4" || shape.shape.size() != 2 || shape.shape[1] < 3 ||
      shape.count() > most) {
    return file.unexpected("cage_faces", shape);
  }
  Result<std::vector<std::int32_t>> corners =
      file.read<std::int32_t>("cage_faces", "<i4", shape.count());
  if (!corners) {
    return corners.error();
  }
  std::vector<Index> face;
  for (std::size_t f = 0; f < shape.shape[0]; ++f) {
    face.clear();
    for (std::size_t k = 0; k < shape.shape[1]; ++k) {
      const std::int32_t corner = (*corners)[f * shape.shape[1] + k];
      if (corner >= static_cast<std::int32_t>(cage.positions.size())) {
        return Error{ErrorCode::malformed, file.label() + ": cage_faces refers to vertex " +
                                               std::to_string(corner) + ", but there are " +
                                               std::to_string(cage.positions.size())};
      }
      if (corner >= 0) {
        face.push_back(static_cast<Index>(corner));
      }
    }
    if (face.size() < 3) {
      return Error{ErrorCode::malformed, file.label() + ": face " + std::to_string(f) +
                                             " of cage_faces has fewer than three corners"};
    }
    cage.add_face(face);
  }
  return cage;
}

Result<std::string> read_text(NpzReader& file, std::string_view name) {
  Result<NpzReader::Array> array = file.array(name);
  if (!array) {
    return array.error();
  }
  const std::string& type = array->header().type;
  if (type.substr(0, 2) != "<U" || type.size() > 5 || array->header().count() != 1) {
    return file.unexpected(name, array->header());
  }
  std::vector<std::uint32_t> characters(static_cast<std::size_t>(std::atoi(type.c_str() + 2)));
  if (Status s = array->read(std::as_writable_bytes(std::span(characters))); !s) {
    return s.error();
  }
  std::string text;
  for (const std::uint32_t c : characters) {
    text += c < 128 ? static_cast<char>(c) : '?';
  }
  text.resize(std::min(text.find('\0'), text.size())); // NumPy fills up with zeros
  return text;
}

Result<FloatWeights> read_matrix(NpzReader& file, std::size_t columns) {
  Result<NpzReader::Array> array = file.array("weights");
  if (!array) {
    return array.error();
  }
  const NpyHeader& header = array->header();
  if (header.type != "<f4" || header.shape.size() != 2 || header.shape[1] != columns) {
    return file.unexpected("weights", header);
  }
  const std::uint64_t points = header.shape[0];
  if (array->remaining() / sizeof(float) != header.count()) {
    return file.unexpected("weights", header);
  }
  FloatWeights weights(points, columns);
  std::vector<float> rows(block_tiles * tile_points * columns);
  for (std::size_t first = 0; first < weights.tile_count(); first += block_tiles) {
    const std::size_t tiles = std::min(block_tiles, weights.tile_count() - first);
    const std::size_t begin = first * tile_points;
    const std::size_t count = std::min(tiles * tile_points, points - begin);
    if (Status s = array->read(std::as_writable_bytes(std::span(rows).first(count * columns)));
        !s) {
      return s.error();
    }
    parallel_for(0, tiles, 1, [&](std::size_t t) {
      copy_tile(rows.data() + t * tile_points * columns, columns,
                std::min(tile_points, count - t * tile_points), weights.tile(first + t));
    });
  }
  return weights;
}

/// The first bytes of a file, enough to tell its format. Errors: cannot_open.
Result<FileBytes> read_start(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Error{ErrorCode::cannot_open,
                 one_line(path.string()) +
                     (error ? ": there is no such file; check the name and the folder"
                            : ": not a regular file; give the file that bind has written")};
  }
  std::uint64_t size = 0;
  const FilePointer file = open_regular_file(path, size);
  if (!file) {
    return Error{ErrorCode::cannot_open,
                 one_line(path.string()) + ": cannot be read; check its permissions"};
  }
  std::array<char, 256> start{};
  const std::size_t count = std::fread(start.data(), 1, start.size(), file.get());
  return FileBytes(std::string_view(start.data(), count));
}

/// Whether weights reproduce the points from the cage at rest, as most coordinates do.
Status gives(const FloatWeights& weights, std::span<const Vec3> points, const ColumnRule& rule) {
  // Of the cage's size, and of the magnitude of the weights, which far outside is large: floats,
  // and some digits lost on the way.
  constexpr double tolerance = 1e-4;
  if (weights.columns() != rule.columns()) {
    return Error{ErrorCode::mismatch, "the weights have " + std::to_string(weights.columns()) +
                                          " columns, but such weights for this cage of " +
                                          std::to_string(rule.cage_at_rest().size()) +
                                          " vertices have " + std::to_string(rule.columns()) +
                                          "; bind the model again"};
  }
  const std::vector<Vec3> from = rule.reproduced_from();
  if (from.empty()) {
    return success();
  }
  Box3 box;
  for (const Vec3& p : rule.cage_at_rest()) {
    box.extend(p);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    double magnitude = 0;
    for (std::size_t k = 0; k < from.size(); ++k) {
      const double weight = weights.at(i, k);
      sum += weight * from[k];
      magnitude += std::abs(weight);
    }
    const double allowed = tolerance * box.sizes().norm() * std::max(1.0, magnitude);
    const bool has_weights = magnitude != 0; // else it stays at rest
    if (has_weights && !((sum - points[i]).norm() <= allowed)) {
      return Error{ErrorCode::mismatch, "the weights are for another model or cage: they do not "
                                        "give its vertex " +
                                            std::to_string(i) + "; bind the model again"};
    }
  }
  return success();
}

} // namespace

std::string text_of(const std::vector<ColumnGroup>& groups) {
  std::string text;
  for (const ColumnGroup& group : groups) {
    text += text.empty() ? "" : " ";
    text += std::string(group.name) + '=' + std::to_string(group.count);
  }
  return text;
}

Result<CoordinateSettings> settings_of_file(std::string_view kind, std::string_view options,
                                            const std::string& name) {
  if (!CoordinateSettings::of(kind)) {
    return Error{ErrorCode::unsupported, name + ": weights of unknown kind '" +
                                             one_line(std::string(kind), 40) +
                                             "'; this program has " + names_of_coordinate_kinds()};
  }
  Result<CoordinateSettings> settings = CoordinateSettings::parse(kind, options);
  if (!settings) {
    return Error{ErrorCode::unsupported, name + ": weights with options of another version (" +
                                             one_line(std::string(options), 80) +
                                             "); bind the model again"};
  }
  return settings;
}

Result<std::size_t> columns_of_file(const StoredWeights& stored, std::string_view columns,
                                    const std::string& name) {
  const auto rule = coordinate_rule(stored.cage, stored.settings);
  if (!rule) {
    return Error{ErrorCode::malformed, name + ": the cage in it is none: " + rule.error().message +
                                           "; bind the model again"};
  }
  const std::string expected = text_of((*rule)->groups());
  if (!columns.empty() && columns != expected) {
    return Error{ErrorCode::malformed, name + ": its columns are " +
                                           one_line(std::string(columns), 80) + ", not " +
                                           expected + "; bind the model again"};
  }
  return (*rule)->columns();
}

std::uint64_t checksum(std::span<const Vec3> points) {
  std::uint64_t hash = 0x9e3779b97f4a7c15ULL ^ points.size();
  for (const Vec3& p : points) {
    for (const double x : p) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9fb21c651e98df25ULL;
      hash ^= hash >> 29U;
    }
  }
  return hash;
}

std::optional<WeightsFormat> weights_format_of_name(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  for (const auto& [name, format] :
       {std::pair(".npz", WeightsFormat::npz), std::pair(".csv", WeightsFormat::csv),
        std::pair(".json", WeightsFormat::json), std::pair(".dmat", WeightsFormat::dmat)}) {
    if (extension == name) {
      return format;
    }
  }
  return std::nullopt;
}

Result<PointCounts> bind_to_file(const Coordinates& coordinates, const CoordinateSettings& settings,
                                 std::span<const Vec3> points, const PolygonMesh& cage,
                                 const std::filesystem::path& path, const Progress& progress) {
  return bind_to_file(coordinates, settings, points, cage, path, WeightsFormat::npz, progress);
}

Result<PointCounts> bind_to_file(const Coordinates& coordinates, const CoordinateSettings& settings,
                                 std::span<const Vec3> points, const PolygonMesh& cage,
                                 const std::filesystem::path& path, WeightsFormat format,
                                 const Progress& progress) {
  assert(cage.positions.size() == coordinates.rule()->cage_at_rest().size());
  const std::size_t width = coordinates.columns();
  const WeightsIdentity identity{settings, *coordinates.rule(), points, cage};
  Result<std::unique_ptr<RowSink>> sink = format == WeightsFormat::npz
                                              ? NpzSink::create(identity, path)
                                              : text_sink(format, identity, path);
  if (!sink) {
    return sink.error();
  }
  PointCounts counts;
  std::vector<float> rows(std::min(points.size(), block_tiles * tile_points) * width);
  for (std::size_t first = 0; first < points.size(); first += block_tiles * tile_points) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    const std::size_t count = std::min(block_tiles * tile_points, points.size() - first);
    const std::span<float> block = std::span(rows).first(count * width);
    counts.add(solve_rows(coordinates, points.subspan(first, count), block));
    if (Status s = (*sink)->rows(block); !s) {
      return s.error();
    }
    progress(static_cast<double>(first + count) / static_cast<double>(points.size()), "bind");
  }
  if (Status s = accept(coordinates, counts); !s) {
    return s.error();
  }
  if (Status s = (*sink)->finish(); !s) {
    return s.error();
  }
  return counts;
}

namespace {

/// An error of an archive in one line, whatever its name and its arrays hold, with what helps.
Error told(Error error) {
  const bool is_of_content =
      error.code == ErrorCode::malformed || error.code == ErrorCode::unsupported;
  if (is_of_content && error.message.find("; ") == error.message.npos) {
    error.message += "; bind the model again";
  }
  error.message = one_line(error.message);
  return error;
}

Result<StoredWeights> read_archive(const std::filesystem::path& path) {
  Result<NpzReader> file = NpzReader::open(path);
  if (!file) {
    return file.error();
  }
  for (const char* name :
       {"version", "kind", "model_checksum", "cage_positions", "cage_faces", "weights"}) {
    if (!file->has(name)) {
      return Error{ErrorCode::malformed,
                   path.string() + ": not a weights file of cagewright bind: it has no array '" +
                       name + "'"};
    }
  }
  Result<std::vector<std::int64_t>> version = file->read<std::int64_t>("version", "<i8", 1);
  if (!version) {
    return version.error();
  }
  if ((*version)[0] != current_version) {
    return Error{ErrorCode::unsupported,
                 path.string() + ": weights of version " + std::to_string((*version)[0]) +
                     ", but this program reads version " + std::to_string(current_version)};
  }
  StoredWeights stored;
  const Result<std::string> kind = read_text(*file, kind_name);
  if (!kind) {
    return kind.error();
  }
  const Result<std::string> options =
      file->has(options_name) ? read_text(*file, options_name) : std::string();
  if (!options) {
    return options.error();
  }
  Result<CoordinateSettings> settings = settings_of_file(*kind, *options, one_line(path.string()));
  if (!settings) {
    return settings.error();
  }
  stored.settings = *std::move(settings);
  Result<std::vector<std::uint64_t>> sum = file->read<std::uint64_t>("model_checksum", "<u8", 1);
  if (!sum) {
    return sum.error();
  }
  stored.model_checksum = (*sum)[0];
  Result<PolygonMesh> cage = read_cage(*file);
  if (!cage) {
    return cage.error();
  }
  stored.cage = *std::move(cage);
  const Result<std::string> columns =
      file->has(columns_name) ? read_text(*file, columns_name) : std::string();
  if (!columns) {
    return columns.error();
  }
  const Result<std::size_t> width = columns_of_file(stored, *columns, one_line(path.string()));
  if (!width) {
    return width.error();
  }
  Result<FloatWeights> weights = read_matrix(*file, *width);
  if (!weights) {
    return weights.error();
  }
  stored.weights = *std::move(weights);
  return stored;
}

} // namespace

Result<StoredWeights> read_weights(const std::filesystem::path& path) {
  Result<FileBytes> start = read_start(path);
  if (!start) {
    return start.error();
  }
  if (const auto format = text_weights_format(start->view())) {
    const Result<FileBytes> bytes = read_file(path);
    return bytes ? read_text_weights(bytes->view(), *format, one_line(path.string()))
                 : bytes.error();
  }
  Result<StoredWeights> stored = read_archive(path);
  return stored ? std::move(stored) : told(stored.error());
}

Status belongs_to(const StoredWeights& stored, std::span<const Vec3> points,
                  const PolygonMesh& cage) {
  const auto mismatch = [](std::string message) {
    return Error{ErrorCode::mismatch, std::move(message)};
  };
  if (stored.weights.points() != points.size()) {
    return mismatch("the weights are for a model of " + std::to_string(stored.weights.points()) +
                    " vertices, but this one has " + std::to_string(points.size()) +
                    ": bind it again");
  }
  if (!stored.has_identity) {
    const auto rule = coordinate_rule(cage, stored.settings);
    return rule ? gives(stored.weights, points, **rule) : Status(rule.error());
  }
  if (stored.model_checksum != checksum(points)) {
    return mismatch("the weights are for another shape of the model, or its vertices in another "
                    "order: bind it again");
  }
  if (Status s = same_topology(stored.cage, cage, "the cage"); !s) {
    return mismatch("the weights are for another cage: " + s.error().message);
  }
  for (std::size_t v = 0; v < cage.positions.size(); ++v) {
    if (stored.cage.positions[v] != cage.positions[v]) {
      return mismatch("the weights are for another cage: its vertex " + std::to_string(v) +
                      " was elsewhere; bind the model again");
    }
  }
  return success();
}

Status same_topology(const PolygonMesh& rest, const PolygonMesh& other, const std::string& what) {
  const auto differs = [&](std::size_t count, std::size_t expected, const char* items) {
    return Error{ErrorCode::mismatch, what + " has " + std::to_string(count) + ' ' + items +
                                          ", the cage at rest " + std::to_string(expected)};
  };
  if (other.positions.size() != rest.positions.size()) {
    return differs(other.positions.size(), rest.positions.size(), "vertices");
  }
  if (other.face_count() != rest.face_count()) {
    return differs(other.face_count(), rest.face_count(), "faces");
  }
  for (std::size_t f = 0; f < rest.face_count(); ++f) {
    if (!std::equal(rest.face(f).begin(), rest.face(f).end(), other.face(f).begin(),
                    other.face(f).end())) {
      const auto listed = [](std::span<const Index> face) {
        std::string text;
        for (const Index v : face) {
          text += std::to_string(v);
          text += ' ';
        }
        text.pop_back();
        return text;
      };
      return Error{ErrorCode::mismatch, "face " + std::to_string(f) + " of " + what +
                                            " has the vertices " + listed(other.face(f)) +
                                            ", in the cage at rest " + listed(rest.face(f))};
    }
  }
  return success();
}

} // namespace cagewright
