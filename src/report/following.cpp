#include "report/following.h"

#include <cmath>

namespace cagewright {
namespace {

/// JSON has no number for what is not finite.
nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

} // namespace

nlohmann::json json_of(const UnseenShare& share) {
  return {{"mean", share.mean}, {"p95", share.high}, {"points", share.points}};
}

nlohmann::json json_of(const DeformedFigures& figures) {
  return {
      {"mean_stretch", finite(figures.mean_stretch)}, {"p95_stretch", finite(figures.high_stretch)},
      {"max_stretch", finite(figures.max_stretch)},   {"volume_change", figures.volume_change},
      {"flipped_triangles", figures.flipped},         {"triangles_in_contact", figures.in_contact}};
}

} // namespace cagewright
