/// \file
/// What stands behind the opaque types that several files share.
#pragma once

#include <cagewright/c/cagewright.h>

#include <cagewright/io/model_file.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct cw_mesh {
  cagewright::PolygonMesh mesh;
  std::vector<std::uint64_t> offsets; ///< F + 1
  cagewright::Triangulation cut;
  std::string notes; ///< JSON

  explicit cw_mesh(cagewright::PolygonMesh polygons,
                   std::span<const cagewright::FileNote> what_was_noted = {});
};

namespace cagewright::c {

/// Text for the caller to free by cw_free(). Throws std::bad_alloc.
char* handed_out(std::string_view text);

/// [{"code": ..., "message": ...}, ...]
std::string notes_as_json(std::span<const FileNote> notes);

} // namespace cagewright::c
