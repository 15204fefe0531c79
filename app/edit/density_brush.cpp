#include "app/edit/density_brush.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace cagewright::app {

namespace {

void touch(const Dab& dab, const Vec3& place, const Vec3* normal, float least, float& d) {
  const double radius2 = dab.radius * dab.radius;
  const double distance2 = (place - dab.place).squaredNorm();
  if (!(distance2 < radius2) || (normal != nullptr && normal->dot(dab.normal) < 0)) {
    return;
  }
  const double t = 1 - distance2 / radius2;
  const auto amount = static_cast<float>(dab.amount * t * t);
  if (dab.erases) {
    const float less = std::abs(amount);
    d = std::abs(d) <= less ? 0.0F : d - std::copysign(less, d);
  } else {
    d = std::clamp(d + amount, least, 1.0F);
  }
}

} // namespace

void paint_dabs(std::span<const Dab> dabs, std::span<const Vec3> positions,
                std::span<const Vec3> normals, std::vector<float>& painted, float least) {
  Box3 box; // of all dabs: most of a model is beside them
  for (const Dab& dab : dabs) {
    box.extend(Vec3(dab.place.array() - dab.radius));
    box.extend(Vec3(dab.place.array() + dab.radius));
  }
  parallel_for(0, std::min(positions.size(), painted.size()), 4096, [&](std::size_t v) {
    if (!box.contains(positions[v])) {
      return;
    }
    for (const Dab& dab : dabs) {
      touch(dab, positions[v], v < normals.size() ? &normals[v] : nullptr, least, painted[v]);
    }
  });
}

} // namespace cagewright::app
