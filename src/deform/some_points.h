/// \file
/// A part of a model that stands for it, where figures need no more. Internal to this module.
#pragma once

#include <cagewright/core/geometry.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// At most 4096 of them, evenly spread over their order.
inline std::vector<Vec3> some_points(std::span<const Vec3> points) {
  constexpr std::size_t most = 4096;
  const std::size_t count = std::min(points.size(), most);
  std::vector<Vec3> some;
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(points[i * points.size() / count]);
  }
  return some;
}

} // namespace cagewright
