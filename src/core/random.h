/// \file
/// Seeded random numbers that are the same on every platform.
#pragma once

#include <cstdint>

namespace cagewright {

/// SplitMix64 (Steele, Lea and Flood 2014): small, fast, and fully specified, unlike the standard
/// library's distributions, whose results differ between implementations.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }

  /// Uniform in [0, 1), with 53 random bits.
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }

  double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// Uniform in [0, count); count > 0. The bias of the remainder is below count / 2^64.
  std::uint64_t below(std::uint64_t count) { return next() % count; }

private:
  std::uint64_t state_;
};

} // namespace cagewright
