/// \file
/// Edge loops put where they pay most.
#pragma once

#include "quads/relax_quads.h"
#include <cagewright/core/progress.h>

namespace cagewright {

struct ExchangeLoopsOptions {
  std::size_t vertices = 0; ///< at most so many of the whole cage; 0: no limit
  std::size_t faces = 0;    ///< at most so many; 0: no limit
  RelaxQuadsOptions relax = {};
  double room = 0.012; ///< how far off the model loops are taken out, in diagonals
  int tries = 3;       ///< of the loops that look best so many are tried
  int settle = 5;      ///< steps after a try
  int rounds = 8;      ///< exchanges at most
  /// Rounds end while the objective is above this. 0: never.
  double dearest = 0;
};

/// Takes loops out of a cage that is too large for the budget, cheapest first, and puts loops into
/// one that is not; then puts one in and takes others out for it while that lowers the objective.
/// The cage stays valid, and within the guard's limits.
///
/// \returns the objective of the result
double exchange_loops(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                      const ExchangeLoopsOptions& options, const Progress& progress = {});

/// Of a whole cage, or of the one that a half makes.
std::size_t whole_vertices(const QuadCage& cage);
std::size_t whole_faces(const QuadCage& cage);

} // namespace cagewright
