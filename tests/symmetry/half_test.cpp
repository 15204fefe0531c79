#include "symmetry/half.h"

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cagewright {
namespace {

TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = scale * p + offset;
  }
  return mesh;
}

TEST(Half, OfASphereJoinedToItsImageIsOneClosedSurface) {
  const TriangleMesh sphere = moved(make_icosphere(3), 1, {0.1, 0, 0});
  const auto half = cut_half(sphere);
  ASSERT_TRUE(half);
  for (const Vec3& p : half->positions) {
    EXPECT_GE(p.x(), 0);
  }
  const auto whole = join_halves(*half, MirrorFrame({}, bounding_box(sphere.positions)));
  EXPECT_TRUE(is_embedded(whole.mesh));
  EXPECT_GT(signed_volume(whole.mesh), signed_volume(sphere));
}

TEST(Half, IsNotCutOffWhereThePlaneDoesNotReach) {
  EXPECT_FALSE(cut_half(moved(make_cube(), 1, {3, 0, 0})));
  EXPECT_FALSE(cut_half(moved(make_cube(), 1, {-3, 0, 0})));
}

TEST(Half, IsCutThroughVerticesOnThePlaneToo) {
  const TriangleMesh ball = make_icosphere(1); // has vertices with x = 0
  ASSERT_TRUE(std::any_of(ball.positions.begin(), ball.positions.end(),
                          [](const Vec3& p) { return p.x() == 0; }));
  const auto half = cut_half(ball);
  ASSERT_TRUE(half);
  const auto whole = join_halves(*half, MirrorFrame({}, bounding_box(ball.positions)));
  EXPECT_TRUE(is_embedded(whole.mesh));
}

TEST(Half, PairsAreExactAcrossAnAxisWhereverThePlaneIs) {
  for (const double scale : {1e-5, 1.0, 1e5}) {
    for (const double place : {0.0, 0.1, -1.0 / 3, 123.456}) {
      for (int axis = 0; axis < 3; ++axis) {
        MirrorPlane plane;
        plane.normal = Vec3::Unit(axis);
        plane.offset = place * scale;
        const TriangleMesh model = moved(make_icosphere(2), scale, plane.offset * plane.normal);
        const MirrorFrame frame(plane, bounding_box(model.positions));
        EXPECT_NEAR(frame.plane().offset, plane.offset, 1e-14 * std::abs(plane.offset));
        const auto half = cut_half(in_frame(model, frame));
        ASSERT_TRUE(half);
        const auto [mesh, pairing] = join_halves(*half, frame);
        EXPECT_TRUE(is_embedded(mesh));
        EXPECT_EQ(pairing.error, 0);
        const double c = pairing.plane.offset;
        std::size_t on_plane = 0;
        for (Index v = 0; v < mesh.positions.size(); ++v) {
          const Index w = pairing.vertex_partners[v];
          EXPECT_EQ(pairing.vertex_partners[w], v);
          const Vec3& p = mesh.positions[v];
          const Vec3& q = mesh.positions[w];
          EXPECT_EQ(p[axis] + q[axis], 2 * c);
          EXPECT_EQ(p[axis] - c, c - q[axis]);
          EXPECT_EQ(p[(axis + 1) % 3], q[(axis + 1) % 3]);
          EXPECT_EQ(p[(axis + 2) % 3], q[(axis + 2) % 3]);
          EXPECT_EQ(v == w, p[axis] == c);
          on_plane += v == w ? 1 : 0;
        }
        EXPECT_GT(on_plane, 3);
        EXPECT_NEAR(signed_volume(mesh), signed_volume(model), 1e-6 * signed_volume(model));
      }
    }
  }
}

TEST(Half, FacesArePairedCornerByCorner) {
  const TriangleMesh model = make_icosphere(2);
  const MirrorFrame frame({}, bounding_box(model.positions));
  const auto half = cut_half(model);
  const auto check = [](const auto& mesh, const MirrorPairing& pairing, const auto& face) {
    ASSERT_EQ(mesh.positions.size(), pairing.vertex_partners.size());
    for (Index f = 0; f < pairing.face_partners.size(); ++f) {
      const Index g = pairing.face_partners[f];
      EXPECT_NE(f, g);
      EXPECT_EQ(pairing.face_partners[g], f);
      std::vector<Index> images;
      for (const Index v : face(f)) {
        images.push_back(pairing.vertex_partners[v]);
      }
      const auto corners = face(g);
      std::vector<Index> other(corners.begin(), corners.end());
      std::sort(images.begin(), images.end());
      std::sort(other.begin(), other.end());
      EXPECT_EQ(images, other);
    }
  };
  const auto triangles = join_halves(*half, frame);
  check(triangles.mesh, triangles.pairing, [&](Index f) { return triangles.mesh.triangles[f]; });
  const auto polygons = join_halves(PolygonMesh(*half), frame);
  check(polygons.mesh, polygons.pairing, [&](Index f) { return polygons.mesh.face(f); });
  EXPECT_TRUE(validate_cage(polygons.mesh, TriangleMesh())->valid());
}

TEST(Half, InAnyPlaneIsPairedToRounding) {
  MirrorPlane plane;
  plane.normal = Vec3(1, 2, 3).normalized();
  plane.offset = plane.normal.dot(Vec3(10, 20, 30)) + 0.2;
  const TriangleMesh model = moved(make_icosphere(3), 1, {10, 20, 30});
  const MirrorFrame frame(plane, bounding_box(model.positions));
  const auto half = cut_half(in_frame(model, frame));
  ASSERT_TRUE(half);
  const auto [mesh, pairing] = join_halves(*half, frame);
  EXPECT_TRUE(is_embedded(mesh));
  EXPECT_LT(pairing.error, 1e-13);
  EXPECT_GT(pairing.error, 0);
}

TEST(Half, ModelHasWhatReachesOverThePlaneOnBothSides) {
  TriangleMesh model = joined(make_cube(), moved(make_icosphere(1), 0.1, {-3, 0, 0}));
  model.positions.emplace_back(-2, 5, 5); // of no triangle
  const HalfModel half = half_model(model, MirrorFrame({}, bounding_box(model.positions)));
  const Box3 box = bounding_box(half.mesh.positions);
  EXPECT_NEAR(box.max().x(), 3.1, 1e-9); // the small one's image
  EXPECT_EQ(box.min().x(), -1);          // of triangles that the plane cuts
  EXPECT_TRUE(std::any_of(half.mesh.positions.begin(), half.mesh.positions.end(),
                          [](const Vec3& p) { return p == Vec3(2, 5, 5); }));
  ASSERT_EQ(half.vertices.size(), half.mesh.positions.size());
  for (Index v = 0; v < half.vertices.size(); ++v) {
    const Vec3& p = model.positions[half.vertices[v]];
    EXPECT_EQ(half.mesh.positions[v].cwiseAbs(), p.cwiseAbs());
  }
}

} // namespace
} // namespace cagewright
