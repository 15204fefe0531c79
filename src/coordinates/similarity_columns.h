/// \file
/// Columns of kinds that do not reproduce points. Internal to this module.
#pragma once

#include <cagewright/coordinates/columns.h>

#include <memory>
#include <span>

namespace cagewright {

/// What the cage's best similarity p -> s R p + t does is done to every point alike, and what is
/// left is weighted:
///     x' = s R x + t + sum over i of w_i (c'_i - s R c_i - t).
/// One column for each vertex, then three with the weights (x - g) / D: g the middle of the cage's
/// vertices at rest, D the diagonal of their box.
class SimilarityColumns : public ColumnRule {
public:
  explicit SimilarityColumns(std::span<const Vec3> cage_at_rest);

  /// The weights of the last three columns.
  [[nodiscard]] Vec3 of_point(const Vec3& x) const { return (x - middle_) / unit_; }

  [[nodiscard]] std::vector<ColumnGroup> groups() const override;
  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override;
  [[nodiscard]] std::vector<Vec3> reproduced_from() const override { return {}; }

private:
  Vec3 middle_;
  double unit_;
};

} // namespace cagewright
