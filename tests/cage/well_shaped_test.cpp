#include "cage/triangle_stage.h"

#include "mesh/shapes.h"
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <optional>

namespace cagewright {
namespace {

// A flat ring, so long that its cages have thin faces unless shape counts for something.
TriangleMesh ring(double grown) {
  TriangleMesh mesh = make_torus(0.1 + grown, 32, 8);
  for (Vec3& p : mesh.positions) {
    p.x() *= 6;
  }
  return mesh;
}

TEST(ImproveWellShaped, GivesRounderFacesWhereTheyAreThinAndTheSameElsewhere) {
  const TriangleMesh model = ring(0);
  const TriangleMesh start = ring(0.1);
  int better = 0;
  int same = 0;
  for (const double shape : {1e-6, 1e-4, 1e-2}) {
    ImproveOptions options;
    options.vertices = 40;
    options.rounds = 0;
    options.shape = shape;
    const Result<Improved> once = improve(start, model, options);
    const GenerateOptions none;
    EngineRuns runs;
    const Ground ground(model, none, std::nullopt, runs);
    const Result<Triangles> tried = improve_well_shaped(ground, start, options);
    ASSERT_TRUE(once && tried);
    const Improved* made = &tried->improved;
    EXPECT_TRUE(validate_cage(made->cage, model)->valid());
    const CageMetrics before = measure_cage(once->cage, model);
    const CageMetrics after = measure_cage(made->cage, model);
    const bool is_well_shaped = before.min_quality >= 0.03 && before.low_quality >= 0.15;
    const bool is_same = made->cage.positions == once->cage.positions;
    EXPECT_TRUE(is_same || !is_well_shaped);
    EXPECT_TRUE(is_same || after.min_quality > before.min_quality ||
                after.low_quality > before.low_quality);
    better += is_same ? 0 : 1;
    same += is_well_shaped ? 1 : 0;
  }
  EXPECT_GT(better, 0);
  EXPECT_GT(same, 0);
}

} // namespace
} // namespace cagewright
