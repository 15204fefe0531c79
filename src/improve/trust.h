/// \file
/// How far the vertices of a cage are let go in one step of its relaxation, which trusts a
/// quadratic model of the objective within that reach only. Of triangles and of quads.
///
/// Nocedal and Wright, "Numerical Optimization", chapter 4.
#pragma once

namespace cagewright {

/// What a step has gained, and what its model had promised.
struct StepGain {
  double gain = 0;
  double promised = 0;

  /// The model has told the truth, and so little is gained that another step does not pay.
  [[nodiscard]] bool is_enough(double least) const { return gain < least && gain > promised / 4; }

  /// What the reach of the next step is taken times: more where the model is good.
  [[nodiscard]] double reach_factor() const {
    return gain > promised / 2 ? 1.3 : gain < promised / 4 ? 0.5 : 1;
  }
};

/// What the reach is taken times after a step that has made the cage no better.
inline constexpr double reach_factor_in_vain = 0.4;

} // namespace cagewright
