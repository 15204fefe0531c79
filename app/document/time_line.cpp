#include "app/document/time_line.h"

#include <algorithm>
#include <utility>

namespace cagewright::app {
namespace {

auto at_or_after(std::vector<Keyframe>& keys, int frame) {
  return std::lower_bound(keys.begin(), keys.end(), frame,
                          [](const Keyframe& key, int f) { return key.frame < f; });
}

/// Speed at keyframe k, per frame: that of the parabola through it and its neighbors; 0 at the
/// ends, so that movements start and stop softly.
Vec3 speed(const std::vector<Keyframe>& keys, std::size_t k, std::size_t vertex) {
  if (k == 0 || k + 1 == keys.size()) {
    return Vec3::Zero();
  }
  const auto position = [&](std::size_t i) -> const Vec3& { return (*keys[i].positions)[vertex]; };
  const double before = keys[k].frame - keys[k - 1].frame;
  const double after = keys[k + 1].frame - keys[k].frame;
  const Vec3 in = (position(k) - position(k - 1)) / before;
  const Vec3 out = (position(k + 1) - position(k)) / after;
  return (after * in + before * out) / (before + after);
}

} // namespace

std::vector<Vec3> cage_at(const TimeLine& time_line, double frame) {
  const std::vector<Keyframe>& keys = time_line.keys;
  if (keys.empty()) {
    return {};
  }
  if (frame <= keys.front().frame) {
    return *keys.front().positions;
  }
  if (frame >= keys.back().frame) {
    return *keys.back().positions;
  }
  std::size_t k = 0;
  while (frame >= keys[k + 1].frame) {
    ++k;
  }
  const double length = keys[k + 1].frame - keys[k].frame;
  const double t = (frame - keys[k].frame) / length;
  // Hermite's basis.
  const double h01 = t * t * (3 - 2 * t);
  const double h10 = t * (1 - t) * (1 - t);
  const double h11 = t * t * (t - 1);
  std::vector<Vec3> positions = *keys[k].positions;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3& from = positions[v];
    const Vec3& to = (*keys[k + 1].positions)[v];
    const Vec3 moved = from + h01 * (to - from) + h10 * length * speed(keys, k, v) +
                       h11 * length * speed(keys, k + 1, v);
    positions[v] = moved;
  }
  return positions;
}

TimeLine with_keyframe(TimeLine time_line, Keyframe key) {
  const auto place = at_or_after(time_line.keys, key.frame);
  if (place != time_line.keys.end() && place->frame == key.frame) {
    *place = std::move(key);
  } else {
    time_line.keys.insert(place, std::move(key));
  }
  return time_line;
}

TimeLine without_keyframe(TimeLine time_line, int frame) {
  const auto place = at_or_after(time_line.keys, frame);
  if (place != time_line.keys.end() && place->frame == frame) {
    time_line.keys.erase(place);
  }
  return time_line;
}

} // namespace cagewright::app
