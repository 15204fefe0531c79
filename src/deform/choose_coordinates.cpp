#include <cagewright/deform/choose_coordinates.h>

#include "deform/some_points.h"
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/deform/following.h>
#include <cagewright/deform/standard_poses.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace cagewright {
namespace {

TriedKind refused(const CoordinateKind& kind, const std::string& why) {
  TriedKind tried;
  tried.kind = &kind;
  tried.refusal = why;
  return tried;
}

/// Errors: cancelled; what else goes wrong is a refusal.
Result<TriedKind> attempt(const CoordinateKind& kind, const PolygonMesh& cage,
                          std::span<const Vec3> points, const Progress& progress) {
  const auto failed = [&](const Error& error) -> Result<TriedKind> {
    if (error.code == ErrorCode::cancelled) {
      return error;
    }
    return refused(kind, error.message);
  };
  CoordinateSettings settings(kind);
  settings.allow_open = true;
  const auto coordinates = prepare_coordinates(cage, settings, progress.part(0, 0.5));
  if (!coordinates) {
    return failed(coordinates.error());
  }
  const Result<PoseErrors> errors = pose_errors(**coordinates, points, progress.part(0.5, 0.8));
  if (!errors) {
    return failed(errors.error());
  }
  if (errors->outside + errors->undefined > 0) {
    return refused(kind, "vertices of the model have no weights");
  }
  const Result<UnseenShare> unseen =
      unseen_share(cage, **coordinates, points, progress.part(0.8, 1));
  if (!unseen) {
    return failed(unseen.error());
  }
  TriedKind tried;
  tried.kind = &kind;
  tried.bend = errors->of[static_cast<std::size_t>(StandardPose::bend)].mean;
  tried.twist = errors->of[static_cast<std::size_t>(StandardPose::twist)].mean;
  tried.drag = drag_per_share * unseen->mean;
  return tried;
}

} // namespace

Result<ChosenCoordinates> choose_coordinates(const PolygonMesh& cage, std::span<const Vec3> model,
                                             const Progress& progress) {
  const std::vector<Vec3> points = some_points(model);
  ChosenCoordinates chosen;
  const std::span<const CoordinateKind* const> kinds = coordinate_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const auto share = static_cast<double>(kinds.size());
    Result<TriedKind> tried =
        attempt(*kinds[i], cage, points,
                progress.part(static_cast<double>(i) / share, static_cast<double>(i + 1) / share));
    if (!tried) {
      return tried.error();
    }
    chosen.tried.push_back(*std::move(tried));
  }
  std::stable_sort(
      chosen.tried.begin(), chosen.tried.end(), [](const TriedKind& a, const TriedKind& b) {
        return a.refusal.empty() != b.refusal.empty() ? a.refusal.empty()
                                                      : a.refusal.empty() && a.cost() < b.cost();
      });
  const TriedKind& best = chosen.tried.front();
  if (!best.refusal.empty()) {
    return Error{ErrorCode::invalid_cage, best.refusal};
  }
  chosen.settings = CoordinateSettings(*best.kind);
  return chosen;
}

} // namespace cagewright
