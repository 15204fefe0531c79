#include "cage/hexahedron.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace cagewright {
namespace {

Hexahedron unit_cube() {
  return make_box(Vec3::Zero(), Mat3::Identity(), Vec3::Ones());
}

TEST(MakeBox, PutsTheCornersOnTheSidesTheirBitsSay) {
  const Hexahedron box = make_box(Vec3(10, 20, 30), Mat3::Identity(), Vec3(1, 2, 3));
  EXPECT_EQ(box.corners[0], Vec3(9, 18, 27));
  EXPECT_EQ(box.corners[1], Vec3(11, 18, 27));
  EXPECT_EQ(box.corners[2], Vec3(9, 22, 27));
  EXPECT_EQ(box.corners[7], Vec3(11, 22, 33));
  EXPECT_DOUBLE_EQ(volume(box), 48);
}

TEST(HexahedronFaces, AreInTheirOrderAndPointOutward) {
  const Hexahedron cube = unit_cube();
  for (int f = 0; f < 6; ++f) {
    const Vec3 outward = (f % 2 == 0 ? -1 : 1) * Vec3::Unit(f / 2);
    EXPECT_EQ(face_center(cube, f), outward);
    EXPECT_EQ(face_area(cube, f), 4 * outward);
    EXPECT_EQ(face_center(cube, opposite_face(f)), -outward);
  }
}

TEST(Triangulate, ClosesTheSolidWhicheverWayItIsBent) {
  Hexahedron bent = unit_cube();
  bent.corners[7] += Vec3(0.2, 0.1, 0.3);
  bent.corners[0] += Vec3(0.2, 0.3, 0.1);
  std::map<std::pair<Index, Index>, int> uses;
  for (const Triangle& t : triangulate(bent)) {
    for (int i = 0; i < 3; ++i) {
      ++uses[{t[i], t[(i + 1) % 3]}];
    }
  }
  EXPECT_EQ(uses.size(), 36);
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(uses.contains({edge.second, edge.first}));
  }
}

TEST(Triangulate, CutsABentQuadWhereTheSolidIsLarger) {
  for (int corner = 0; corner < 8; ++corner) {
    for (const double move : {-0.3, 0.3}) {
      Hexahedron bent = unit_cube();
      bent.corners[corner] *= 1 + move;
      // The other cut of every quad: by a corner order that starts one further, taken by hand.
      double smaller = 0;
      const std::array<Triangle, 12> cut = triangulate(bent);
      for (int f = 0; f < 6; ++f) {
        const auto& q = hexahedron_faces[f];
        const bool first = cut[2 * f] == Triangle{q[0], q[1], q[2]};
        for (const auto& t :
             first ? std::array<Triangle, 2>{{{q[0], q[1], q[3]}, {q[1], q[2], q[3]}}}
                   : std::array<Triangle, 2>{{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}}) {
          smaller += bent.corners[t[0]].dot(bent.corners[t[1]].cross(bent.corners[t[2]])) / 6;
        }
      }
      EXPECT_GT(volume(bent), smaller + 1e-3);
    }
  }
}

TEST(Triangulate, CutsASharedBentQuadAlikeForBothOwners) {
  Hexahedron left = unit_cube();
  Hexahedron right = make_box(Vec3(2, 0, 0), Mat3::Identity(), Vec3::Ones());
  left.corners[7].x() += 0.3;
  for (int i = 0; i < 8; i += 2) {
    right.corners[i] = left.corners[i + 1];
  }
  left.shared[1] = true;
  right.shared[0] = true;
  const auto triangles_of = [](const Hexahedron& solid, int f) {
    const std::array<Triangle, 12> cut = triangulate(solid);
    std::vector<std::vector<double>> found;
    for (const int t : {2 * f, 2 * f + 1}) {
      std::vector<std::vector<double>> corners;
      for (const Index i : cut[t]) {
        corners.emplace_back(solid.corners[i].begin(), solid.corners[i].end());
      }
      std::sort(corners.begin(), corners.end());
      found.insert(found.end(), corners.begin(), corners.end());
    }
    return std::set<std::vector<std::vector<double>>>{{found.begin(), found.begin() + 3},
                                                      {found.begin() + 3, found.end()}};
  };
  EXPECT_EQ(triangles_of(left, 1), triangles_of(right, 0));
}

TEST(IsConvex, HoldsForBoxesAndFailsForADentedOne) {
  Hexahedron solid = unit_cube();
  EXPECT_TRUE(is_convex(solid, 1e-12));
  solid.corners[7] *= 0.2; // pulled in past the plane of its neighbors
  EXPECT_FALSE(is_convex(solid, 1e-3));
}

TEST(IsConvex, FailsForAFlatSolid) {
  EXPECT_FALSE(is_convex(make_box(Vec3::Zero(), Mat3::Identity(), Vec3(1, 1, 0)), 1e-9));
}

TEST(HeightAbove, IsTheSignedDistanceToTheNearestFaceInside) {
  EXPECT_NEAR(height_above(unit_cube(), Vec3(0.9, 0, 0)), -0.1, 1e-15);
  EXPECT_DOUBLE_EQ(height_above(unit_cube(), Vec3(0, -1.5, 0)), 0.5);
}

} // namespace
} // namespace cagewright
