/// \file
/// What counts as well shaped, for faces of cages: every stage that judges a whole cage means this.
#pragma once

namespace cagewright::shape_limits {

/// A triangle whose 2 r / R is below this is a needle: a cage should have none.
inline constexpr double needle = 0.03;
/// A triangle whose 2 r / R is below this is thin.
inline constexpr double thin = 0.15;
/// The share of thin triangles that a cage may have and still count as well shaped.
inline constexpr double few_thin = 0.05;
/// The share of quads among the faces that cages of quads aim at.
inline constexpr double enough_quads = 0.7;

} // namespace cagewright::shape_limits
