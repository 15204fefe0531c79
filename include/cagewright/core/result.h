/// \file
/// How functions report the failures a correct caller can meet.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace cagewright {

enum class ErrorCode {
  cannot_open,  ///< the file is missing, is not a file, or may not be read
  cannot_write, ///< the output cannot be created or completed
  malformed,    ///< the file's content does not follow its format
  unsupported,  ///< the format, or a feature of it, is not one we read or write
  too_large,    ///< the input needs more memory or larger indices than there are
  unfit_model,  ///< the model has no extent to build a cage around
  invalid_cage, ///< the cage is not what the operation needs (open, wrong size, self-intersecting)
  invalid_option, ///< an option is out of its range, or two contradict each other
  no_valid_cage,  ///< no cage could be found that passes the exact check
  mismatch,       ///< two inputs that belong together do not (model and weights, rest and pose)
  not_available,  ///< the machine lacks something needed (an offscreen GL driver)
  cancelled,      ///< the caller asked to stop
};

/// The code's name as it appears in messages, on the command line and in Python.
constexpr std::string_view name_of(ErrorCode code) {
  switch (code) {
  case ErrorCode::cannot_open:
    return "cannot_open";
  case ErrorCode::cannot_write:
    return "cannot_write";
  case ErrorCode::malformed:
    return "malformed";
  case ErrorCode::unsupported:
    return "unsupported";
  case ErrorCode::too_large:
    return "too_large";
  case ErrorCode::unfit_model:
    return "unfit_model";
  case ErrorCode::invalid_cage:
    return "invalid_cage";
  case ErrorCode::invalid_option:
    return "invalid_option";
  case ErrorCode::no_valid_cage:
    return "no_valid_cage";
  case ErrorCode::mismatch:
    return "mismatch";
  case ErrorCode::not_available:
    return "not_available";
  case ErrorCode::cancelled:
    return "cancelled";
  }
  return "unknown"; // no default above: the compiler points here when a code is added
}

struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string message; ///< a sentence for a person, with the offending file, line or element

  /// The error of every function that was asked to stop.
  static Error cancelled() { return {ErrorCode::cancelled, "cancelled"}; }
};

/// A value, or the reason there is none.
///
/// The names are those of std::expected, which g++ 12 has only in C++23 mode; when the toolchain
/// moves on this class becomes an alias.
template <class T> class [[nodiscard]] Result {
public:
  Result(T value) : state_(std::move(value)) {}
  Result(Error error) : state_(std::move(error)) {}

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
  [[nodiscard]] T& value() & { return std::get<0>(state_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }
  [[nodiscard]] T* operator->() { return &value(); }
  [[nodiscard]] const Error& error() const { return std::get<1>(state_); }

private:
  std::variant<T, Error> state_;
};

/// Success, or the reason there is none: for functions that act rather than make something.
using Status = Result<std::monostate>;

inline Status success() {
  return std::monostate{};
}

} // namespace cagewright
