/// \file
/// An ellipsoid, a fine cage round it to start from, and grounds that say how far a cage is away.
#pragma once

#include "cage/ground.h"
#include "support/figures.h"

#include <optional>
#include <vector>

namespace cagewright::test {

struct GroundScene {
  TriangleMesh model = ellipsoid({0, 0, 0}, {1, 0.8, 0.6});
  TriangleMesh start = ellipsoid({0, 0, 0}, {1.15, 0.95, 0.75});
  GenerateOptions options = unrefined();
  EngineRuns runs;

private:
  static GenerateOptions unrefined() {
    GenerateOptions result;
    result.vertices = 0;
    result.rounds = 0;
    return result;
  }
};

/// Measures cages as any ground does, and notes how often; but where it is told to it says of every
/// cage, or of every one of quads, that it is so many diagonals away.
class NotingGround : public Ground {
public:
  explicit NotingGround(GroundScene& scene) : Ground(scene.model, scene.options, {}, scene.runs) {}

  std::optional<double> all_are_at;
  std::optional<double> quads_are_at;
  mutable std::vector<double> tolerances; ///< that triangles were measured to
  mutable int quads_measured = 0;

  [[nodiscard]] GreatestGap gap_of(const TriangleMesh& made, double tolerance) const override {
    tolerances.push_back(tolerance);
    GreatestGap gap = Ground::gap_of(made, tolerance);
    gap.upper = all_are_at ? *all_are_at * diagonal() : gap.upper;
    return gap;
  }
  [[nodiscard]] double gap_of(const PolygonMesh& made, double tolerance) const override {
    ++quads_measured;
    const std::optional<double> told = quads_are_at ? quads_are_at : all_are_at;
    return told ? *told * diagonal() : Ground::gap_of(made, tolerance);
  }
};

} // namespace cagewright::test
