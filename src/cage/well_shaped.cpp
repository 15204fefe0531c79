#include "cage/well_shaped.h"

#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr double needle = 0.03; // 2 r / R
constexpr double thin = 0.15;

/// What decides between two cages: greater is better, and the greatest are all alike.
std::tuple<bool, double, double> merit(const Improved& improved) {
  const TriangleMesh& cage = improved.cage;
  std::vector<double> quality;
  for (const Triangle& t : cage.triangles) {
    quality.push_back(
        triangle_quality(cage.positions[t[0]], cage.positions[t[1]], cage.positions[t[2]]));
  }
  const auto low = quality.begin() + static_cast<std::ptrdiff_t>(quality.size() / 20);
  std::nth_element(quality.begin(), low, quality.end());
  const double least = *std::min_element(quality.begin(), low + 1);
  return {improved.report.reached, std::min(least, needle), std::min(*low, thin)};
}

bool is_well_shaped(const Improved& improved) {
  const auto [reached, least, low] = merit(improved);
  return least == needle && low == thin;
}

} // namespace

Result<Improved> improve_well_shaped(TriangleView start, TriangleView model,
                                     const ImproveOptions& options, const Progress& progress) {
  constexpr std::array<double, 2> dearer = {2, 4};
  double done = 0.8; // of the time: hardly ever is there another try
  Result<Improved> best = improve(start, model, options, progress.part(0, done));
  for (const double factor : dearer) {
    if (!best || !best->report.reached || is_well_shaped(*best)) {
      break;
    }
    ImproveOptions rounder = options;
    rounder.shape *= factor;
    const double then = (done + 1) / 2;
    Result<Improved> again = improve(start, model, rounder, progress.part(done, then));
    done = then;
    if (!again || merit(*again) > merit(*best)) {
      best = std::move(again);
    }
  }
  return best;
}

} // namespace cagewright
