/// \file
/// What a cage that did not pass the check is answered with. Internal to this module.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/validate/validate_cage.h>

#include <string>

namespace cagewright {

/// \param report  with at least one violation
/// \param remedy  the last words of the message: what else to try
inline Error not_valid(const ValidityReport& report, const char* remedy) {
  return {ErrorCode::no_valid_cage, "the cage that was made did not pass the check (" +
                                        std::string(name_of(report.violations.front().kind)) +
                                        "); " + remedy};
}

} // namespace cagewright
