/// \file
/// An OBJ file again, with other positions and normals. Use rewrite_positions().
#pragma once

#include "io/source.h"
#include <cagewright/io/rewrite_positions.h>

#include <span>
#include <string>

namespace cagewright {

/// \param source  a file that read_obj() has accepted
/// \param stored  what read_obj_normals() gives for it; used where `normals` are given, which are
///                then as many
std::string rewrite_obj(const Source& source, std::span<const Vec3> positions,
                        std::span<const Vec3> normals, const FileNormals& stored);

} // namespace cagewright
