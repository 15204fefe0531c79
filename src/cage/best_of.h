/// \file
/// The best of several tries. Internal to this module.
#pragma once

#include "cage/merit.h"
#include <cagewright/core/result.h>

#include <optional>
#include <utility>

namespace cagewright {

/// Keeps the best of what is tried. Of two that are as good the earlier one stays; a try that fails
/// is no worse than none, unless it is the first, or the computation is to stop.
///
/// \tparam CostOf  Cost(const Made&); called only if there are two to choose from
template <class Made, class CostOf> class BestOf {
public:
  explicit BestOf(CostOf cost_of) : cost_of_(std::move(cost_of)) {}

  /// \param worth  how many times as dear it may be and still be as good
  /// \returns whether there is something to be made better: then another may be tried
  bool add(Result<Made> made, double worth = 1) {
    if (!made) {
      if (!best_ || made.error().code == ErrorCode::cancelled) {
        failure_ = made.error();
      }
      return !failure_;
    }
    if (!best_) {
      best_ = std::move(*made);
      return true;
    }
    const Cost cost = cost_of_(*made);
    if (!cost_) {
      cost_ = cost_of_(*best_);
    }
    if (cost < cost_->times(worth)) {
      best_ = std::move(*made);
      cost_ = cost;
    }
    return true;
  }

  [[nodiscard]] const Made& best() const { return *best_; }

  /// Call last.
  [[nodiscard]] Result<Made> taken() {
    return failure_ ? Result<Made>(*failure_) : Result<Made>(std::move(*best_));
  }

private:
  CostOf cost_of_;
  std::optional<Made> best_;
  std::optional<Cost> cost_; // of the best
  std::optional<Error> failure_;
};

} // namespace cagewright
