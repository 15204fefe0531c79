/// \file
/// Two kinds of coordinates mixed by a weight for each point: one for limbs, another for the trunk.
#pragma once

#include <cagewright/coordinates/columns.h>
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>
#include <span>

namespace cagewright {

/// Where a point goes is (1 - share) of where the first takes it and share of where the second
/// does. The columns are those of the first and then those of the second, or those of the cage's
/// vertices once where neither has others.
///
/// Errors: invalid_option (points are divided by one of them, see ColumnDivisor).
Result<std::shared_ptr<const ColumnRule>> mixed_rule(std::shared_ptr<const ColumnRule> first,
                                                     std::shared_ptr<const ColumnRule> second);

/// Coordinates of these points alone; others are undefined. What a kind says of points of which its
/// share is 0 does not matter. Points at one place, as at seams, take the mean of their shares, so
/// that they stay together.
///
/// \param points  P
/// \param shares  P, of the second in [0, 1]
/// Errors: those of mixed_rule().
/// Cost: that of both, and a search among the points.
Result<std::shared_ptr<const Coordinates>>
mixed_coordinates(std::shared_ptr<const Coordinates> first,
                  std::shared_ptr<const Coordinates> second, std::span<const Vec3> points,
                  std::span<const double> shares);

/// The cage prepared for settings with CoordinateSettings::mixed().
/// Errors: those of prepare_coordinates() and of mixed_rule().
Result<std::shared_ptr<const Coordinates>> prepare_mixed(const PolygonMesh& cage,
                                                         const CoordinateSettings& settings,
                                                         std::span<const Vec3> points,
                                                         std::span<const double> shares,
                                                         const Progress& progress = {});

} // namespace cagewright
