/// \file
/// Which of several cages is the best: one order, for every try. Internal to this module.
#pragma once

#include "mesh/shape_limits.h"
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/quads/quad_report.h>

#include <algorithm>
#include <compare>

namespace cagewright {

/// What a cage costs: less is better, and the first that differs decides.
struct Cost {
  bool is_over = false; ///< beyond the budget, or the gap
  /// What there is between it and the model, times what else makes it dearer; or what stands for
  /// that where cages of one kind are compared: how far or how large one is, or how ill shaped.
  double value = 0;
  double rest = 0; ///< of two that are alike

  auto operator<=>(const Cost&) const = default;
  [[nodiscard]] Cost times(double factor) const { return {is_over, factor * value, rest}; }
};

/// What webs, and handles that are not the model's own, make a cage dearer by.
///
/// \param webbing  SpaceBetween::share_inside()
/// \param genus    handles of its start
/// \param known    handles that the model has itself
double dearer_by(double webbing, int genus, int known);

/// The least webbing that is worth another try.
inline constexpr double webbed = 0.01;

/// That which is worth more than one.
inline constexpr double plainly_webbed = 0.05;

/// Whether a cage is as it should be. More than enough of one thing does not make up for another.
struct Merit {
  bool reached = false; ///< the budget, and the gap if one was asked for
  double quads = 0;     ///< share of the faces; of triangles where none are asked for: enough
  double least = 0;     ///< least 2 r / R
  double few_thin = 0;  ///< minus the share of thin triangles

  Merit(bool has_reached, const QuadReport& quads_made)
      : reached(has_reached), quads(std::min(quads_made.share, shape_limits::enough_quads)),
        least(std::min(quads_made.least_quality, shape_limits::needle)),
        few_thin(-std::max(quads_made.thin, shape_limits::few_thin)) {}

  /// Of a cage of triangles.
  Merit(bool has_reached, TriangleView cage);

  /// Of triangles that are as tight as can be with their shape: no needles, then few thin faces.
  [[nodiscard]] Cost cost() const { return {!reached, shape_limits::needle - least, -few_thin}; }

  /// Whether enough faces are quads, and round.
  [[nodiscard]] bool is_well_shaped() const {
    return quads >= shape_limits::enough_quads && few_thin >= -shape_limits::few_thin &&
           least >= shape_limits::needle;
  }
};

} // namespace cagewright
