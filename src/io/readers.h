/// \file
/// One reader for each format. Use read_mesh(), which chooses among them.
#pragma once

#include "io/reading.h"
#include "io/source.h"
#include <cagewright/core/result.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/pose.h>
#include <cagewright/io/rewrite_positions.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cagewright {

Result<PolygonMesh> read_obj(const Source& source, Reading& reading);
Result<PolygonMesh> read_off(const Source& source, Reading& reading);
Result<PolygonMesh> read_ply(const Source& source, Reading& reading);
Result<PolygonMesh> read_stl(const Source& source, Reading& reading);

/// Whether an STL file is text. Binary files often begin with "solid" too, so that decides nothing.
bool is_stl_text(const Source& source);

/// Whether a file is as large as a binary STL file of the count of facets that stands behind its
/// header. A text that meets this by chance would have 7 GB or more.
bool has_the_size_of_binary_stl(std::string_view bytes);

/// A word of an STL file in lower case: programs differ.
std::string stl_keyword(std::string_view word);

/// `folder` is where the buffers in files of their own are; none: they are refused.
Result<PolygonMesh> read_gltf(const Source& source,
                              const std::optional<std::filesystem::path>& folder, Reading& reading);

/// What the program does not read as it stands is told by its first bytes.
std::optional<Error> foreign_file(const Source& source);

/// For a file whose content and name show no format.
Error unknown_format(const Source& source);

/// Reads the bytes as the format says. `folder` as in read_gltf().
Result<PolygonMesh> read_as(MeshFormat format, const Source& source,
                            const std::optional<std::filesystem::path>& folder, Reading& reading);

/// The normals of a file that read_as() has accepted.
Result<FileNormals> normals_in(const Source& source, MeshFormat format,
                               const std::optional<std::filesystem::path>& folder, Pose pose);

/// See rewrite_positions(), for a file that read_as() has accepted as `mesh`.
/// \param stored  its normals as normals_in() gives them; looked at only if `normals` has any
Status rewrite_as(MeshFormat format, const Source& source, const PolygonMesh& mesh,
                  const std::filesystem::path& folder, Pose pose, std::span<const Vec3> positions,
                  const FileNormals& stored, std::span<const Vec3> normals,
                  const std::filesystem::path& out);

/// The largest value of a channel, whatever the scale: for what a file leaves out.
inline constexpr float full_channel = std::numeric_limits<float>::infinity();

/// The colour of a vertex that has none in a file where others have.
inline constexpr std::array<float, 4> white = {full_channel, full_channel, full_channel,
                                               full_channel};

/// Colours to [0, 1]: text has either fractions or bytes, and nothing says which. If any value is
/// above 1 all are taken for bytes.
void normalize_colors(PolygonMesh& mesh);

} // namespace cagewright
