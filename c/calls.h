/// \file
/// What every function of the C interface does: run on the threads it was given, stop when asked,
/// and turn failures into codes. No exception leaves the library.
#pragma once

#include <cagewright/c/cagewright.h>

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <functional>
#include <string>

struct cw_error {
  cw_code code = CW_INTERNAL;
  std::string message;
};

struct cw_stop {
  cagewright::StopFlag flag;
};

namespace cagewright::c {

cw_code code_of(ErrorCode code);

/// Runs the body and reports its failure to `error`, which may be null. Exceptions count as
/// failures.
cw_code call(cw_error** error, const std::function<Status()>& body) noexcept;

/// The same in an arena of the threads that `control` allows, with the progress that it asks for.
cw_code call(cw_error** error, const cw_control* control,
             const std::function<Status(const Progress&)>& body) noexcept;

/// A copy of a struct that begins with its size, as a caller knows it who was compiled with an
/// older or a newer header. Null: all 0.
template <class T> T known_part(const T* given);

} // namespace cagewright::c
