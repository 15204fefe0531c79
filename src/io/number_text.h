/// \file
/// Numbers as text.
#pragma once

#include <cagewright/core/geometry.h>

#include <charconv>
#include <string>

namespace cagewright {

/// Appends the shortest digits that read back as the same number, whatever the locale.
template <class Number> void append_number(std::string& text, Number value) {
  char digits[32]; // the longest double has 24
  text.append(digits, static_cast<std::size_t>(
                          std::to_chars(digits, digits + sizeof digits, value).ptr - digits));
}

/// The unit normal of a facet as STL has it; zero where the corners are on a line. The edges are
/// scaled first: a cross product of tiny ones would vanish.
inline Vec3 facet_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).stableNormalized().cross((c - a).stableNormalized());
  return normal.stableNormalized();
}

} // namespace cagewright
