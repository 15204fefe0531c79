#include "envelope/envelope.h"
#include "improve/improve.h"
#include "improve_scene.h"
#include <cagewright/validate/webbing.h>

namespace cagewright {
namespace {

TriangleMesh bar(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh = make_cube();
  for (Vec3& p : mesh.positions) {
    p = (low + high) / 2 + p.cwiseProduct(high - low) / 2;
  }
  return mesh;
}

/// Two legs near each other, and what joins them at the top.
TriangleMesh trousers() {
  return joined(joined(bar({-2.6, 0, 0}, {-0.6, 2, 16}), bar({0.6, 0, 0}, {2.6, 2, 16})),
                bar({-2.6, 0, 14}, {2.6, 2, 18}));
}

TEST(Webs, CountByThePointsInside) {
  const TriangleMesh model = trousers();
  const ModelSurface surface(model);
  const SpaceBetween between(model);
  ObjectiveWeights weights;
  weights.typical_area = 1;
  Objective objective(surface, weights);
  const CageMesh box(bar({-4, -1, -1}, {4, 3, 19}));
  const double without = objective.total(box);
  weights.between = &between;
  Objective dearer(surface, weights);
  const double space = static_cast<double>(between.count()) * std::pow(between.voxel(), 3);
  EXPECT_NEAR(dearer.total(box), without + weights.webbing * space, 1e-6 * without);
  dearer.allow_webs();
  EXPECT_EQ(dearer.total(box), without);
}

TEST(Webs, AreTakenOutWhereTheyAreDear) {
  const TriangleMesh model = trousers();
  const SpaceBetween between(model);
  const Result<Envelope> start = envelope(model, {.resolution = 40});
  ASSERT_TRUE(start) << start.error().message;
  ImproveOptions options;
  options.vertices = 18;
  const Result<Improved> usual = improve(start->mesh, model, options);
  ASSERT_TRUE(usual);
  options.between = &between;
  const Result<Improved> dear = improve(start->mesh, model, options);
  ASSERT_TRUE(dear);
  EXPECT_TRUE(validate_cage(dear->cage, model)->valid());
  EXPECT_GT(between.share_inside(usual->cage), 0.05);
  EXPECT_LT(between.share_inside(dear->cage), between.share_inside(usual->cage) / 2);
  // What is told does not have the webs in it, so that the two can be compared.
  EXPECT_NEAR(dear->report.objective, usual->report.objective, usual->report.objective / 2);
}

} // namespace
} // namespace cagewright
