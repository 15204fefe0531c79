// Any bytes as one number for each vertex: as many as asked for, none negative, or one line of
// error.
#include "require.h"

#include <cagewright/io/read_vertex_weights.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cagewright;
  for (const std::size_t count : {0, 1, 4, 1000}) {
    const auto weights =
        read_vertex_weights({reinterpret_cast<const char*>(data), size}, "file", count);
    if (!weights) {
      fuzz::require_one_line(weights.error().message);
      continue;
    }
    fuzz::require(weights->size() == count, "there are as many numbers as vertices");
    fuzz::require(
        std::ranges::all_of(*weights, [](double w) { return std::isfinite(w) && w >= 0; }),
        "numbers are finite and not negative");
  }
  return 0;
}
