#include "app/jobs/work.h"

#include "app/document/binding.h"
#include "app/document/time_line.h"
#include "app/jobs/freed_elsewhere.h"
#include "cage/box_cage.h"
#include "io/atomic_file.h"
#include <cagewright/cage/density.h>
#include <cagewright/cage/generate_for_polygons.h>
#include <cagewright/coordinates/mixed.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/read_vertex_weights.h>
#include <cagewright/io/write_animation.h>
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

namespace fs = std::filesystem;

constexpr double most_weight_bytes = 1.5e9;

/// One weight for each vertex of the model; none: even.
Result<std::vector<double>> density_of(const Model& model, const GenerateSettings& settings,
                                       const SharedDensity& painted) {
  switch (settings.density) {
  case DensitySource::even:
    break;
  case DensitySource::colors:
    return painted_density(model.mesh.colors);
  case DensitySource::painted: {
    if (!painted || painted->size() != model.mesh.positions.size() ||
        std::ranges::all_of(*painted, [](float d) { return d == 0; })) {
      return Error{ErrorCode::invalid_option,
                   "paint where the cage is to be finer (the brush in the tool bar), or let it be "
                   "even"};
    }
    // As colors do: see painted_density().
    std::vector<double> weights(painted->size());
    std::ranges::transform(*painted, weights.begin(),
                           [](float d) { return std::pow(16.0, static_cast<double>(d)); });
    return weights;
  }
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
    } else if (remark.reason == Reason::specks_enclosed) {
      remarks.append(QObject::tr("%1; Cage for: All but Specks leaves them out").arg(message));
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

/// What belongs to a part of the model, of a value for each vertex.
std::span<const Vec3> slice(const std::vector<Vec3>& values, const ModelPart& part) {
  return std::span(values).subspan(part.first, part.count);
}

/// A model in memory has no file whose attributes could be kept.
Result<std::vector<FileNote>> write_shape(PolygonMesh mesh, std::span<const Vec3> positions,
                                          const fs::path& out) {
  mesh.positions.assign(positions.begin(), positions.end());
  const Status written = write_mesh(mesh, out);
  return written ? Result<std::vector<FileNote>>(std::vector<FileNote>()) : written.error();
}

/// Writes one part in all poses. \returns notes about what the first cannot hold
Result<std::vector<FileNote>> write_part(const Model& model, std::size_t number,
                                         const std::vector<std::vector<Vec3>>& poses,
                                         const std::vector<ModelOutput>& outputs,
                                         const Progress& progress) {
  const ModelPart& part = model.parts[number];
  const PolygonMesh& mesh = model.mesh_of(part);
  std::optional<ModelFile> file;
  if (!part.origin.path.empty()) {
    Result<ModelFile> opened = ModelFile::open(part.origin.path);
    if (!opened) {
      return opened.error();
    }
    file = *std::move(opened);
  }
  NormalField normals;
  if (const FileNormals& stored = part.origin.normals; !stored.normals.empty()) {
    normals = NormalField(mesh, {stored.of_corner, stored.normals.size(), stored.normals});
  }
  std::vector<FileNote> notes;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    progress(static_cast<double>(i) / static_cast<double>(outputs.size()), "writing");
    const std::span<const Vec3> positions = slice(poses[i], part);
    normals.update(positions);
    const fs::path out = path_of_part(model, number, outputs[i].path);
    Result<std::vector<FileNote>> written =
        file ? file->write_moved(positions, normals.normals(), out)
             : write_shape(mesh, positions, out);
    if (!written) {
      return written.error();
    }
    if (i == 0) { // the others lose the same
      notes = *std::move(written);
    }
  }
  return notes;
}

} // namespace

Result<MadeCage> make_cage(const CagedModel& caged, const GenerateSettings& settings,
                           const SharedDensity& painted, const Progress& progress) {
  GenerateOptions options = settings.options;
  Result<std::vector<double>> density = std::vector<double>();
  if (options.method != Method::boxes) {
    density = density_of(*caged.whole, settings, painted);
  }
  if (!density) {
    return density.error();
  }
  if (caged.region && !density->empty()) {
    density = gathered<double>(*caged.region, *density);
  }
  options.density = *density;
  Result<GeneratedCage> made = generate_for_polygons(caged.model().mesh, options, progress);
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

namespace {

/// How much of the second kind each vertex takes of what the cage is for.
std::vector<double> shares_of(const CagedModel& caged, const SharedShares& painted) {
  std::vector<double> shares(painted->begin(), painted->end());
  return caged.region ? gathered<double>(*caged.region, shares) : shares;
}

/// The cage made ready for the kinds that have a part in it, and for the model's vertices.
Result<std::shared_ptr<const Coordinates>> prepare(const CagedModel& caged, const PolygonMesh& cage,
                                                   const CoordinateChoice& choice,
                                                   PreparedKinds& kinds, const Progress& progress) {
  if (choice.second) { // before the work, and before something is painted: whether they mix at all
    CoordinateSettings both = choice.first;
    both.mix_with(*choice.second);
    if (const auto rule = coordinate_rule(cage, both); !rule) {
      return rule.error();
    }
  }
  const auto make = [&](std::shared_ptr<const Coordinates>& kind,
                        const CoordinateSettings& settings, const Progress& part) -> Status {
    if (!kind) {
      auto made = prepare_coordinates(cage, settings, part);
      if (!made) {
        return made.error();
      }
      kind = *std::move(made);
    }
    return success();
  };
  if (Status s = make(kinds.first, choice.first, progress.part(0, 0.5)); !s) {
    return s.error();
  }
  if (!choice.mixes()) {
    return kinds.first;
  }
  if (Status s = make(kinds.second, *choice.second, progress.part(0.5, 1)); !s) {
    return s.error();
  }
  return mixed_coordinates(kinds.first, kinds.second, caged.model().mesh.positions,
                           shares_of(caged, choice.shares));
}

} // namespace

Result<std::shared_ptr<const Binding>> bind_model(const CagedModel& caged, const PolygonMesh& cage,
                                                  const CoordinateChoice& choice,
                                                  const Progress& progress,
                                                  PreparedKinds prepared) {
  const Model& model = caged.model();
  const auto coordinates = prepare(caged, cage, choice, prepared, progress.part(0, 0.45));
  if (!coordinates) {
    return coordinates.error();
  }
  DeformerOptions options;
  const double bytes = 4.0 * static_cast<double>(model.mesh.positions.size()) *
                       static_cast<double>((*coordinates)->columns());
  if (bytes > most_weight_bytes) {
    options.storage = WeightStorage::compact;
  }
  Result<Deformer> deformer =
      Deformer::bind(model.mesh, **coordinates, options, {}, progress.part(0.45, 0.95));
  if (!deformer) {
    return deformer.error();
  }
  const Result<UnseenShare> unseen =
      unseen_share(cage, **coordinates, model.mesh.positions, progress.part(0.95, 1));
  if (!unseen) {
    return unseen.error();
  }
  return freed_elsewhere(std::make_shared<const Binding>(*std::move(deformer), choice, *coordinates,
                                                         caged, *unseen, std::move(prepared)));
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
  judged.offending_faces.erase(
      std::unique(judged.offending_faces.begin(), judged.offending_faces.end()),
      judged.offending_faces.end());
  std::erase_if(judged.offending_faces, [&](Index f) { return f >= cage.face_count(); });
  judged.report = std::make_shared<const ValidityReport>(std::move(*report));
  return judged;
}

fs::path path_of_part(const Model& model, std::size_t part, const fs::path& path) {
  if (model.parts.size() == 1) {
    return path;
  }
  // Parts of one name are told apart by their number.
  const auto stem_of = [](const ModelPart& p) { return p.origin.path.stem().string(); };
  const std::string stem = stem_of(model.parts[part]);
  const bool is_only = std::ranges::count(model.parts, stem, stem_of) == 1;
  return path.parent_path() /
         (path.stem().string() + "-" + stem + (is_only ? "" : "-" + std::to_string(part + 1)) +
          path.extension().string());
}

Result<std::vector<FileNote>> export_models(const CagedModel& caged, const Coordinates& coordinates,
                                            const std::vector<ModelOutput>& outputs,
                                            const Progress& progress) {
  std::vector<std::vector<Vec3>> poses;
  for (const ModelOutput& output : outputs) {
    poses.push_back(*output.cage);
  }
  const Result<StreamedPoses> moved =
      deform_streaming(coordinates, poses, caged.model().mesh.positions, progress.part(0, 0.8));
  if (!moved) {
    return moved.error();
  }
  const Model& model = *caged.whole;
  std::vector<std::vector<Vec3>> shapes;
  for (const std::vector<Vec3>& shape : moved->positions) {
    shapes.push_back(caged.positions(shape));
  }
  std::vector<FileNote> notes;
  for (std::size_t part = 0; part < model.parts.size(); ++part) {
    const Progress share = progress.part(
        0.8 + 0.2 * static_cast<double>(part) / static_cast<double>(model.parts.size()), 1);
    Result<std::vector<FileNote>> written = write_part(model, part, shapes, outputs, share);
    if (!written) {
      return written.error();
    }
    notes.insert(notes.end(), written->begin(), written->end());
  }
  return notes;
}

Status export_animation(const CagedModel& caged, const Coordinates& coordinates,
                        const TimeLine& time_line, const std::filesystem::path& path,
                        const Progress& progress) {
  std::vector<std::vector<Vec3>> keys;
  for (const Keyframe& key : time_line.keys) {
    keys.push_back(*key.positions);
  }
  Result<StreamedPoses> moved =
      deform_streaming(coordinates, keys, caged.model().mesh.positions, progress.part(0, 0.6));
  if (!moved) {
    return moved.error();
  }
  const Model& model = *caged.whole;
  std::vector<std::vector<Vec3>> shapes;
  for (const std::vector<Vec3>& shape : moved->positions) {
    shapes.push_back(caged.positions(shape));
  }
  std::vector<std::vector<double>> shares;
  for (int frame = time_line.first; frame <= time_line.last; ++frame) {
    shares.push_back(key_shares(time_line, frame));
  }
  for (std::size_t number = 0; number < model.parts.size(); ++number) {
    const ModelPart& part = model.parts[number];
    MovingMesh moving;
    moving.rest = model.mesh_of(part);
    const std::span<const Vec3> at_rest = slice(model.normals, part);
    moving.rest_normals.assign(at_rest.begin(), at_rest.end());
    NormalField normals(moving.rest, smooth_normals(moving.rest));
    for (const std::vector<Vec3>& shape : shapes) {
      const std::span<const Vec3> positions = slice(shape, part);
      moving.shapes.emplace_back(positions.begin(), positions.end());
      normals.update(positions);
      moving.normals.emplace_back(normals.normals().begin(), normals.normals().end());
    }
    if (const Result<ModelFile> file = ModelFile::open(part.origin.path);
        file) { // how it is dressed
      if (Result<MeshAttributes> dress = file->attributes();
          dress && file->mesh().positions.size() == moving.rest.positions.size()) {
        moving.attributes = *std::move(dress);
      }
    }
    moving.shares = shares;
    moving.first_frame = time_line.first;
    moving.frames_per_second = time_line.frames_per_second;
    if (Status s =
            write_animation(moving, path_of_part(model, number, path), progress.part(0.6, 1));
        !s) {
      return s;
    }
  }
  return success();
}

Status export_weights(const CagedModel& caged, const PolygonMesh& cage,
                      const CoordinateChoice& choice, const std::filesystem::path& path,
                      const Progress& progress) {
  PreparedKinds kinds;
  const auto coordinates = prepare(caged, cage, choice, kinds, progress.part(0, 0.2));
  if (!coordinates) {
    return coordinates.error();
  }
  const Result<PointCounts> written =
      bind_to_file(**coordinates, choice.settings(), caged.model().mesh.positions, cage, path,
                   progress.part(0.2, 1));
  return written ? success() : Status(written.error());
}

Status export_mix(const Model& model, const SharedShares& mix, const fs::path& path) {
  for (std::size_t number = 0; number < model.parts.size(); ++number) {
    const ModelPart& part = model.parts[number];
    std::string text;
    for (const float share : std::span(*mix).subspan(part.first, part.count)) {
      text += QByteArray::number(share, 'g', 9).toStdString() + '\n';
    }
    if (Status s = write_file_atomically(path_of_part(model, number, path), text); !s) {
      return s;
    }
  }
  return success();
}

} // namespace cagewright::app
