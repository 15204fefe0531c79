/// \file
/// How often the engine is run for one closed surface. Internal to this module.
#pragma once

namespace cagewright {

/// Once improve() has been run so often for one closed surface, drafts of starts included, no other
/// try is begun, and what has been begun is finished. That takes `most_to_finish` more at most: a
/// draft and what improve_to_gap() needs to have something, on a half and, where that fails, on the
/// whole.
///
/// Without a limit it could be some 200 times: five starts, each on a half and then on the whole,
/// on each six drafts and a dozen cages of triangles for quads; and where a gap is asked for, each
/// of the dozen takes eleven runs. What is usual is 2 to 12.
inline constexpr int most_engine_runs = 60;
inline constexpr int most_to_finish = 6;

/// Counts them.
class EngineRuns {
public:
  [[nodiscard]] bool are_left() const { return used_ < most_engine_runs; }
  [[nodiscard]] int used() const { return used_; }
  void use_one() { ++used_; }

private:
  int used_ = 0;
};

} // namespace cagewright
