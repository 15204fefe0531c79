#include "app/document/model.h"

#include "app/document/coarse_triangles.h"
#include <cagewright/deform/normals.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <utility>

namespace cagewright::app {
namespace {

// Any processor draws so many triangles thirty times a second.
constexpr std::size_t drawn_at_once = 60000;
constexpr std::size_t large = 150000;

} // namespace

Result<std::shared_ptr<const Model>> open_model(const std::filesystem::path& path,
                                                const Progress& progress) {
  progress(0, "reading");
  Result<ModelFile> file = ModelFile::open(path);
  if (!file) {
    return file.error();
  }
  Result<FileNormals> normals = file->normals();
  if (!normals) {
    return normals.error();
  }
  ModelOrigin origin{path, *std::move(normals), {file->notes().begin(), file->notes().end()}};
  return prepare_model(std::move(*file).take_mesh(), std::move(origin), progress.part(0.5, 1));
}

Result<std::shared_ptr<const Model>> prepare_model(PolygonMesh mesh, ModelOrigin origin,
                                                   const Progress& progress) {
  auto model = std::make_shared<Model>();
  model->mesh = std::move(mesh);
  model->path = std::move(origin.path);
  model->file_normals = std::move(origin.normals);
  model->notes = std::move(origin.notes);
  model->box = bounding_box(model->mesh.positions);
  model->diagonal = diagonal(model->mesh.positions);
  if (!(model->diagonal > 0)) {
    return Error{ErrorCode::unfit_model, model->path.string() + ": the model has no extent"};
  }
  progress(0, "cutting faces into triangles");
  model->triangles = triangulate(model->mesh).triangles;
  if (model->triangles.size() > large) {
    model->coarse = coarse_triangles(model->view(), drawn_at_once);
  }
  progress(0.2, "normals");
  const NormalField normals(model->mesh, smooth_normals(model->mesh));
  model->normals.assign(normals.normals().begin(), normals.normals().end());
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(0.5, "hierarchy of boxes");
  model->bvh = TriangleBvh(model->view());
  model->checksum = checksum(model->mesh.positions);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(1, "done");
  return std::shared_ptr<const Model>(std::move(model));
}

} // namespace cagewright::app
