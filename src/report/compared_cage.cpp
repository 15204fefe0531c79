#include "report/compared_cage.h"

#include "report/cage_figures.h"
#include "report/following.h"

#include <cagewright/mesh/triangulate.h>

#include <utility>

namespace cagewright {
namespace {

/// How well the model follows; an error only if it was cancelled.
Status try_poses(const PolygonMesh& cage, TriangleView model, CoordinateSettings settings,
                 const BendableLimbs* limbs, const Progress& progress, ComparedCage& compared) {
  const auto passed = [](const Error& error) {
    return error.code == ErrorCode::cancelled ? Status(error) : success();
  };
  settings.allow_open = true;
  const auto coordinates = prepare_coordinates(cage, settings, progress.part(0, 0.2));
  if (!coordinates) {
    return passed(coordinates.error());
  }
  Result<PoseErrors> errors = pose_errors(**coordinates, model.positions, progress.part(0.2, 0.6));
  if (!errors) {
    return passed(errors.error());
  }
  const Result<UnseenShare> unseen =
      unseen_share(cage, **coordinates, model.positions, progress.part(0.6, 0.7));
  if (!unseen) {
    return passed(unseen.error());
  }
  if (limbs != nullptr) {
    Result<std::vector<LimbBendError>> bends = limb_bend_errors(
        **coordinates, to_triangle_mesh(cage), model.positions, *limbs, progress.part(0.7, 1));
    if (!bends) {
      return passed(bends.error());
    }
    compared.bends = *std::move(bends);
  }
  for (std::size_t k = 0; k < standard_poses.size(); ++k) {
    compared.posed[k] = deformed_figures(model, errors->followed[k]);
  }
  compared.coordinates = settings.name();
  compared.unseen = *unseen;
  compared.poses = *std::move(errors);
  return success();
}

} // namespace

Result<ComparedCage> compare_cage(const std::string& name, const PolygonMesh& cage,
                                  TriangleView model, const ModelVolume& volume,
                                  const CoordinateSettings* poses, const BendableLimbs* limbs,
                                  const Progress& progress) {
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
    if (const Status status =
            try_poses(cage, model, *poses, limbs, progress.part(0.6, 1), compared);
        !status) {
      return status.error();
    }
  }
  return compared;
}

nlohmann::json json_of(const ComparedCage& cage, const BendableLimbs* limbs) {
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
    json["poses"]["coordinates"] = cage.coordinates;
    json["poses"]["unseen_share"] = json_of(cage.unseen);
    for (const StandardPose pose : standard_poses) {
      const PoseError& error = cage.poses->of[static_cast<std::size_t>(pose)];
      json["poses"][std::string(name_of(pose))] = {{"mean_error", error.mean},
                                                   {"max_error", error.max}};
      json["poses"][std::string(name_of(pose))].update(
          json_of(cage.posed[static_cast<std::size_t>(pose)]));
    }
  }
  if (cage.poses && limbs != nullptr) {
    json["poses"]["limbs"] = json_of(*limbs, cage.bends);
  }
  return json;
}

} // namespace cagewright
