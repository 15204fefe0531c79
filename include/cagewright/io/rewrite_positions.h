/// \file
/// A model file with other positions, and all else as it was.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace cagewright {

/// The normals that a file stores, and which corner uses which. OBJ lists equal normals once, for
/// any number of vertices; here each vertex has its own, so that they can turn apart.
struct FileNormals {
  static constexpr Index none = std::numeric_limits<Index>::max();

  std::vector<Vec3> normals;    ///< N normals as stored, not made unit; empty if no corner has one
  std::vector<Index> of_corner; ///< for each of PolygonMesh::corners() an index < N, or `none`;
                                ///< empty if N = 0
  std::vector<Index> in_file;   ///< OBJ: for each of the N which `vn` of the file it is, from 0;
                                ///< empty for other formats, which have each in its own place
};

/// Reads the normals of an OBJ file (a corner's own, so that hard edges are where two corners of
/// a vertex differ), of a PLY or NOFF file (one for each vertex), or of a glTF file (unit vectors,
/// as the scene shows them). For STL there are none.
///
/// Errors: those of read_mesh().
Result<FileNormals> read_normals(const std::filesystem::path& path, Pose pose = Pose::shown);

/// Writes the file `original` again as `out`, with other positions. Every other byte stays: order,
/// polygons, texture coordinates, groups, materials, comments, colours, elements of others.
///
/// In glTF the values of the accessors change where they are, with their bounds in the JSON, and
/// tangents turn with the normals. Nodes, skins (bind pose and joints), and morph targets stay as
/// they are: positions are those that read_mesh() gives for the same pose, taken back through the
/// nodes' transforms, each vertex's own mean of its joints, and the morph targets, so that the
/// file, posed as before, shows the given positions. Accessors of integers, sparse ones, and those
/// that share their bytes with others get floats in a new buffer view at the end of the binary
/// chunk (or in a new buffer); nodes that show one mesh and are to show several shapes get copies
/// of it, which share all that is not changed. A copy of the vertices compressed by Draco is left
/// out where they change.
/// Where `out` is named .gltf and the file is GLB, or the other way round, the container changes
/// and holds all buffers; else a buffer in a file of its own is written beside `out`, under its
/// name with .bin, never over a file that the original refers to, and the URI changed; the one in
/// the original stays. Links to images stay as they are.
///
/// In OBJ a normal whose vertices have turned apart becomes several, one after the other, and the
/// faces refer to them; where none has, the faces stay as they are.
///
/// OBJ, OFF, STL, PLY and glTF. Text gets the shortest digits that read back as the same double;
/// binary files and the properties of PLY keep their types, and so may round to float. Facet
/// normals of STL are computed anew.
///
/// \param positions  as many as read_mesh() gives for the file, in its order
/// \param normals    as many as read_normals() gives, or none: then the file's stay
///
/// Errors: those of read_mesh(); mismatch (other numbers of positions or normals), unsupported
/// (integer coordinates in PLY; in glTF a vertex that its node or its joints flatten, so that no
/// stored position shows it where it should be), cannot_write (also for a position that is not
/// finite).
Status rewrite_positions(const std::filesystem::path& original, std::span<const Vec3> positions,
                         std::span<const Vec3> normals, const std::filesystem::path& out,
                         Pose pose = Pose::shown);

} // namespace cagewright
