#include "validate/self_crossings.h"

#include "mesh/shapes.h"
#include "support/models.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

namespace cagewright {
namespace {

TEST(CountSelfCrossings, FindsNoneInCleanShapes) {
  EXPECT_EQ(count_self_crossings(make_torus(0.3, 20, 10)).value(), 0U);
  EXPECT_EQ(count_self_crossings(TriangleMesh()).value(), 0U);
}

TEST(CountSelfCrossings, CountsEachPairOnce) {
  TriangleMesh cross;
  cross.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0.2, 0.1, 1}, {-0.2, 0, 1}};
  cross.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(count_self_crossings(cross).value(), 1U);
}

TEST(CountSelfCrossings, DoesNotCountTouchingOrLyingInAPlane) {
  TriangleMesh touching;
  touching.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, 0, 0}, {0.2, 0.1, 1}, {-0.2, 0, 1}};
  touching.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(count_self_crossings(touching).value(), 0U);
  touching.positions[4].z() = 0;
  touching.positions[5].z() = 0;
  EXPECT_EQ(count_self_crossings(touching).value(), 0U);
}

struct Known {
  const char* file;
  std::size_t pairs;
};

void PrintTo(const Known& known, std::ostream* out) {
  *out << known.file;
}

class SelfCrossingsOfModel : public testing::TestWithParam<Known> {};

TEST_P(SelfCrossingsOfModel, AreAsPublished) {
  const auto model = test::real_model({GetParam().file});
  if (!model) {
    GTEST_SKIP() << "CAGEWRIGHT_MODELS names no directory with " << GetParam().file;
  }
  EXPECT_EQ(count_self_crossings(*model).value(), GetParam().pairs);
}

INSTANTIATE_TEST_SUITE_P(Packaged, SelfCrossingsOfModel,
                         testing::Values(Known{"cow.off", 89}, Known{"teapot.obj", 151},
                                         Known{"suzanne.obj", 90}, Known{"pig.stl", 70},
                                         Known{"armadillo.off", 0}));

} // namespace
} // namespace cagewright
