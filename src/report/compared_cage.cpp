#include "report/compared_cage.h"

#include "report/cage_figures.h"

#include <utility>

namespace cagewright {

Result<ComparedCage> compare_cage(const std::string& name, const PolygonMesh& cage,
                                  TriangleView model, const ModelVolume& volume,
                                  const CoordinateSettings* poses, const Progress& progress) {
  ComparedCage compared;
  compared.name = name;
  compared.faces = cage.face_count();
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    compared.quads += cage.face(f).size() == 4 ? 1 : 0;
  }
  Result<ValidityReport> report = validate_cage(
      cage, model, {.allow_pieces = true, .weld = true, .max_listed = 0}, progress.part(0, 0.4));
  if (!report) {
    return report.error();
  }
  compared.validity = std::move(*report);
  compared.metrics = measure_cage(cage, model, volume);
  if (poses != nullptr) {
    const Result<PoseErrors> errors =
        pose_errors(cage, model.positions, *poses, progress.part(0.6, 1));
    if (errors) {
      compared.poses = *errors;
    } else if (errors.error().code == ErrorCode::cancelled) {
      return errors.error();
    }
  }
  return compared;
}

nlohmann::json json_of(const ComparedCage& cage) {
  nlohmann::json json = figures_as_json(cage.metrics);
  json["file"] = cage.name;
  json["valid"] = cage.validity.valid();
  json["triangles"] = cage.metrics.faces;
  json["faces"] = cage.faces;
  json["quads"] = cage.quads;
  json["violations"] = nlohmann::json::object();
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (cage.validity.counts[k] > 0) {
      json["violations"][name_of(static_cast<ViolationKind>(k))] = cage.validity.counts[k];
    }
  }
  json["poses"] = nullptr;
  if (cage.poses) {
    json["poses"] = {{"undefined", cage.poses->undefined}, {"outside", cage.poses->outside}};
    for (const StandardPose pose : standard_poses) {
      const PoseError& error = cage.poses->of[static_cast<std::size_t>(pose)];
      json["poses"][std::string(name_of(pose))] = {{"mean_error", error.mean},
                                                   {"max_error", error.max}};
    }
  }
  return json;
}

} // namespace cagewright
