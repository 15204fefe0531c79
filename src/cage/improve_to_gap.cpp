#include "cage/triangle_stage.h"

#include "core/maths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

namespace cagewright {
namespace {

constexpr int first_try = 100;
constexpr int fewest = 4;
constexpr int most = 20000;
constexpr int direct_runs = 3;
constexpr int runs = 8;
constexpr double close_enough = 1.06; // of two numbers of vertices: neither is worth another run
constexpr double bound_width = 0.002; // of the gap: how well it is bounded
constexpr double usual_power = 0.8;   // gaps fall about with this power of the vertices

std::string percent(double fraction) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g %%", 100 * fraction);
  return text.data();
}

class Search {
public:
  Search(const Ground& ground, TriangleView start, const ImproveOptions& options, double max_gap)
      : ground_(ground), start_(start), options_(options), max_gap_(max_gap),
        diagonal_(ground.diagonal()) {
    limit_ = std::min(most, vertices_of(start));
    if (options.vertices > 0) {
      limit_ = std::min(limit_, options.vertices);
    }
    if (options.faces > 0) {
      limit_ = std::min(limit_, options.faces / 2 + 2);
    }
    limit_ = std::max(limit_, fewest);
  }

  Result<Triangles> run(const Progress& progress) {
    constexpr double direct = 0.8; // of the progress: seldom is there more to do
    if (const Status made = try_directly(progress.part(0, direct)); !made) {
      return made.error();
    }
    if (fine_) {
      return std::move(*fine_);
    }
    int vertices = std::min(first_try, limit_);
    for (int k = 0; k < runs && vertices > 0 && may_try(k); ++k) {
      const Progress part =
          progress.part(direct + (1 - direct) * k / runs, direct + (1 - direct) * (k + 1.0) / runs);
      if (const Status made = make(vertices, part); !made) {
        return made.error();
      }
      vertices = next();
    }
    if (fine_) {
      return std::move(*fine_);
    }
    Triangles& nearest = *nearest_;
    nearest.improved.report.reached = false;
    nearest.improved.report.why_not =
        "some points of the cage are " + percent(*nearest.gap) +
        " of the diagonal from the model; " +
        (coarse_ >= limit_ && limit_ < most && (options_.vertices > 0 || options_.faces > 0)
             ? "allow more vertices"
             : "there may be a hole, a hollow or a bridge between pieces there: try the "
               "envelope, a finer one, a smaller clearance, or pieces apart");
    return std::move(nearest);
  }

private:
  [[nodiscard]] bool may_try(int before) const { return before == 0 || ground_.runs().are_left(); }

  [[nodiscard]] int vertices_of(TriangleView cage) const {
    return static_cast<int>(ground_.vertices_of(cage.positions));
  }

  [[nodiscard]] GreatestGap gap_of(const TriangleMesh& cage) const {
    return ground_.gap_of(cage, bound_width * max_gap_ * diagonal_);
  }

  // The improvement heeds the gap at samples in each of its steps. If they have seen too little it
  // is done again for a smaller gap.
  Status try_directly(const Progress& progress) {
    ImproveOptions options = options_;
    options.vertices = limit_;
    options.faces = 0;
    double over = 1.02;
    double done = 0; // often once is enough
    for (int k = 0; k < direct_runs && may_try(k); ++k) {
      options.max_gap = std::max(max_gap_ / over, (max_gap_ + options_.clearance) / 2);
      const double then = k == 0 ? 0.7 : (done + 1) / 2;
      Result<Improved> improved = ground_.improved(start_, options, progress.part(done, then));
      done = then;
      if (!improved) {
        return improved.error();
      }
      const double upper = gap_of(improved->cage).upper / diagonal_;
      const int count = vertices_of(improved->cage);
      if (upper <= max_gap_ && count <= limit_) {
        improved->report.reached = true;
        improved->report.why_not.clear();
        fine_ = Triangles{std::move(*improved), upper, std::nullopt};
        break;
      }
      over *= 1.01 * upper / max_gap_;
      constexpr double beyond_samples = 2; // they do not see so little
      if (upper > beyond_samples * max_gap_) {
        break;
      }
    }
    return success();
  }

  Status make(int vertices, const Progress& progress) {
    ImproveOptions options = options_;
    options.vertices = vertices;
    options.faces = 0; // the limit of vertices sees to them
    // Coarser than a cage that is fine enough: from that one, which is in good shape already.
    const TriangleView start = fine_ ? TriangleView(fine_->improved.cage) : start_;
    options.parts = fine_ ? std::span<const Index>(fine_->improved.parts) : options.parts;
    options.rounds = fine_ ? std::min(options.rounds, 1) : options.rounds;
    Result<Improved> improved = ground_.improved(start, options, progress);
    if (!improved) {
      return improved.error();
    }
    const GreatestGap gap = gap_of(improved->cage);
    const int made = vertices_of(improved->cage);
    const bool stuck = made > vertices;
    Triangles result{std::move(*improved), gap.upper / diagonal_, std::nullopt};
    if (*result.gap <= max_gap_) {
      // Where the cage cannot be coarser than this, that is the end of the search.
      coarse_ = stuck ? std::max(coarse_, made - 1) : coarse_;
      if (!fine_ || made < fine_count_) {
        fine_count_ = made;
        result.improved.report.reached = true;
        result.improved.report.why_not.clear();
        fine_ = std::move(result);
      }
    } else {
      if (made > coarse_ || !nearest_) {
        coarse_ = std::max(coarse_, std::max(made, vertices));
        coarse_gap_ = *result.gap;
      }
      if (!nearest_ || *result.gap < *nearest_->gap) {
        nearest_ = std::move(result);
        nearest_->farthest = gap.place;
      }
    }
    return success();
  }

  /// The number of vertices to try next; 0: none.
  [[nodiscard]] int next() const {
    if (!fine_) {
      if (coarse_ >= limit_) {
        return 0;
      }
      const double factor =
          std::clamp(maths::pow(coarse_gap_ / max_gap_, 1 / usual_power), 1.2, 6.0);
      return std::min(limit_, static_cast<int>(std::ceil(1.1 * factor * coarse_)));
    }
    if (fine_count_ <= fewest || fine_count_ - 1 <= coarse_ ||
        fine_count_ <= close_enough * coarse_) {
      return 0;
    }
    if (coarse_ == 0) {
      const double factor =
          std::clamp(maths::pow(*fine_->gap / max_gap_, 1 / usual_power), 0.25, 0.8);
      return std::max(fewest, static_cast<int>(factor * fine_count_));
    }
    // Between the two, as their gaps say.
    const double towards = maths::log(coarse_gap_ / max_gap_) /
                           maths::log(coarse_gap_ / std::min(*fine_->gap, max_gap_));
    const double guess = coarse_ * maths::pow(static_cast<double>(fine_count_) / coarse_, towards);
    return std::clamp(static_cast<int>(std::lround(guess)),
                      coarse_ + std::max(1, (fine_count_ - coarse_) / 4),
                      fine_count_ - std::max(1, (fine_count_ - coarse_) / 4));
  }

  const Ground& ground_;
  TriangleView start_;
  const ImproveOptions& options_;
  double max_gap_;
  double diagonal_;
  int limit_ = 0;

  std::optional<Triangles> fine_; // the coarsest that keeps the gap
  int fine_count_ = 0;
  std::optional<Triangles> nearest_; // the one with the least gap, of those that do not
  int coarse_ = 0;                   // the most vertices that were too few
  double coarse_gap_ = 1;
};

} // namespace

Status can_keep_gap(double max_gap, double clearance) {
  if (max_gap > clearance) {
    return success();
  }
  return Error{ErrorCode::invalid_option, "no cage can stay within " + percent(max_gap) +
                                              " of the diagonal and keep a clearance of " +
                                              percent(clearance) +
                                              ": ask for a larger gap, or a smaller clearance"};
}

Result<Triangles> improve_to_gap(const Ground& ground, TriangleView start,
                                 const ImproveOptions& budget, double max_gap,
                                 const Progress& progress) {
  return Search(ground, start, budget, max_gap).run(progress);
}

} // namespace cagewright
