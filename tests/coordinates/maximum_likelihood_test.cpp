#include <cagewright/coordinates/maximum_likelihood.h>

#include "coordinates/laws.h"

namespace cagewright {
namespace {

using namespace cagewright::test;

Made make(const PolygonMesh& cage) {
  return maximum_likelihood_coordinates(cage);
}

TEST(MaximumLikelihood, HasTheGoldenValues) {
  const Made made = make(golden_cube());
  ASSERT_TRUE(made) << made.error().message;
  const std::vector<double> weights = solve(**made, golden_point()).weights;
  const std::vector<double> expected = {.3527449978, .1327172579, .2162918244, .0982459199,
                                        .0753353375, .0392024068, .0556278403, .0298344155};
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_NEAR(weights[c], expected[c], 6e-11);
  }
  EXPECT_LT((moved(**made, golden_point(), golden_pose()) - Vec3(.3046993, .3786544, .24)).norm(),
            1e-7);
}

} // namespace
} // namespace cagewright
