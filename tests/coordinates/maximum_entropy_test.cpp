#include <cagewright/coordinates/maximum_entropy.h>

#include "coordinates/laws.h"

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return maximum_entropy_coordinates(cage);
}

TEST(MaximumEntropy, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> expected = {.3663248161, .1249764631, .2044154377, .1042832831,
                                        .0715480104, .0371507104, .0577117358, .0335895434};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 6e-11);
  }
  EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.3013001, .3805385, .24)).norm(),
            1e-7);
}

} // namespace
} // namespace cagewright
