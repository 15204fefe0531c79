/// \file
/// The improved slicing rule: cut where the cross-section changes most.
#pragma once

#include "obb/oriented_box.h"
#include "slicing/cross_section.h"
#include "slicing/partition.h"

#include <array>
#include <optional>

namespace cagewright {

/// What to do with a box in which no axis has a clear jump of f.
enum class NoJump {
  skip,   ///< leave the box whole
  middle, ///< cut through the middle of its longest edge
};

struct PublishedRuleOptions {
  double min_jump = 0.15; ///< a jump lower than this fraction of the greatest f is not clear
  int margin = 2;         ///< slices that stay on either side of a cut, at least
  NoJump no_jump = NoJump::middle;
};

struct PublishedCut {
  CutPlane plane;
  double jump = 0;     ///< height of the jump as a fraction of the greatest f of its axis
  bool middle = false; ///< no jump was clear: through the middle of the longest edge
};

/// The cut of Xian, Lin and Gao (2012): along the longest axis that has a clear jump, at the
/// greatest one.
///
/// \param sections  f along the three axes of the box, longest first
std::optional<PublishedCut> published_cut(const OrientedBox& box,
                                          const std::array<CrossSection, 3>& sections,
                                          const PublishedRuleOptions& options = {});

/// T1 = min f / max f along the longest axis, near 1 when the contents are already prismatic. The
/// `margin` slices at each end do not count: there every rounded shape tapers off.
double prismatic_ratio(const CrossSection& section, std::size_t margin);

/// T2 = shortest edge / longest edge of the box, near 1 when it is already nearly a cube.
double cube_ratio(const OrientedBox& box);

} // namespace cagewright
