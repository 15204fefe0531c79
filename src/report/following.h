/// \file
/// How well a model follows its cage, as JSON.
#pragma once

#include <cagewright/deform/following.h>

#include <nlohmann/json.hpp>

namespace cagewright {

/// An object with mean, p95 and points.
nlohmann::json json_of(const UnseenShare& share);

/// An object with mean_stretch, p95_stretch, max_stretch (null: a triangle has lost its area),
/// volume_change and flipped_triangles.
nlohmann::json json_of(const DeformedFigures& figures);

} // namespace cagewright
