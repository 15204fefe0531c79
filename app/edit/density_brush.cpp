#include "app/edit/density_brush.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace cagewright::app {

void add_dab(const Dab& dab, std::span<const Vec3> positions, std::span<const Vec3> normals,
             std::vector<float>& density) {
  const double radius2 = dab.radius * dab.radius;
  parallel_for(0, std::min(positions.size(), density.size()), 4096, [&](std::size_t v) {
    const double distance2 = (positions[v] - dab.place).squaredNorm();
    if (!(distance2 < radius2) || (v < normals.size() && normals[v].dot(dab.normal) < 0)) {
      return;
    }
    const double t = 1 - distance2 / radius2;
    const auto touch = static_cast<float>(dab.amount * t * t);
    float& d = density[v];
    if (dab.erases) {
      const float less = std::abs(touch);
      d = std::abs(d) <= less ? 0.0F : d - std::copysign(less, d);
    } else {
      d = std::clamp(d + touch, -1.0F, 1.0F);
    }
  });
}

} // namespace cagewright::app
