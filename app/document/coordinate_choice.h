/// \file
/// By which coordinates a model is to follow its cage: one kind, or two and where the second holds.
#pragma once

#include <cagewright/coordinates/kinds.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright::app {

/// How much of the second kind each vertex of the model takes, in [0, 1]; never all 0.
using SharedShares = std::shared_ptr<const std::vector<float>>;

struct CoordinateChoice {
  CoordinateSettings first;
  std::optional<CoordinateSettings> second = {}; ///< it holds where it is painted
  SharedShares shares = nullptr;                 ///< V of the whole model; null: nothing is painted

  // NOLINTNEXTLINE(google-explicit-constructor): one kind is a choice
  CoordinateChoice(CoordinateSettings only = {}) : first(std::move(only)) {}

  /// Whether the second kind has a part in it.
  [[nodiscard]] bool mixes() const { return second && shares; }
  /// What the model is bound by.
  [[nodiscard]] CoordinateSettings settings() const {
    CoordinateSettings all = first;
    if (mixes()) {
      all.mix_with(*second);
    }
    return all;
  }
  /// Whether the kinds and their numbers are the same, wherever they hold.
  [[nodiscard]] bool has_kinds_of(const CoordinateChoice& other) const {
    return same(first, other.first) && second.has_value() == other.second.has_value() &&
           (!second || same(*second, *other.second));
  }
  /// Whether the model follows alike.
  [[nodiscard]] bool is(const CoordinateChoice& other) const {
    return has_kinds_of(other) && mixes() == other.mixes() && (!mixes() || shares == other.shares);
  }

private:
  static bool same(const CoordinateSettings& a, const CoordinateSettings& b) {
    return &a.kind() == &b.kind() && a.text() == b.text();
  }
};

} // namespace cagewright::app
