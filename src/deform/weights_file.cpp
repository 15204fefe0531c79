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
constexpr std::string_view mean_value_kind = "mean_value";
constexpr std::size_t tile_points = FloatWeights::tile_points;
constexpr std::size_t block_tiles = 8; // 4096 rows: a few megabytes

/// The weights of up to 16 points to rows of a matrix.
void copy_rows(std::span<const float> weights, std::size_t cage_vertices, std::size_t count,
               float* rows) {
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < cage_vertices; ++c) {
      rows[i * cage_vertices + c] = weights[c * 16 + i];
    }
  }
}

/// Rows of a matrix to a tile.
void copy_tile(const float* rows, std::size_t cage_vertices, std::size_t count,
               std::span<float> tile) {
  std::fill(tile.begin(), tile.end(), 0.0F);
  for (std::size_t first = 0; first < count; first += 16) { // as many rows as stay in the cache
    const std::size_t end = std::min(first + 16, count);
    for (std::size_t c = 0; c < cage_vertices; ++c) {
      for (std::size_t i = first; i < end; ++i) {
        tile[c * tile_points + i] = rows[i * cage_vertices + c];
      }
    }
  }
}

/// Text as NumPy has it: four bytes a character.
Status add_text(NpzWriter& file, std::string_view name, std::string_view text) {
  const std::vector<std::uint32_t> characters(text.begin(), text.end());
  if (Status s = file.begin(name, {"<U" + std::to_string(text.size()), {}}, 4 * text.size()); !s) {
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
Status add_identity(NpzWriter& file, std::span<const Vec3> points, const PolygonMesh& cage) {
  const std::span<const double> positions(cage.positions.data()->data(), 3 * cage.positions.size());
  const std::int64_t version = current_version;
  const std::uint64_t sum = checksum(points);
  if (Status s = file.add("version", {"<i8", {}}, std::span(&version, 1)); !s) {
    return s;
  }
  if (Status s = add_text(file, "kind", mean_value_kind); !s) {
    return s;
  }
  if (Status s = file.add("model_checksum", {"<u8", {}}, std::span(&sum, 1)); !s) {
    return s;
  }
  if (Status s = file.add("cage_positions", {"<f8", {cage.positions.size(), 3}}, positions); !s) {
    return s;
  }
  return add_faces(file, cage);
}

class NpzSink : public RowSink {
public:
  static Result<std::unique_ptr<RowSink>>
  create(std::span<const Vec3> points, const PolygonMesh& cage, const std::filesystem::path& path) {
    Result<NpzWriter> file = NpzWriter::create(path);
    if (!file) {
      return file.error();
    }
    if (Status s = add_identity(*file, points, cage); !s) {
      return s.error();
    }
    const std::size_t width = cage.positions.size();
    if (Status s = file->begin("weights", {"<f4", {points.size(), width}}, sizeof(float)); !s) {
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
BoundCounts solve_rows(const MeanValueSolver& solver, std::span<const Vec3> points,
                       std::span<float> rows) {
  const std::size_t width = solver.cage_vertices();
  return parallel_reduce_ordered(
      0, points.size(), 64, BoundCounts(),
      [&](std::size_t begin, std::size_t end) {
        AlignedBuffer<float> weights(16 * width);
        BoundCounts counts;
        for (std::size_t first = begin; first < end; first += 16) {
          const std::size_t count = std::min<std::size_t>(16, end - first);
          const TileReport report = solver.solve(points.subspan(first, count), weights.span());
          copy_rows(weights.span(), width, count, rows.data() + first * width);
          counts.on_surface += static_cast<std::size_t>(std::popcount(report.on_surface));
          counts.undefined += static_cast<std::size_t>(std::popcount(report.undefined));
        }
        return counts;
      },
      [](BoundCounts& a, const BoundCounts& b) {
        a.on_surface += b.on_surface;
        a.undefined += b.undefined;
      });
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
  if (type.substr(0, 2) != "<U" || type.size() > 4 || array->header().count() != 1) {
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
  return text;
}

Result<FloatWeights> read_matrix(NpzReader& file, std::size_t cage_vertices) {
  Result<NpzReader::Array> array = file.array("weights");
  if (!array) {
    return array.error();
  }
  const NpyHeader& header = array->header();
  if (header.type != "<f4" || header.shape.size() != 2 || header.shape[1] != cage_vertices) {
    return file.unexpected("weights", header);
  }
  const std::uint64_t points = header.shape[0];
  if (array->remaining() / sizeof(float) != header.count()) {
    return file.unexpected("weights", header);
  }
  FloatWeights weights(points, cage_vertices);
  std::vector<float> rows(block_tiles * tile_points * cage_vertices);
  for (std::size_t first = 0; first < weights.tile_count(); first += block_tiles) {
    const std::size_t tiles = std::min(block_tiles, weights.tile_count() - first);
    const std::size_t begin = first * tile_points;
    const std::size_t count = std::min(tiles * tile_points, points - begin);
    if (Status s =
            array->read(std::as_writable_bytes(std::span(rows).first(count * cage_vertices)));
        !s) {
      return s.error();
    }
    parallel_for(0, tiles, 1, [&](std::size_t t) {
      copy_tile(rows.data() + t * tile_points * cage_vertices, cage_vertices,
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
  const FilePointer file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    return Error{ErrorCode::cannot_open,
                 one_line(path.string()) + ": cannot be read; check its permissions"};
  }
  std::array<char, 256> start{};
  const std::size_t count = std::fread(start.data(), 1, start.size(), file.get());
  return FileBytes(std::string_view(start.data(), count));
}

/// Whether weights reproduce the points from the cage at rest, as all coordinates do.
Status gives(const FloatWeights& weights, std::span<const Vec3> points,
             std::span<const Vec3> cage) {
  // Of the cage's size, and of the magnitude of the weights, which far outside is large: floats,
  // and some digits lost on the way.
  constexpr double tolerance = 1e-4;
  if (weights.cage_vertices() != cage.size()) {
    return Error{ErrorCode::mismatch, "the weights are for a cage of " +
                                          std::to_string(weights.cage_vertices()) +
                                          " vertices, but this one has " +
                                          std::to_string(cage.size()) + "; bind the model again"};
  }
  Box3 box;
  for (const Vec3& p : cage) {
    box.extend(p);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    double magnitude = 0;
    for (std::size_t c = 0; c < cage.size(); ++c) {
      const double weight = weights.at(i, c);
      sum += weight * cage[c];
      total += weight;
      magnitude += std::abs(weight);
    }
    const double allowed = tolerance * box.sizes().norm() * std::max(1.0, magnitude);
    const bool has_weights = total != 0; // else it stays at rest
    if (has_weights && !((sum - points[i]).norm() <= allowed)) {
      return Error{ErrorCode::mismatch, "the weights are for another model or cage: they do not "
                                        "give its vertex " +
                                            std::to_string(i) + "; bind the model again"};
    }
  }
  return success();
}

} // namespace

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
  std::ranges::transform(extension, extension.begin(), [](char c) {
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

Result<BoundCounts> bind_to_file(const MeanValueSolver& solver, std::span<const Vec3> points,
                                 const PolygonMesh& cage, const std::filesystem::path& path,
                                 const Progress& progress) {
  return bind_to_file(solver, points, cage, path, WeightsFormat::npz, progress);
}

Result<BoundCounts> bind_to_file(const MeanValueSolver& solver, std::span<const Vec3> points,
                                 const PolygonMesh& cage, const std::filesystem::path& path,
                                 WeightsFormat format, const Progress& progress) {
  assert(cage.positions.size() == solver.cage_vertices());
  const std::size_t width = solver.cage_vertices();
  Result<std::unique_ptr<RowSink>> sink = format == WeightsFormat::npz
                                              ? NpzSink::create(points, cage, path)
                                              : text_sink(format, points, cage, path);
  if (!sink) {
    return sink.error();
  }
  BoundCounts counts;
  std::vector<float> rows(std::min(points.size(), block_tiles * tile_points) * width);
  for (std::size_t first = 0; first < points.size(); first += block_tiles * tile_points) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    const std::size_t count = std::min(block_tiles * tile_points, points.size() - first);
    const std::span<float> block = std::span(rows).first(count * width);
    const BoundCounts more = solve_rows(solver, points.subspan(first, count), block);
    counts.on_surface += more.on_surface;
    counts.undefined += more.undefined;
    if (Status s = (*sink)->rows(block); !s) {
      return s.error();
    }
    progress(static_cast<double>(first + count) / static_cast<double>(points.size()), "bind");
  }
  if (Status s = (*sink)->finish(); !s) {
    return s.error();
  }
  return counts;
}

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
  Result<std::string> kind = read_text(*file, "kind");
  if (!kind) {
    return kind.error();
  }
  if (*kind != mean_value_kind) {
    return Error{ErrorCode::unsupported,
                 path.string() + ": weights of unknown kind '" + *kind + "'"};
  }
  stored.kind = *std::move(kind);
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
  Result<FloatWeights> weights = read_matrix(*file, stored.cage.positions.size());
  if (!weights) {
    return weights.error();
  }
  stored.weights = *std::move(weights);
  return stored;
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
    return gives(stored.weights, points, cage.positions);
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
    if (!std::ranges::equal(rest.face(f), other.face(f))) {
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
