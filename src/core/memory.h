/// \file
/// How much memory this process may use, for those about to ask for a great deal of it.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <limits>

namespace cagewright {

/// Bytes: the least of the limits that the process runs under (setrlimit); infinity without one.
inline double memory_allowed() {
  double bytes = std::numeric_limits<double>::infinity();
  for (const auto resource : {RLIMIT_DATA, RLIMIT_AS}) {
    struct rlimit limit {};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
      bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
    }
  }
  return bytes;
}

} // namespace cagewright
