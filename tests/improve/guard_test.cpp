#include "improve/guard.h"

#include "core/random.h"
#include "exact/predicates.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace cagewright {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double scale) {
  for (Vec3& p : mesh.positions) {
    p *= scale;
  }
  return mesh;
}

TEST(Guard, SeesAFaceThatComesTooNear) {
  const TriangleMesh model = make_icosphere(3);
  const ModelSurface surface(model);
  const Guard guard(surface, 0.05);
  const CageMesh cage(scaled(make_icosphere(1), 1.3));
  const Vec3 p = cage.position(0);
  EXPECT_FALSE(guard.too_near(cage, cage.move(0, p)));
  EXPECT_TRUE(guard.too_near(cage, cage.move(0, p * (1.04 / 1.3))));
  EXPECT_TRUE(guard.too_near(cage, cage.move(0, -p)));
}

TEST(Guard, SeesFacesThatCross) {
  const TriangleMesh model = make_icosphere(3);
  const ModelSurface surface(model);
  const Guard guard(surface, 0.05);
  const CageMesh cage(scaled(make_icosphere(1), 1.3));
  const FaceBoxes boxes(cage);
  const Vec3 p = cage.position(0);
  EXPECT_FALSE(guard.crosses(cage, boxes, cage.move(0, p)));
  EXPECT_FALSE(guard.crosses(cage, boxes, cage.move(0, 2 * p)));
  EXPECT_TRUE(guard.crosses(cage, boxes, cage.move(0, -2 * p)));
}

TEST(Guard, MissesNoPartThatTheCageWouldJumpOver) {
  TriangleMesh crumb = scaled(make_icosphere(0), 0.01);
  for (Vec3& p : crumb.positions) {
    p += Vec3(0, 0, 1.2);
  }
  const TriangleMesh model = joined(make_icosphere(2), crumb);
  const ModelSurface surface(model);
  ASSERT_EQ(surface.parts.size(), 2);
  const Guard guard(surface, 0.001);
  TriangleMesh hull = scaled(make_icosphere(0), 2);
  const CageMesh cage(hull);
  Index top = 0;
  for (Index v = 0; v < cage.vertex_end(); ++v) {
    top = cage.position(v).z() > cage.position(top).z() ? v : top;
  }
  EXPECT_FALSE(guard.loses_a_part(cage, cage.move(top, {0, 0, 3})));
  EXPECT_TRUE(guard.loses_a_part(cage, cage.move(top, {0, 0, -0.5})));
}

// The quick answer, by a plane that separates them, agrees with the exact one.
TEST(FacesCross, AgreesWithTheExactPredicateWhateverTheFacesShare) {
  Random random(11);
  const auto coordinate = [&] { return static_cast<double>(random.below(5)) - 2; };
  std::array<int, 2> count{};
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<Vec3> x(6);
    for (Vec3& p : x) {
      p = Vec3(coordinate(), coordinate(), coordinate());
    }
    const Triangle s = {0, 1, 2};
    const Triangle t = trial % 3 == 0   ? Triangle{3, 4, 5}
                       : trial % 3 == 1 ? Triangle{3, 1, 4}
                                        : Triangle{2, 1, 3};
    const Corners at_s{x[s[0]], x[s[1]], x[s[2]]};
    const Corners at_t{x[t[0]], x[t[1]], x[t[2]]};
    if (is_degenerate(at_s[0], at_s[1], at_s[2]) || is_degenerate(at_t[0], at_t[1], at_t[2])) {
      continue;
    }
    const bool crossing = faces_cross(x, s, t);
    ASSERT_EQ(faces_cross(s, at_s, t, at_t), crossing) << "trial " << trial;
    ASSERT_EQ(faces_cross(t, at_t, s, at_s), crossing) << "trial " << trial;
    ++count[crossing ? 1 : 0];
  }
  EXPECT_GT(count[0], 1000);
  EXPECT_GT(count[1], 1000);
}

TEST(SolidAngle, OfAClosedSurfaceTellsInsideFromOutside) {
  const TriangleMesh torus = make_torus(0.3, 30, 20);
  const auto angle = [&](const Vec3& p) {
    double sum = 0;
    for (const Triangle& t : torus.triangles) {
      sum += solid_angle(p, {torus.positions[t[0]], torus.positions[t[1]], torus.positions[t[2]]});
    }
    return sum;
  };
  EXPECT_NEAR(angle({1, 0, 0}), 4 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(angle({0, 0, 0}), 0, 1e-9);
}

TEST(FaceBoxes, FindEveryFaceThatABoxMeets) {
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(1e6, 0, -1e6)}) {
    TriangleMesh sphere = make_icosphere(3);
    for (Vec3& p : sphere.positions) {
      p += offset;
    }
    const CageMesh cage(sphere);
    const FaceBoxes boxes(cage);
    Random random(5);
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 low =
          offset + Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Box3 box(low, low + Vec3::Constant(random.uniform(0, 0.5)));
      std::vector<Index> found;
      boxes.find(box, found);
      for (Index f = 0; f < cage.face_end(); ++f) {
        Box3 of_face;
        for (const Index v : cage.face(f)) {
          of_face.extend(cage.position(v));
        }
        if (of_face.intersects(box)) {
          EXPECT_TRUE(std::binary_search(found.begin(), found.end(), f));
        }
      }
    }
  }
}

} // namespace
} // namespace cagewright
