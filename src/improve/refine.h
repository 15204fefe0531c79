/// \file
/// Changes of a cage's connectivity for its quality, not for the number of its vertices.
#pragma once

#include "improve/simplify.h"

namespace cagewright {

/// Flips edges where that lowers the objective, the best first, until none is left that does. The
/// cage stays valid throughout. \returns how many
std::size_t flip_edges(WorkingCage& cage, const Guard& guard, const Objective& objective,
                       std::size_t most_valence);

/// Splits the longest edges in the middle until the cage has so many vertices, or no edge is left
/// that can be split. Its shape stays as it is. The cage stays valid throughout.
void split_long_edges(WorkingCage& cage, const Guard& guard, std::size_t vertices,
                      std::size_t most_valence);

/// Splits up to `count` edges where a new vertex lowers the objective most, no two of them in
/// neighbouring faces. The cage stays valid throughout. \returns how many
std::size_t split_edges(WorkingCage& cage, const Guard& guard, const Objective& objective,
                        std::size_t count, std::size_t most_valence);

/// Splits edges of faces that are farther from the model than `limit` at any of the samples of
/// Objective::sampled_gap(), where it lowers the objective most, but none of neighbours. The cage
/// stays valid throughout. \returns how many such faces there were
std::size_t split_far_faces(WorkingCage& cage, const Guard& guard, const Objective& objective,
                            double limit, std::size_t most_valence);

/// Splits an edge at the vertex `tip` where it lowers the objective most once both ends and what is
/// round them have moved: what a tip of the cage that stands far off the model needs, because no
/// split alone lowers the objective there. The cage stays valid throughout. \returns whether there
/// was one
bool split_tip(WorkingCage& cage, const Guard& guard, const Objective& objective, Index tip,
               std::size_t most_valence);

/// Collapses or flips edges of faces whose 2 r / R is below `least`, such as a union of boxes has,
/// or moves their corners, where there are fewer such faces after that; what it costs does not
/// matter. The cage stays valid throughout. \returns how many changes were made
std::size_t mend_needles(WorkingCage& cage, const Guard& guard, const Objective& objective,
                         double least, std::size_t most_valence);

} // namespace cagewright
