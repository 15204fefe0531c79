/// \file
/// Weights in a file, so that a model is bound once.
#pragma once

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/coordinates/weights.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace cagewright {

/// The files that weights are written to.
enum class WeightsFormat {
  npz,           ///< NumPy's: numpy.load(path)
  csv,           ///< lines "model_vertex,column,weight" but for zeros; # begins what they are for
  json,          ///< one object: "weights" has a list for each vertex of the model
  dmat,          ///< libigl's: the matrix alone, as text
  vertex_groups, ///< JSON for scripts: a group of vertices with weights for each cage vertex
};

/// The format of an extension: .npz, .csv, .json or .dmat, in upper or lower case; none for others.
std::optional<WeightsFormat> weights_format_of_name(const std::filesystem::path& path);

/// Weights as read from a file, with what is needed to tell whether they are the right ones.
struct StoredWeights {
  FloatWeights weights;             ///< P x K
  PolygonMesh cage;                 ///< at rest: C vertices
  CoordinateSettings settings;      ///< the kind of coordinates, and its options
  std::uint64_t model_checksum = 0; ///< checksum() of the model's P positions
  bool has_identity = true; ///< false: the file holds the weights alone (DMAT), the rest is empty
};

/// A number that changes when a coordinate, the order or the count of the points does.
std::uint64_t checksum(std::span<const Vec3> points);

/// Binds points to a cage and writes the weights, a few thousand rows at a time: the matrix never
/// stands in memory.
///
/// The file is NumPy's: numpy.load(path) gives weights (P x K floats), columns ("vertices=100
/// normals=196": what the K columns are, in order), cage_positions (C x 3 doubles), cage_faces
/// (F x the most corners, integers, -1 after the last corner), kind, options, version and
/// model_checksum. Of kinds with one column a vertex, positions of the model are
/// weights @ cage_positions. It appears under its name only when complete, and the same input gives
/// the same bytes.
///
/// \param settings  what the coordinates were prepared with
/// \param cage      what they were prepared of
/// Errors: cannot_write, cancelled, invalid_cage (points outside that the kind refuses).
Result<PointCounts> bind_to_file(const Coordinates& coordinates, const CoordinateSettings& settings,
                                 std::span<const Vec3> points, const PolygonMesh& cage,
                                 const std::filesystem::path& path, const Progress& progress = {});

/// The same in a format of choice. In CSV, JSON and DMAT weights read back as the same floats; DMAT
/// holds them alone, and read_weights() must tell whether they belong to a model by what they give.
/// DMAT and groups of vertices go by columns: the matrix stands in memory.
///
/// Groups of vertices, of kinds with one column a vertex alone: {"format":
/// "cagewright-vertex-groups", "version": 1, "vertices": P, "groups": [{"name": "cage_0",
/// "vertices": [...], "weights": [...]}, ...]}, one for each cage vertex, zeros left out; weights
/// may be negative.
///
/// Errors: besides those above, too_large (the matrix does not fit the memory allowed), unsupported
/// (the format cannot hold the kind's columns).
Result<PointCounts> bind_to_file(const Coordinates& coordinates, const CoordinateSettings& settings,
                                 std::span<const Vec3> points, const PolygonMesh& cage,
                                 const std::filesystem::path& path, WeightsFormat format,
                                 const Progress& progress = {});

/// Reads such a file, whatever its name; also one that was compressed by numpy.savez_compressed.
/// Errors: cannot_open, malformed (foreign, cut off or damaged), unsupported (of a later version
/// or another kind), too_large.
Result<StoredWeights> read_weights(const std::filesystem::path& path);

/// Whether the weights were made for these points and this cage, exactly; without identity, whether
/// they give the points from the cage, where the kind does.
/// Errors: mismatch, with what differs; those of the kind's rule.
Status belongs_to(const StoredWeights& stored, std::span<const Vec3> points,
                  const PolygonMesh& cage);

/// Whether two cages have the same vertices and faces, apart from where the vertices are.
/// \param what  "the deformed cage", for the message
/// Errors: mismatch: "the deformed cage has 98 vertices, the cage at rest 100".
Status same_topology(const PolygonMesh& rest, const PolygonMesh& other, const std::string& what);

} // namespace cagewright
