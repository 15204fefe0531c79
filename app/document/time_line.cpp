#include "app/document/time_line.h"

#include <algorithm>
#include <utility>

namespace cagewright::app {
namespace {

auto at_or_after(std::vector<Keyframe>& keys, int frame) {
  return std::lower_bound(keys.begin(), keys.end(), frame,
                          [](const Keyframe& key, int f) { return key.frame < f; });
}

/// Adds `times` the speed at keyframe k, per frame: that of the parabola through it and its
/// neighbors; 0 at the ends, so that movements start and stop softly.
void add_speed(const std::vector<Keyframe>& keys, std::size_t k, double times,
               std::vector<double>& shares) {
  if (k == 0 || k + 1 == keys.size()) {
    return;
  }
  const double before = keys[k].frame - keys[k - 1].frame;
  const double after = keys[k + 1].frame - keys[k].frame;
  const double in = times * after / (before + after) / before;
  const double out = times * before / (before + after) / after;
  shares[k - 1] -= in;
  shares[k] += in - out;
  shares[k + 1] += out;
}

} // namespace

std::vector<double> key_shares(const TimeLine& time_line, double frame) {
  const std::vector<Keyframe>& keys = time_line.keys;
  std::vector<double> shares(keys.size(), 0.0);
  if (keys.empty()) {
    return shares;
  }
  if (frame <= keys.front().frame) {
    shares.front() = 1;
    return shares;
  }
  if (frame >= keys.back().frame) {
    shares.back() = 1;
    return shares;
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
  shares[k] += 1 - h01;
  shares[k + 1] += h01;
  add_speed(keys, k, h10 * length, shares);
  add_speed(keys, k + 1, h11 * length, shares);
  return shares;
}

std::vector<double> pose_shares_at(const TimeLine& time_line, double frame, std::size_t poses) {
  const std::vector<double> of_keys = key_shares(time_line, frame);
  std::vector<double> shares(poses, 0.0);
  for (std::size_t k = 0; k < of_keys.size(); ++k) {
    const std::vector<double>& of_poses = time_line.keys[k].shares;
    for (std::size_t p = 0; p < std::min(poses, of_poses.size()); ++p) {
      shares[p] += of_keys[k] * of_poses[p];
    }
  }
  return shares;
}

std::vector<Vec3> cage_at(const TimeLine& time_line, double frame) {
  const std::vector<Keyframe>& keys = time_line.keys;
  const std::vector<double> shares = key_shares(time_line, frame);
  std::vector<Vec3> positions;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (shares[k] == 1) { // to the last digit
      return *keys[k].positions;
    }
  }
  for (std::size_t k = 0; k < keys.size(); ++k) {
    positions.resize(keys[k].positions->size(), Vec3::Zero());
    for (std::size_t v = 0; shares[k] != 0 && v < positions.size(); ++v) {
      positions[v] += shares[k] * (*keys[k].positions)[v];
    }
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
