#include "app/jobs/work.h"

#include "app/document/binding.h"
#include "cage/box_cage.h"
#include <cagewright/cage/density.h>
#include <cagewright/cage/generate.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/read_vertex_weights.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>

#include <QStringList>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace cagewright::app {
namespace {

constexpr double most_weight_bytes = 1.5e9;

/// One weight for each vertex of the model; none: even.
Result<std::vector<double>> density_of(const Model& model, const GenerateSettings& settings) {
  switch (settings.density) {
  case DensitySource::even:
    break;
  case DensitySource::colors:
    return painted_density(model.mesh.colors);
  case DensitySource::file: {
    if (settings.density_file.isEmpty()) {
      return Error{ErrorCode::invalid_option,
                   "choose the file that says where the cage is to be finer, or let it be even"};
    }
    Result<std::vector<double>> weights =
        read_vertex_weights(settings.density_file.toStdString(), model.mesh.positions.size());
    return weights ? density_of_weights(std::move(*weights)) : weights;
  }
  }
  return std::vector<double>();
}

QString remark_of(const GeneratedCage& made, const GenerateOptions& options) {
  QStringList remarks;
  for (const Remark& remark : made.remarks) {
    const QString message = QString::fromStdString(remark.message);
    if (remark.is_shortfall) {
      remarks.append(QObject::tr("not as asked for: %1").arg(message));
    } else if (remark.reason == Reason::not_mirrored) {
      remarks.append(QObject::tr("not mirrored: %1").arg(message));
    } else {
      remarks.append(message);
    }
  }
  if (made.quads && options.quads) {
    remarks.append(
        QObject::tr("%1 % of the faces are quads").arg(std::lround(100 * made.quads->share)));
  }
  return remarks.join("; ");
}

} // namespace

Result<MadeCage> make_cage(const Model& model, const GenerateSettings& settings,
                           const Progress& progress) {
  GenerateOptions options = settings.options;
  Result<std::vector<double>> density = std::vector<double>();
  if (options.method != Method::boxes) {
    density = density_of(model, settings);
  }
  if (!density) {
    return density.error();
  }
  options.density = *density;
  Result<GeneratedCage> made = generate(model.view(), options, progress);
  if (!made) {
    return made.error();
  }
  MadeCage result{std::make_shared<const PolygonMesh>(std::move(made->faces)), nullptr,
                  remark_of(*made, options)};
  if (made->box_tree) {
    result.stages = std::shared_ptr<const BoxDecomposition>(made->box_tree, &made->box_tree->boxes);
  }
  return result;
}

Result<std::shared_ptr<const BoxDecomposition>>
make_stages(const Model& model, const GenerateSettings& settings, const Progress& progress) {
  Result<BoxDecomposition> boxes =
      decompose(model.view(), decompose_options(settings.options), progress);
  if (!boxes) {
    return boxes.error();
  }
  return std::make_shared<const BoxDecomposition>(std::move(*boxes));
}

Result<std::shared_ptr<const PolygonMesh>> read_cage(const std::filesystem::path& path) {
  Result<PolygonMesh> mesh = read_mesh(path);
  if (!mesh) {
    return mesh.error();
  }
  return std::make_shared<const PolygonMesh>(weld(*mesh));
}

Result<std::shared_ptr<const Binding>> bind_model(const Model& model, const PolygonMesh& cage,
                                                  const Progress& progress) {
  DeformerOptions options;
  const double bytes = 4.0 * static_cast<double>(model.mesh.positions.size()) *
                       static_cast<double>(cage.positions.size());
  if (bytes > most_weight_bytes) {
    options.storage = WeightStorage::compact;
  }
  Result<Deformer> deformer = Deformer::bind(model.mesh, cage, options, {}, progress);
  if (!deformer) {
    return deformer.error();
  }
  return std::make_shared<const Binding>(std::move(*deformer));
}

Result<JudgedCage> judge_cage(const PolygonMesh& cage, const Model* model,
                              const Progress& progress) {
  Result<ValidityReport> report =
      validate_cage(cage, model != nullptr ? model->view() : TriangleView{},
                    {.allow_pieces = false, .max_listed = 500, .first_only = false}, progress);
  if (!report) {
    return report.error();
  }
  JudgedCage judged;
  for (const Violation& violation : report->violations) {
    switch (violation.kind) {
    case ViolationKind::bad_corner:
    case ViolationKind::degenerate_face:
    case ViolationKind::folded_face:
    case ViolationKind::duplicate_face:
      judged.offending_faces.push_back(violation.elements[0]);
      break;
    case ViolationKind::self_intersection:
      judged.offending_faces.insert(judged.offending_faces.end(), violation.elements.begin(),
                                    violation.elements.end());
      break;
    case ViolationKind::vertex_on_cage:
    case ViolationKind::face_contact:
      judged.offending_faces.push_back(violation.elements[1]);
      break;
    default:
      break;
    }
  }
  std::ranges::sort(judged.offending_faces);
  const auto repeated = std::ranges::unique(judged.offending_faces);
  judged.offending_faces.erase(repeated.begin(), repeated.end());
  std::erase_if(judged.offending_faces, [&](Index f) { return f >= cage.face_count(); });
  judged.report = std::make_shared<const ValidityReport>(std::move(*report));
  return judged;
}

namespace {

/// A model in memory has no file whose attributes could be kept.
Result<std::vector<FileNote>> write_shape(const Model& model, std::span<const Vec3> positions,
                                          const std::filesystem::path& out) {
  PolygonMesh moved = model.mesh;
  moved.positions.assign(positions.begin(), positions.end());
  const Status written = write_mesh(moved, out);
  return written ? Result<std::vector<FileNote>>(std::vector<FileNote>()) : written.error();
}

} // namespace

Result<std::vector<FileNote>> export_models(const Model& model, const PolygonMesh& cage_at_rest,
                                            const std::vector<ModelOutput>& outputs,
                                            const Progress& progress) {
  const auto coordinates = prepare_coordinates(cage_at_rest, {}, progress.part(0, 0.2));
  if (!coordinates) {
    return coordinates.error();
  }
  std::vector<std::vector<Vec3>> poses;
  for (const ModelOutput& output : outputs) {
    poses.push_back(*output.cage);
  }
  const Result<StreamedPoses> moved =
      deform_streaming(**coordinates, poses, model.mesh.positions, progress.part(0.2, 0.8));
  if (!moved) {
    return moved.error();
  }
  std::optional<ModelFile> file;
  if (!model.path.empty()) {
    Result<ModelFile> opened = ModelFile::open(model.path);
    if (!opened) {
      return opened.error();
    }
    file = *std::move(opened);
  }
  NormalField normals;
  if (const FileNormals& stored = model.file_normals; !stored.normals.empty()) {
    normals = NormalField(model.mesh, {stored.of_corner, stored.normals.size(), stored.normals});
  }
  std::vector<FileNote> notes;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    progress(0.8 + 0.2 * static_cast<double>(i) / static_cast<double>(outputs.size()), "writing");
    normals.update(moved->positions[i]);
    Result<std::vector<FileNote>> written =
        file ? file->write_moved(moved->positions[i], normals.normals(), outputs[i].path)
             : write_shape(model, moved->positions[i], outputs[i].path);
    if (!written) {
      return written.error();
    }
    if (i == 0) { // the others lose the same
      notes = *std::move(written);
    }
  }
  return notes;
}

Status export_weights(const Model& model, const PolygonMesh& cage,
                      const std::filesystem::path& path, const Progress& progress) {
  const CoordinateSettings settings;
  const auto coordinates = prepare_coordinates(cage, settings, progress.part(0, 0.2));
  if (!coordinates) {
    return coordinates.error();
  }
  const Result<PointCounts> written = bind_to_file(**coordinates, settings, model.mesh.positions,
                                                   cage, path, progress.part(0.2, 1));
  return written ? success() : Status(written.error());
}

} // namespace cagewright::app
