/// \file
/// The improved slicing rule: cut where the cross-section changes most.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/cross_section.h"
#include "slicing/partition.h"
#include <cagewright/slicing/slicing_rule.h>

#include <array>
#include <vector>

namespace cagewright {

struct PublishedRuleOptions {
  double min_jump = 0.15; ///< a jump lower than this fraction of the greatest f is not clear
  int margin = 3;         ///< slices that stay on either side of a cut, at least
  NoJump no_jump = NoJump::middle;
};

struct PublishedCut {
  CutPlane plane;
  double jump = 0;     ///< height of the jump as a fraction of the greatest f of its axis
  bool middle = false; ///< no jump was clear: through the middle of the longest edge
};

/// The cuts of Xian, Lin and Gao (2012), in the order in which to try them: at the greatest jump of
/// each axis that has a clear one, longest axis first, then as NoJump says. A cut that only takes
/// crumbs off is no cut; the next one is then due.
///
/// \param sections  f along the three axes of the box, longest first
std::vector<PublishedCut> published_cuts(const OrientedBox& box,
                                         const std::array<CrossSection, 3>& sections,
                                         const PublishedRuleOptions& options = {});

/// T1 = min f / max f along the longest axis, near 1 when the contents are already prismatic. The
/// `margin` slices at each end do not count: there every rounded shape tapers off.
double prismatic_ratio(const CrossSection& section, std::size_t margin);

/// T2 = shortest edge / longest edge of the box, near 1 when it is already nearly a cube.
double cube_ratio(const OrientedBox& box);

} // namespace cagewright
