#include "slicing/published_rule.h"

#include <algorithm>

namespace cagewright {

std::vector<PublishedCut> published_cuts(const OrientedBox& box,
                                         const std::array<CrossSection, 3>& sections,
                                         const PublishedRuleOptions& options) {
  const auto margin = static_cast<std::size_t>(options.margin);
  std::vector<PublishedCut> cuts;
  for (const CrossSection& section : sections) {
    const Jump jump = greatest_jump(section.smooth, margin);
    if (jump.height >= options.min_jump) {
      cuts.push_back({{section.axis, section.between(jump.slice)}, jump.height, false});
    }
  }
  const bool room = sections[0].area.size() >= 2 * margin;
  if (options.no_jump == NoJump::middle && room && box.half[0] > 0) {
    cuts.push_back({{0, 0.0}, 0.0, true});
  }
  return cuts;
}

double prismatic_ratio(const CrossSection& section, std::size_t margin) {
  const std::vector<double>& f = section.smooth;
  if (f.size() <= 2 * margin) {
    return 1;
  }
  const auto [least, greatest] =
      std::minmax_element(f.begin() + static_cast<std::ptrdiff_t>(margin),
                          f.end() - static_cast<std::ptrdiff_t>(margin));
  return *greatest > 0 ? *least / *greatest : 1;
}

double cube_ratio(const OrientedBox& box) {
  return box.half.maxCoeff() > 0 ? box.half.minCoeff() / box.half.maxCoeff() : 1;
}

} // namespace cagewright
