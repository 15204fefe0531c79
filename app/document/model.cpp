#include "app/document/model.h"

#include "app/document/coarse_triangles.h"
#include "app/document/wire_edges.h"
#include <cagewright/deform/normals.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace cagewright::app {
namespace {

// Any processor draws so many triangles thirty times a second.
constexpr std::size_t drawn_at_once = 60000;
constexpr std::size_t large = 150000;

/// All meshes as one; colors only if one of them has any, white for the others. Groups go.
PolygonMesh joined(std::vector<ModelPart>& parts) {
  if (parts.size() == 1) {
    return std::exchange(parts.front().mesh, {});
  }
  PolygonMesh all;
  const bool colored =
      std::ranges::any_of(parts, [](const ModelPart& p) { return !p.mesh.colors.empty(); });
  std::vector<Index> corners;
  for (ModelPart& part : parts) {
    part.first = static_cast<Index>(all.positions.size());
    all.positions.insert(all.positions.end(), part.mesh.positions.begin(),
                         part.mesh.positions.end());
    if (colored) {
      all.colors.insert(all.colors.end(), part.mesh.colors.begin(), part.mesh.colors.end());
      all.colors.resize(all.positions.size(), {1, 1, 1, 1});
    }
    for (std::size_t f = 0; f < part.mesh.face_count(); ++f) {
      const std::span<const Index> face = part.mesh.face(f);
      corners.assign(face.begin(), face.end());
      for (Index& v : corners) {
        v += part.first;
      }
      all.add_face(corners);
    }
  }
  return all;
}

ModelPart part_of(PolygonMesh mesh, ModelOrigin origin) {
  const auto count = static_cast<Index>(mesh.positions.size());
  return {std::move(origin), std::move(mesh), 0, count};
}

std::shared_ptr<const Dress> dress_of(const Model& model, const Triangulation& cut) {
  std::vector<DressedPart> parts;
  for (const ModelPart& part : model.parts) {
    parts.push_back({part.origin.dress.get(), &model.mesh_of(part), part.first});
  }
  return std::ranges::any_of(parts, [](const DressedPart& p) { return p.dress != nullptr; })
             ? make_dress(parts, cut, model.mesh.colors, model.coarse, model.edges)
             : nullptr;
}

Result<std::shared_ptr<const Model>> prepared(std::vector<ModelPart> parts,
                                              const Progress& progress) {
  auto model = std::make_shared<Model>();
  model->mesh = joined(parts);
  model->path = parts.front().origin.path;
  for (const ModelPart& part : parts) {
    model->notes.insert(model->notes.end(), part.origin.notes.begin(), part.origin.notes.end());
  }
  model->parts = std::move(parts);
  model->box = bounding_box(model->mesh.positions);
  model->diagonal = diagonal(model->mesh.positions);
  if (!(model->diagonal > 0)) {
    return Error{ErrorCode::unfit_model, model->path.string() + ": the model has no extent"};
  }
  progress(0, "cutting faces into triangles");
  Triangulation cut = triangulate(model->mesh);
  model->triangles = cut.triangles;
  if (model->triangles.size() > large) {
    model->coarse = coarse_triangles(model->view(), drawn_at_once);
  }
  model->edges = wire_edges(model->mesh);
  model->dress = dress_of(*model, cut);
  progress(0.2, "normals");
  const NormalField normals(model->mesh, smooth_normals(model->mesh));
  model->normals.assign(normals.normals().begin(), normals.normals().end());
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(0.5, "hierarchy of boxes");
  model->bvh = TriangleBvh(model->view());
  model->watched = WatchedPoints(model->view());
  model->checksum = checksum(model->mesh.positions);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(1, "done");
  return std::shared_ptr<const Model>(std::move(model));
}

} // namespace

Result<std::shared_ptr<const Model>> open_model(const std::filesystem::path& path,
                                                const Progress& progress) {
  return open_models({path}, progress);
}

Result<std::shared_ptr<const Model>> open_models(const std::vector<std::filesystem::path>& paths,
                                                 const Progress& progress) {
  progress(0, "reading");
  std::vector<ModelPart> parts;
  for (const std::filesystem::path& path : paths) {
    Result<ModelFile> file = ModelFile::open(path);
    if (!file) {
      return file.error();
    }
    Result<FileNormals> normals = file->normals();
    if (!normals) {
      return normals.error();
    }
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    ModelOrigin origin{
        path, *std::move(normals), {file->notes().begin(), file->notes().end()}, nullptr};
    if (Result<MeshAttributes> attributes = file->attributes()) {
      if (std::optional<FileDress> dress = read_dress(path, *std::move(attributes))) {
        origin.dress = std::make_shared<const FileDress>(*std::move(dress));
      }
    }
    parts.push_back(part_of(std::move(*file).take_mesh(), std::move(origin)));
  }
  return prepared(std::move(parts), progress.part(0.5, 1));
}

Result<std::shared_ptr<const Model>> prepare_model(PolygonMesh mesh, ModelOrigin origin,
                                                   const Progress& progress) {
  std::vector<ModelPart> parts;
  parts.push_back(part_of(std::move(mesh), std::move(origin)));
  return prepared(std::move(parts), progress);
}

} // namespace cagewright::app
