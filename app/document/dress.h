/// \file
/// How a model's surface is dressed by its files: materials, textures, colours of faces.
#pragma once

#include <cagewright/io/mesh_attributes.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <QImage>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cagewright::app {

struct Material {
  std::array<float, 3> color = {1, 1, 1}; ///< sRGB; a texture is multiplied by it
  QImage texture;                         ///< null: none
};

/// What one file says of the surface.
struct FileDress {
  MeshAttributes attributes;
  std::vector<Material> materials; ///< of attributes.material_names; the last one of faces without
};

/// A mesh as it is drawn when it is dressed: a vertex of the model is there once for each texture
/// point and material that it has.
struct Dress {
  std::vector<Index> vertex_of;                     ///< D of the model's vertices
  std::vector<std::array<float, 2>> texture_points; ///< D, v upwards
  /// D: corner and size of the texture in the atlas, as fractions of it; without size: no texture.
  std::vector<std::array<float, 4>> places;
  std::vector<std::array<std::uint8_t, 4>> colors; ///< D
  std::vector<Triangle> triangles;                 ///< the model's, in their order
  std::vector<Triangle> coarse;                    ///< the model's coarse ones
  std::vector<std::array<Index, 2>> edges;         ///< the model's
  QImage atlas;                                    ///< all textures in one; its first row is below
};

/// Reads the materials of a file beside what it is dressed by: MTL libraries of OBJ, textures named
/// in PLY, glTF. What is missing or cannot be read leaves a material plain. Nothing if the file
/// says nothing of colours.
std::optional<FileDress> read_dress(const std::filesystem::path& path, MeshAttributes attributes);

/// One of the files of a model, with its place in it.
struct DressedPart {
  const FileDress* dress = nullptr; ///< none: white
  const PolygonMesh* mesh = nullptr;
  Index first_vertex = 0;
};

/// \param cut    of all parts, one after the other
/// \param coarse, edges  over the model's vertices, too
/// \param colors V of the model's vertices, or none: where no material says otherwise
std::shared_ptr<const Dress> make_dress(std::span<const DressedPart> parts,
                                        const Triangulation& cut,
                                        std::span<const std::array<float, 4>> colors,
                                        std::span<const Triangle> coarse,
                                        std::span<const std::array<Index, 2>> edges);

} // namespace cagewright::app
