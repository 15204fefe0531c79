/// \file
/// A model as it was opened: never changed, shared by the document and the jobs.
#pragma once

#include "app/document/dress.h"
#include "app/edit/cage_watch.h"
#include "spatial/bvh.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace cagewright::app {

/// What is known of a model's file. A mesh in memory has none.
struct ModelOrigin {
  std::filesystem::path path;
  FileNormals normals;         ///< as stored in the file, if any
  std::vector<FileNote> notes; ///< what its reader has taken otherwise than it stands there
  std::shared_ptr<const FileDress> dress; ///< materials and textures, if it has any
};

/// One of the files that a model is made of.
struct ModelPart {
  ModelOrigin origin;
  PolygonMesh mesh; ///< as it was read; empty where it is the whole model
  Index first = 0;  ///< its first vertex in the model
  Index count = 0;  ///< V of it
};

struct Model {
  PolygonMesh mesh;                ///< all parts, one after the other
  std::vector<ModelPart> parts;    ///< at least one
  std::vector<Triangle> triangles; ///< T: the faces, cut
  std::vector<Triangle> coarse;    ///< fewer, of the same vertices, to draw while a large model
                                   ///< moves: see coarse_triangles(); none for small models
  std::vector<std::array<Index, 2>> edges; ///< see wire_edges()
  std::vector<Vec3> normals;               ///< V smooth unit normals
  std::shared_ptr<const Dress> dress;      ///< how it is drawn in its own colors; none: as it is
  WatchedPoints watched;                   ///< for the check while the cage is dragged
  TriangleBvh bvh;                         ///< over the triangles
  Box3 box;                                ///< of all vertices
  double diagonal = 1;                     ///< of that box; the unit of all tolerances
  std::filesystem::path path;              ///< of the first part; empty for a mesh in memory
  std::vector<FileNote> notes;             ///< of all parts
  std::uint64_t checksum = 0;              ///< of the positions

  [[nodiscard]] const PolygonMesh& mesh_of(const ModelPart& part) const {
    return parts.size() == 1 ? mesh : part.mesh;
  }
  [[nodiscard]] TriangleView view() const { return {mesh.positions, triangles}; }
};

/// Reads a model and prepares what the application needs of it.
/// Errors: those of read_mesh(); unfit_model (no extent); cancelled.
Result<std::shared_ptr<const Model>> open_model(const std::filesystem::path& path,
                                                const Progress& progress = {});

/// Several files as one model: a skin, its clothes, its eyes, under one cage. Vertices are those of
/// the first file, then of the second, and so on. Errors: the same.
Result<std::shared_ptr<const Model>> open_models(const std::vector<std::filesystem::path>& paths,
                                                 const Progress& progress = {});

/// The same of a mesh in memory.
Result<std::shared_ptr<const Model>> prepare_model(PolygonMesh mesh, ModelOrigin origin,
                                                   const Progress& progress = {});

} // namespace cagewright::app
