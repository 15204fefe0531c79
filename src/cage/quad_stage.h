/// \file
/// Cages of quads within a budget. Internal to this module.
#pragma once

#include "cage/ground.h"
#include "cage/limb_rings.h"
#include "quads/quads.h"

#include <optional>

namespace cagewright {

/// What quads are made for, and of.
struct QuadTask {
  const Ground& ground;
  const Start& start;
  const GenerateOptions& options;
  const LimbRings& rings; ///< on the start: edges of the quads, unless the budget does not allow it
  /// Where limbs come out joined finer voxels are tried: then it need not be the best from these.
  bool is_first = false;
};

struct QuadStage {
  ImproveReport report; ///< of the triangles that the quads were made of
  Quadrangulated made;
  /// With max_gap: no point of the whole cage is farther, along any diagonals; in diagonals.
  std::optional<double> gap;
};

/// Triangles, and quads made of them. The faces that are counted are those of the result, so that
/// more triangles are made to begin with, and fewer if they were too many; the gap, which quads
/// widen, is asked to be less of the triangles until that of the quads is what was asked for.
///
/// Errors: those of improve() and make_quads().
/// Cost: at most `most_runs` cages of triangles, and as many of quads, whatever is asked for:
/// what there is when they are used up is the result.
Result<QuadStage> make_quads_in_budget(const QuadTask& task, const Progress& progress = {});

/// Where a gap is asked for each may take the eleven runs of improve() that improve_to_gap() does.
inline constexpr int most_runs = 12;

} // namespace cagewright
