#include "mesh/shape_limits.h"
#include "spatial/surface_tree.h"
#include "support/models.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace cagewright {
namespace {

// Arms and horns that end in points: cages of few vertices end in spears there, which have hardly
// any volume.
class Tips : public testing::TestWithParam<std::string> {};

TEST_P(Tips, StayNearTheModel) {
  const auto model = test::real_model({GetParam()});
  if (!model) {
    GTEST_SKIP() << "no " << GetParam() << " in the folder that CAGEWRIGHT_MODELS names";
  }
  const Result<GeneratedCage> made = generate(*model);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made->is_as_asked());
  const SurfaceTree surface(*model);
  double farthest = 0;
  for (const Vec3& p : made->faces.positions) {
    farthest =
        std::max(farthest, surface.nearest(p, std::numeric_limits<double>::infinity(), 0).distance);
  }
  constexpr double a_little = 1.1; // the last steps do without it
  EXPECT_LT(farthest, a_little * shape_limits::far_tip * diagonal(model->positions));
}

INSTANTIATE_TEST_SUITE_P(Of, Tips, testing::Values("octopus.obj", "cow.off"));

} // namespace
} // namespace cagewright
