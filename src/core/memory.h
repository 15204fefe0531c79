/// \file
/// How much memory this process may use, for those about to ask for a great deal of it.
#pragma once

namespace cagewright {

/// Bytes: the least of the limits that the process runs under (setrlimit); infinity without one,
/// and where systems have none.
double memory_allowed();

} // namespace cagewright
