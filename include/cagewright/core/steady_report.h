/// \file
/// Reports of progress that never fall and never stand still.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>

namespace cagewright {

/// A fraction of the whole, and the name of the step under way.
using ProgressReport = std::function<void(double fraction, std::string_view step)>;

/// A report of what is left rather than of what was reckoned with.
///
/// A computation that tries again begins a step anew: the fraction it reports falls. What comes
/// from there to the end is then spread over what is left of the bar, so that it goes on, slower:
/// it neither falls nor waits until the step is again where it was. Where nothing falls the
/// fractions are those that were reported; 1 stays 1.
///
/// \param report  called with fractions that never fall, from 0 to 1, by one thread at a time
inline ProgressReport steady(ProgressReport report) {
  struct Pass {
    std::mutex mutex;
    double from = 0;  // the fraction that the pass began at,
    double shown = 0; // and what was shown then
    double last = 0;  // reported
    double least = 0; // that may be shown: what was shown last
  };
  return [report = std::move(report), pass = std::make_shared<Pass>()](double fraction,
                                                                       std::string_view step) {
    const std::lock_guard lock(pass->mutex);
    if (fraction < pass->last) {
      pass->from = fraction;
      pass->shown = pass->least;
    }
    pass->last = fraction;
    const double left = 1 - pass->from;
    const double done = left > 0 ? (fraction - pass->from) / left : 1;
    const double shown = pass->shown + done * (1 - pass->shown);
    pass->least = shown > pass->least ? shown : pass->least; // but for rounding they are the same
    report(pass->least, step);
  };
}

} // namespace cagewright
