#include <cagewright/coordinates/mixed.h>

#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

bool has_vertices_alone(const ColumnRule& rule) {
  return rule.columns() == rule.cage_at_rest().size();
}

/// Rules may divide only at some settings, and none does where the cage is at rest or in an affine
/// image of it: asked of a cage that is twisted.
bool divides(const ColumnRule& rule) {
  std::vector<Vec3> cage(rule.cage_at_rest().begin(), rule.cage_at_rest().end());
  const double unit = diagonal(cage);
  for (Vec3& p : cage) {
    const Vec3 q = p / unit;
    p += unit * Vec3(q.y() * q.z(), -q.x() * q.z(), q.x() * q.y());
  }
  return rule.divisor(cage).has_value();
}

class MixedColumns : public ColumnRule {
public:
  MixedColumns(std::shared_ptr<const ColumnRule> first, std::shared_ptr<const ColumnRule> second)
      : ColumnRule(first->cage_at_rest()), first_(std::move(first)), second_(std::move(second)),
        columns_of_first_(first_->columns()) {}

  [[nodiscard]] std::vector<ColumnGroup> groups() const override {
    return both(first_->groups(), second_->groups());
  }

  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override {
    first_->move(cage, moves.first(columns_of_first_));
    second_->move(cage, moves.subspan(columns_of_first_));
  }

  [[nodiscard]] std::vector<Vec3> reproduced_from() const override {
    const std::vector<Vec3> first = first_->reproduced_from();
    const std::vector<Vec3> second = second_->reproduced_from();
    return first.empty() || second.empty() ? std::vector<Vec3>() : both(first, second);
  }

  void add_influence(Index vertex, std::span<double> factors) const override {
    first_->add_influence(vertex, factors.first(columns_of_first_));
    second_->add_influence(vertex, factors.subspan(columns_of_first_));
  }

private:
  template <class T>
  static std::vector<T> both(std::vector<T> first, const std::vector<T>& second) {
    first.insert(first.end(), second.begin(), second.end());
    return first;
  }

  std::shared_ptr<const ColumnRule> first_;
  std::shared_ptr<const ColumnRule> second_;
  std::size_t columns_of_first_;
};

/// What is given for each point, by where it is.
class SharesByPlace {
public:
  SharesByPlace(std::span<const Vec3> points, std::span<const double> shares) {
    assert(points.size() == shares.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      entries_.push_back({{points[i].x(), points[i].y(), points[i].z()}, shares[i], 1});
    }
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.place < b.place; });
    std::size_t kept = 0;
    for (const Entry& entry : entries_) {
      if (kept > 0 && entries_[kept - 1].place == entry.place) {
        entries_[kept - 1].sum += entry.sum;
        entries_[kept - 1].count += 1;
      } else {
        entries_[kept++] = entry;
      }
    }
    entries_.resize(kept);
  }

  [[nodiscard]] std::optional<double> at(const Vec3& x) const {
    const std::array<double, 3> place = {x.x(), x.y(), x.z()};
    const auto found = std::lower_bound(
        entries_.begin(), entries_.end(), place,
        [](const Entry& entry, const auto& sought) { return entry.place < sought; });
    return found != entries_.end() && found->place == place
               ? std::optional(std::clamp(found->sum / found->count, 0.0, 1.0))
               : std::nullopt;
  }

private:
  struct Entry {
    std::array<double, 3> place;
    double sum;
    double count;
  };
  std::vector<Entry> entries_;
};

OutsideTreatment outside_of_both(OutsideTreatment a, OutsideTreatment b) {
  for (const OutsideTreatment treatment : {OutsideTreatment::error, OutsideTreatment::rest}) {
    if (a == treatment || b == treatment) {
      return treatment;
    }
  }
  return OutsideTreatment::continuation;
}

class MixedCoordinates : public Coordinates {
public:
  MixedCoordinates(std::shared_ptr<const ColumnRule> rule, std::shared_ptr<const Coordinates> first,
                   std::shared_ptr<const Coordinates> second, SharesByPlace shares)
      : Coordinates(std::move(rule), outside_of_both(first->outside(), second->outside())),
        first_(std::move(first)), second_(std::move(second)), shares_(std::move(shares)) {}

  [[nodiscard]] double error_bound() const override {
    return of_both(first_->error_bound(), second_->error_bound());
  }
  [[nodiscard]] double error_estimate() const override {
    return of_both(first_->error_estimate(), second_->error_estimate());
  }

private:
  static double of_both(double first, double second) { return std::max(first, second); }

  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const override {
    TileReport report;
    std::array<double, 16> shares{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (const std::optional<double> share = shares_.at(points[i])) {
        shares[i] = *share;
      } else {
        report.undefined |= bit(i);
      }
    }
    for (std::size_t k = 0; k < columns(); ++k) {
      std::fill_n(weights.data() + k * stride, 16, 0.0);
    }
    const bool shares_columns = columns() < first_->columns() + second_->columns();
    add(*first_, points, shares, false, weights, stride, report);
    add(*second_, points, shares, true,
        weights.subspan(shares_columns ? 0 : first_->columns() * stride), stride, report);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; has_none(report, *this, i) && k < columns(); ++k) {
        weights[k * stride + i] = 0;
      }
    }
    return report;
  }

  static std::uint16_t bit(std::size_t i) { return static_cast<std::uint16_t>(1U << i); }

  static bool has_none(const TileReport& report, const Coordinates& coordinates, std::size_t i) {
    const bool is_left_out =
        coordinates.outside() != OutsideTreatment::continuation && (report.outside & bit(i)) != 0;
    return is_left_out || (report.undefined & bit(i)) != 0;
  }

  static void add(const Coordinates& kind, std::span<const Vec3> points,
                  const std::array<double, 16>& shares, bool is_second, std::span<double> weights,
                  std::size_t stride, TileReport& report) {
    AlignedBuffer<double> own(16 * kind.columns());
    const TileReport told = kind.solve(points, own.span());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double share = is_second ? shares[i] : 1 - shares[i];
      if (share > 0) {
        report.undefined |= static_cast<std::uint16_t>(told.undefined & bit(i));
        report.outside |= static_cast<std::uint16_t>(told.outside & bit(i));
        report.on_surface |= static_cast<std::uint16_t>(told.on_surface & bit(i));
        for (std::size_t k = 0; k < kind.columns(); ++k) {
          weights[k * stride + i] += share * own.data()[16 * k + i];
        }
      }
    }
  }

  std::shared_ptr<const Coordinates> first_;
  std::shared_ptr<const Coordinates> second_;
  SharesByPlace shares_;
};

} // namespace

Result<std::shared_ptr<const ColumnRule>> mixed_rule(std::shared_ptr<const ColumnRule> first,
                                                     std::shared_ptr<const ColumnRule> second) {
  if (divides(*first) || divides(*second)) {
    return Error{ErrorCode::invalid_option,
                 "coordinates that turn with each part of the cage ('local' above 0) cannot be "
                 "mixed with others; set it to 0"};
  }
  if (has_vertices_alone(*first) && has_vertices_alone(*second)) {
    return first;
  }
  return std::shared_ptr<const ColumnRule>(
      std::make_shared<MixedColumns>(std::move(first), std::move(second)));
}

Result<std::shared_ptr<const Coordinates>>
mixed_coordinates(std::shared_ptr<const Coordinates> first,
                  std::shared_ptr<const Coordinates> second, std::span<const Vec3> points,
                  std::span<const double> shares) {
  Result<std::shared_ptr<const ColumnRule>> rule = mixed_rule(first->rule(), second->rule());
  if (!rule) {
    return rule.error();
  }
  return std::shared_ptr<const Coordinates>(std::make_shared<MixedCoordinates>(
      *std::move(rule), std::move(first), std::move(second), SharesByPlace(points, shares)));
}

Result<std::shared_ptr<const Coordinates>> prepare_mixed(const PolygonMesh& cage,
                                                         const CoordinateSettings& settings,
                                                         std::span<const Vec3> points,
                                                         std::span<const double> shares,
                                                         const Progress& progress) {
  assert(settings.mixed() != nullptr);
  // Before the work: whether they can be mixed at all.
  if (const auto rule = coordinate_rule(cage, settings); !rule) {
    return rule.error();
  }
  CoordinateSettings second = *settings.mixed();
  second.allow_open = settings.allow_open;
  auto of_first = settings.kind().prepare(cage, settings, progress.part(0, 0.5));
  if (!of_first) {
    return of_first.error();
  }
  auto of_second = second.kind().prepare(cage, second, progress.part(0.5, 1));
  if (!of_second) {
    return of_second.error();
  }
  return mixed_coordinates(*std::move(of_first), *std::move(of_second), points, shares);
}

} // namespace cagewright
