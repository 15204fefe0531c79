#include "quads/limb_caps.h"

#include "improve/guard.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <utility>

namespace cagewright {
namespace {

constexpr double clearance = 0.02;

/// A bar along x from -5 to 5; from 0 on it may bend towards y.
TriangleMesh bar(double bent) {
  TriangleMesh arm = make_cube();
  for (Vec3& p : arm.positions) {
    p = p.cwiseProduct(Vec3(5, 0.4, 0.4));
    p.y() += p.x() > 0 ? bent : 0;
  }
  return arm;
}

/// Rings of four about the bar, one end a quad, the other drawn out into a vertex at `tip`.
PolygonMesh pointed(const Vec3& tip, double tip_ring = 4) {
  PolygonMesh mesh;
  for (const double x : {-5.5, 0.0, tip_ring}) {
    for (const auto& [y, z] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.positions.emplace_back(x, 0.8 * y, 0.8 * z);
    }
  }
  mesh.positions.push_back(tip);
  mesh.add_face({3, 2, 1, 0});
  for (Index k = 0; k < 4; ++k) {
    const Index next = (k + 1) % 4;
    for (const Index ring : {Index{0}, Index{4}}) {
      mesh.add_face({ring + k, ring + next, ring + 4 + next, ring + 4 + k});
    }
    mesh.add_face({8 + k, 8 + next, 12});
  }
  return mesh;
}

std::size_t triangles_in(const PolygonMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    count += mesh.face(f).size() == 3 ? 1 : 0;
  }
  return count;
}

struct Capped {
  Capped(const TriangleMesh& model, const PolygonMesh& start) : cage(start) {
    const ModelSurface surface(model, 0);
    count = cap_limbs(cage, QuadGuard(surface, clearance, {}), 0);
    made = cage.to_polygons();
  }
  QuadCage cage;
  std::size_t count = 0;
  PolygonMesh made;
};

TEST(LimbCaps, CloseALimbByAQuadInThePlaceOfFourTriangles) {
  const TriangleMesh model = bar(0);
  const PolygonMesh start = pointed({9, 0, 0});
  ASSERT_TRUE(validate_cage(start, model)->valid());
  const Capped capped(model, start);
  EXPECT_EQ(capped.count, 1U);
  EXPECT_EQ(capped.made.positions.size(), start.positions.size() - 1);
  EXPECT_EQ(triangles_in(capped.made), 0U);
  EXPECT_TRUE(validate_cage(capped.made, model)->valid());
}

TEST(LimbCaps, GoAskewWhereTheLimbDoes) {
  const TriangleMesh model = bar(0.3);
  const PolygonMesh start = pointed({14, 0.3, 0}, 3.5);
  ASSERT_TRUE(validate_cage(start, model)->valid());
  const Capped capped(model, start);
  EXPECT_EQ(capped.count, 1U);
  EXPECT_TRUE(validate_cage(capped.made, model)->valid());
}

TEST(LimbCaps, AreNotMadeOfAFanThatIsFlat) {
  const PolygonMesh start = pointed({5.6, 0, 0}, 5.5);
  const Capped capped(bar(0), start);
  EXPECT_EQ(capped.count, 0U);
  EXPECT_EQ(capped.made.positions, start.positions);
}

TEST(LimbCaps, EncloseWhatIsInTheTip) {
  // Beyond the bar there is a piece by itself, which only the tip goes round.
  TriangleMesh crumb = make_cube();
  for (Vec3& p : crumb.positions) {
    p = Vec3(7.5, 0, 0) + 0.1 * p;
  }
  const TriangleMesh model = joined(bar(0), crumb);
  const PolygonMesh start = pointed({12, 0, 0}, 5.5);
  ASSERT_TRUE(validate_cage(start, model)->valid());
  const Capped capped(model, start);
  EXPECT_EQ(capped.count, 1U);
  EXPECT_TRUE(validate_cage(capped.made, model)->valid());
}

} // namespace
} // namespace cagewright
