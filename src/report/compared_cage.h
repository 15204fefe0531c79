/// \file
/// What is said of a cage when it is compared with others.
#pragma once

#include "report/limb_bends.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/deform/following.h>
#include <cagewright/deform/standard_poses.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/model_volume.h>
#include <cagewright/validate/validate_cage.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

/// All that is said of one cage.
struct ComparedCage {
  std::string name; ///< of its file
  ValidityReport validity;
  std::size_t faces = 0; ///< as the file has them
  std::size_t quads = 0;
  CageMetrics metrics;
  std::string coordinates;         ///< by which it was tried; empty without `poses`
  std::optional<PoseErrors> poses; ///< none: not asked for, or the cage cannot carry a model
  std::array<DeformedFigures, standard_poses.size()> posed; ///< with `poses`
  UnseenShare unseen;                                       ///< with `poses`
  std::vector<LimbBendError> bends;                         ///< with `poses`, by limb
};

/// Judges and measures a cage, and tries how well it bends and twists its model.
///
/// \param name    what it is called in the result
/// \param volume  of the model
/// \param poses   the coordinates by which the model follows; null: leave out how well
/// \param limbs   of the model, to be bent with `poses`; null: no limb is bent
/// Errors: cancelled.
Result<ComparedCage> compare_cage(const std::string& name, const PolygonMesh& cage,
                                  TriangleView model, const ModelVolume& volume,
                                  const CoordinateSettings* poses, const BendableLimbs* limbs,
                                  const Progress& progress);

/// \param limbs  as in compare_cage()
nlohmann::json json_of(const ComparedCage& cage, const BendableLimbs* limbs);

} // namespace cagewright
