#include "slicing/published_rule.h"

#include <algorithm>

namespace cagewright {

std::optional<PublishedCut> published_cut(const OrientedBox& box,
                                          const std::array<CrossSection, 3>& sections,
                                          const PublishedRuleOptions& options) {
  const auto margin = static_cast<std::size_t>(options.margin);
  for (const CrossSection& section : sections) {
    const Jump jump = greatest_jump(section.smooth, margin);
    if (jump.height >= options.min_jump) {
      return PublishedCut{{section.axis, section.between(jump.slice)}, jump.height, false};
    }
  }
  const bool room = sections[0].area.size() >= 2 * margin;
  if (options.no_jump == NoJump::skip || !room || box.half[0] <= 0) {
    return std::nullopt;
  }
  return PublishedCut{{0, 0.0}, 0.0, true};
}

double prismatic_ratio(const CrossSection& section, std::size_t margin) {
  const std::vector<double>& f = section.smooth;
  if (f.size() <= 2 * margin) {
    return 1;
  }
  const auto [least, greatest] = std::minmax_element(f.begin() + static_cast<std::ptrdiff_t>(margin),
                                                     f.end() - static_cast<std::ptrdiff_t>(margin));
  return *greatest > 0 ? *least / *greatest : 1;
}

double cube_ratio(const OrientedBox& box) {
  return box.half.maxCoeff() > 0 ? box.half.minCoeff() / box.half.maxCoeff() : 1;
}

} // namespace cagewright
