#include "core/memory.h"

#include <algorithm>
#include <limits>

#if __has_include(<sys/resource.h>)
#include <sys/resource.h>
#endif

namespace cagewright {

double memory_allowed() {
  double bytes = std::numeric_limits<double>::infinity();
#if __has_include(<sys/resource.h>)
  for (const auto resource : {RLIMIT_DATA, RLIMIT_AS}) {
    struct rlimit limit {};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
      bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    }
  }
#endif
  return bytes;
}

} // namespace cagewright
