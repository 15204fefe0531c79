#include "report/plane_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace cagewright {

std::string text_of(const MirrorPlane& plane) {
  constexpr std::array<const char*, 3> names = {"x", "y", "z"};
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const double factor = plane.normal[k];
    if (factor != 0) {
      text += text.empty() ? (factor < 0 ? "-" : "") : (factor < 0 ? " - " : " + ");
      text +=
          std::abs(factor) == 1 ? names[k] : fmt::format("{:.4g} {}", std::abs(factor), names[k]);
    }
  }
  return text + fmt::format(" = {:.6g}", plane.offset);
}

} // namespace cagewright
