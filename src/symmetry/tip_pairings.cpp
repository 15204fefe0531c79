#include "symmetry/tip_pairings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cagewright {
namespace {

/// Pairings that cost more are no symmetry, however the surface is posed.
constexpr double most_cost = 0.15;
constexpr double of_a_tip_left_out = 0.03;
constexpr int most_left_out = 2;

class Search {
public:
  Search(std::span<const Index> tips, const SurfaceDistances& distances)
      : tips_(tips), distances_(distances), partners_(tips.size(), unknown) {
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        all_ += distances(tips[i], tips[j]);
      }
    }
  }

  std::vector<TipPairing> run() {
    pair_from(0, 0, 0);
    return std::move(found_);
  }

private:
  static constexpr std::size_t unknown = TipPairing::none - 1;

  [[nodiscard]] bool is_paired(std::size_t i) const {
    return partners_[i] != unknown && partners_[i] != TipPairing::none;
  }

  /// What the pairing of i costs with those of all others that are known.
  [[nodiscard]] double cost_of(std::size_t i) const {
    double cost = 0;
    for (std::size_t j = 0; j < tips_.size(); ++j) {
      if (j != i && is_paired(j) && !(j > i && partners_[i] == j)) {
        cost += std::abs(distances_(tips_[i], tips_[j]) -
                         distances_(tips_[partners_[i]], tips_[partners_[j]]));
      }
    }
    return cost / all_;
  }

  void pair_from(std::size_t i, double cost, int left_out) {
    while (i < tips_.size() && partners_[i] != unknown) {
      ++i;
    }
    if (cost > most_cost) {
      return;
    }
    if (i == tips_.size()) {
      found_.push_back({partners_, cost});
      return;
    }
    for (std::size_t j = i; j < tips_.size(); ++j) {
      if (partners_[j] != unknown) {
        continue;
      }
      partners_[i] = j;
      double more = j == i ? cost_of(i) : 0;
      if (j != i) {
        more = cost_of(i);
        partners_[j] = i;
        more += cost_of(j);
      }
      pair_from(i + 1, cost + more, left_out);
      partners_[j] = unknown;
    }
    partners_[i] = unknown;
    if (left_out < most_left_out) {
      partners_[i] = TipPairing::none;
      pair_from(i + 1, cost + of_a_tip_left_out, left_out + 1);
      partners_[i] = unknown;
    }
  }

  std::span<const Index> tips_;
  const SurfaceDistances& distances_;
  double all_ = 0;
  std::vector<std::size_t> partners_;
  std::vector<TipPairing> found_;
};

bool swaps_some(const TipPairing& pairing) {
  for (std::size_t i = 0; i < pairing.partners.size(); ++i) {
    if (pairing.partners[i] != TipPairing::none && pairing.partners[i] != i) {
      return true;
    }
  }
  return false;
}

/// Whether a pairing says nothing but what another says of more ends.
bool is_part_of(const TipPairing& part, const TipPairing& whole) {
  for (std::size_t i = 0; i < part.partners.size(); ++i) {
    if (part.partners[i] != TipPairing::none && part.partners[i] != whole.partners[i]) {
      return false;
    }
  }
  return true;
}

} // namespace

std::vector<TipPairing> tip_pairings(std::span<const Index> tips, const SurfaceDistances& distances,
                                     std::size_t most) {
  if (tips.size() < 2) {
    return {};
  }
  std::vector<TipPairing> found = Search(tips, distances).run();
  std::erase_if(found, [](const TipPairing& pairing) { return !swaps_some(pairing); });
  std::stable_sort(found.begin(), found.end(),
                   [](const TipPairing& a, const TipPairing& b) { return a.cost < b.cost; });
  std::vector<TipPairing> best;
  for (const TipPairing& pairing : found) {
    if (best.size() == most) {
      break;
    }
    if (std::none_of(best.begin(), best.end(),
                     [&](const TipPairing& other) { return is_part_of(pairing, other); })) {
      best.push_back(pairing);
    }
  }
  return best;
}

} // namespace cagewright
