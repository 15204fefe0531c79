#include <cagewright/cage/generate_options.h>

namespace cagewright {

int vertex_limit(const GenerateOptions& options) {
  constexpr int usual = 100;
  const bool has_other_limit = options.faces > 0 || options.max_gap > 0;
  return options.vertices.value_or(has_other_limit ? 0 : usual);
}

} // namespace cagewright
