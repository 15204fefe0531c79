#include "validate/greatest_gap.h"

#include "core/parallel.h"
#include "spatial/distance.h"

#include <algorithm>
#include <array>
#include <vector>

namespace cagewright {
namespace {

using Corners = std::array<Vec3, 3>;

Vec3 center_of(const Corners& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

double radius_of(const Corners& t) {
  const Vec3 c = center_of(t);
  return std::max({(t[0] - c).norm(), (t[1] - c).norm(), (t[2] - c).norm()});
}

void take(GreatestGap& best, double distance, const Vec3& place) {
  if (distance > best.lower) {
    best.lower = distance;
    best.place = place;
  }
}

Corners corners_of(TriangleView surface, const Triangle& t) {
  return {surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]};
}

/// Of one triangle, given that some other point attains `floor`.
GreatestGap gap_of(const Corners& triangle, const TriangleBvh& model, double floor,
                   double tolerance) {
  GreatestGap best;
  std::vector<Corners> waiting = {triangle};
  while (!waiting.empty()) {
    const Corners t = waiting.back();
    waiting.pop_back();
    const Vec3 center = center_of(t);
    const NearestPoint nearest = model.nearest(center);
    if (!nearest) {
      continue;
    }
    take(best, nearest.distance, center);
    double at_corners = 0;
    for (const Vec3& corner : t) {
      const Vec3(&of_model)[3] = model.corners(nearest.triangle);
      at_corners = std::max(at_corners,
                            point_triangle_distance(corner, of_model[0], of_model[1], of_model[2]));
    }
    const double bound = std::min(nearest.distance + radius_of(t), at_corners);
    if (bound <= std::max(floor, best.lower) + tolerance) {
      best.upper = std::max(best.upper, bound);
      continue;
    }
    const Vec3 ab = (t[0] + t[1]) / 2;
    const Vec3 bc = (t[1] + t[2]) / 2;
    const Vec3 ca = (t[2] + t[0]) / 2;
    waiting.push_back({t[0], ab, ca});
    waiting.push_back({ab, t[1], bc});
    waiting.push_back({ca, bc, t[2]});
    waiting.push_back({ab, bc, ca});
  }
  return best;
}

void combine(GreatestGap& all, const GreatestGap& part) {
  take(all, part.lower, part.place);
  all.upper = std::max(all.upper, part.upper);
}

} // namespace

GreatestGap greatest_gap(TriangleView surface, const TriangleBvh& model, double tolerance) {
  const std::size_t count = surface.triangles.size();
  // A first bound from below, which spares most triangles the cutting.
  const GreatestGap floor = parallel_reduce_ordered(
      0, count, 64, GreatestGap(),
      [&](std::size_t first, std::size_t last) {
        GreatestGap found;
        for (std::size_t f = first; f < last; ++f) {
          const Corners t = corners_of(surface, surface.triangles[f]);
          for (const Vec3& p : {t[0], t[1], t[2], center_of(t)}) {
            take(found, model.nearest(p).distance, p);
          }
        }
        return found;
      },
      combine);
  GreatestGap gap = parallel_reduce_ordered(
      0, count, 16, floor,
      [&](std::size_t first, std::size_t last) {
        GreatestGap found;
        for (std::size_t f = first; f < last; ++f) {
          combine(found,
                  gap_of(corners_of(surface, surface.triangles[f]), model, floor.lower, tolerance));
        }
        return found;
      },
      combine);
  gap.upper = std::max(gap.upper, gap.lower);
  return gap;
}

} // namespace cagewright
