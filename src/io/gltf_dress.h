/// \file
/// What a glTF file holds beside shape and normals.
#pragma once

#include "io/source.h"
#include <cagewright/io/mesh_attributes.h>

namespace cagewright {

/// Adds to MeshAttributes::others what other formats do not get from a glTF file that the reader
/// has accepted: materials, texture coordinates, skins, morph targets, animations.
void list_gltf_dress(const Source& source, MeshAttributes& attributes);

} // namespace cagewright
