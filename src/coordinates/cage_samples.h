/// \file
/// Places on a cage where kinds that are solved for are compared with what they should be. Internal
/// to this module.
#pragma once

#include "coordinates/surface.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/coordinates.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// A place on the cage, where what coordinates give is compared with what they should.
struct CageSample {
  Vec3 x;
  std::size_t triangle = 0;
  std::array<double, 3> hats{};
  double weight = 0; ///< square root of its share of the area
};

/// Sixteen samples or fewer, with the columns of each: hats of middles are shared by the corners.
class CageSampleTile {
public:
  CageSampleTile(const Surface& cage, const Coordinates& by, std::span<const CageSample> samples)
      : green_(16 * by.columns()), hats_(16 * cage.positions.size(), 0.0) {
    std::array<Vec3, 16> points;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      framed_[i] = samples[i].x;
      points[i] = samples[i].x / cage.frame.scale + cage.frame.center;
      for (std::size_t k = 0; k < 3; ++k) {
        hats_[16 * cage.faces[samples[i].triangle].vertices[k] + i] += samples[i].hats[k];
      }
    }
    (void)by.solve(std::span(points).first(samples.size()), green_.span());
    for (std::size_t i = 0; i < 16; ++i) {
      cage.share_middles(std::span(hats_).subspan(i), 16);
    }
    count_ = samples.size();
  }

  [[nodiscard]] std::span<const Vec3> framed() const { return std::span(framed_).first(count_); }
  /// Of vertex c at sample i.
  [[nodiscard]] double hat(std::size_t c, std::size_t i) const { return hats_[16 * c + i]; }
  /// Of column k of the Green coordinates: those of vertices and then of normals.
  [[nodiscard]] double green(std::size_t k, std::size_t i) const {
    return green_.data()[16 * k + i];
  }

private:
  std::array<Vec3, 16> framed_;
  AlignedBuffer<double> green_;
  std::vector<double> hats_;
  std::size_t count_ = 0;
};

} // namespace cagewright
