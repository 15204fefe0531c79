/// \file
/// What counts as well shaped, for faces of cages.
#pragma once

#include <cstddef>

namespace cagewright::shape_limits {

// Every stage that judges a whole cage means these.

/// A triangle whose 2 r / R is below this is a needle: a cage should have none.
inline constexpr double needle = 0.03;
/// A triangle whose 2 r / R is below this is thin.
inline constexpr double thin = 0.15;
/// The share of thin triangles that a cage may have and still count as well shaped.
inline constexpr double few_thin = 0.05;
/// The share of quads among the faces that cages of quads have at least where that can be had, and
/// the one that they aim at.
inline constexpr double enough_quads = 0.7;
inline constexpr double wanted_quads = 0.75;

/// A vertex of a cage that is farther from the model, in diagonals of the model's box, is a fault.
inline constexpr double far_tip = 0.05;

// What makes faces rounder aims a little beyond: measured on what is written to a file they are on
// the right side still.

/// A triangle below this is flipped, split or collapsed if that makes it better.
inline constexpr double mended = 0.05;
/// Below this the shape of the faces round it counts above all.
inline constexpr double nearly_a_needle = 0.032;
/// Below this a triangle is made rounder where many are.
inline constexpr double nearly_thin = 0.16;

// A cage of triangles that cannot be made smaller may have more faces at a vertex, by so many each
// time, thinner faces, and sharper edges: by half of what is left to folding.

inline constexpr std::size_t more_valence_if_stuck = 2;
inline constexpr double worse_defect_if_stuck = 2; // times; see shape_defect()
inline constexpr double least_quality_if_stuck = 0.035;
/// \param bend  see bend(): -1 is folded
constexpr double sharpest_bend_if_stuck(double bend) {
  return (bend - 1) / 2;
}

} // namespace cagewright::shape_limits
