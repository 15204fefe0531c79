/// \file
/// How the surface that a glTF file shows is dressed.
#pragma once

#include "io/gltf_scene.h"
#include <cagewright/io/mesh_attributes.h>

namespace cagewright {

/// Texture points (the first set, v upwards), normals as the scene shows them, materials by name,
/// and in words what else the file holds. What is damaged is left out: the shape does not need it.
MeshAttributes read_gltf_attributes(GltfDocument& document, const GltfScene& scene);

} // namespace cagewright
