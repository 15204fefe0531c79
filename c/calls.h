/// \file
/// What every function of the C interface does: run on the threads it was given, stop when asked,
/// and turn failures into codes. No exception leaves the library.
#pragma once

#include <cagewright/c/cagewright.h>

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <functional>
#include <initializer_list>
#include <string>
#include <utility>

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

/// An argument that may not be null, and its name for the message.
struct Needed {
  const void* argument = nullptr;
  const char* name = "";
};

/// Errors: malformed, for the first that is null.
Status all_given(std::initializer_list<Needed> needed);

/// For what has a result: nothing stands in `out` unless the body sets it.
template <class Out, class... Body>
cw_code call_for(Out* out, cw_error** error, Body&&... body) noexcept {
  if (out == nullptr) {
    return call(error, [] { return all_given({{nullptr, "the place for the result"}}); });
  }
  *out = Out();
  return call(error, std::forward<Body>(body)...);
}

/// A copy of a struct that begins with its size, as a caller knows it who was compiled with an
/// older or a newer header. Null: all 0.
template <class T> T known_part(const T* given);

} // namespace cagewright::c
