#include <cagewright/cage/specks.h>

#include "mesh/shapes.h"
#include <cagewright/cage/generate.h>
#include <cagewright/cage/generate_for_polygons.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cagewright {
namespace {

TriangleMesh moved(TriangleMesh mesh, double size, const Vec3& to) {
  for (Vec3& p : mesh.positions) {
    p = size * p + to;
  }
  return mesh;
}

/// A sphere of 642 vertices, of diagonal 3.46, with a speck somewhere.
TriangleMesh sphere_with(const TriangleMesh& speck) {
  return joined(make_icosphere(3), speck);
}

TriangleMesh dust(const Vec3& to) {
  return moved(make_tetrahedron(), 0.01, to);
}

std::size_t count_in(const TriangleMesh& model) {
  const Result<Specks> specks = find_specks(model);
  EXPECT_TRUE(specks) << specks.error().message;
  return specks->count;
}

TEST(Specks, AreTinyAndFar) {
  EXPECT_EQ(count_in(sphere_with(dust({3, 0, 0}))), 1U);
  EXPECT_EQ(count_in(sphere_with(dust({1.1, 0, 0}))), 0U) << "it is near";
  EXPECT_EQ(count_in(sphere_with(moved(make_tetrahedron(), 0.3, {5, 0, 0}))), 0U) << "it is large";
  EXPECT_EQ(count_in(sphere_with(moved(make_tetrahedron(), 0.08, {5, 0, 0}))), 0U) << "it is long";
}

TEST(Specks, AreFoundHoweverFarTheyAre) {
  for (const double far : {1e2, 1e4, 1e6, 1e9}) {
    const TriangleMesh near_and_far = joined(sphere_with(dust({far, far, -far})), dust({3, 0, 0}));
    const Result<Specks> specks = find_specks(near_and_far);
    ASSERT_TRUE(specks) << specks.error().message;
    EXPECT_EQ(specks->count, 2U) << "at " << far;
    EXPECT_EQ(specks->triangles, 8U);
    EXPECT_NEAR(specks->enlargement, far / 2, 0.01 * far);
    EXPECT_EQ(std::ranges::count(specks->of_vertex, true), 8);
  }
}

TEST(Specks, MayBeVerticesThatNoFaceUses) {
  TriangleMesh model = make_icosphere(3);
  model.positions.emplace_back(1e6, 0, 0);
  EXPECT_EQ(count_in(model), 1U);
}

TEST(Specks, AreNoPartOfASoup) {
  TriangleMesh soup; // no two triangles share a vertex, yet they hang together as they are near
  const TriangleMesh sphere = make_icosphere(3);
  for (const Triangle& t : sphere.triangles) {
    const auto first = static_cast<Index>(soup.positions.size());
    const Vec3 middle =
        (sphere.positions[t[0]] + sphere.positions[t[1]] + sphere.positions[t[2]]) / 3;
    for (const Index v : t) {
      soup.positions.push_back(0.9 * sphere.positions[v] + 0.1 * middle);
    }
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(count_in(soup), 0U);
  EXPECT_EQ(count_in(joined(soup, dust({1e5, 0, 0}))), 1U);
}

TEST(Specks, AreToldOrLeftOutOfTheCage) {
  const TriangleMesh model = sphere_with(dust({1e6, 1e6, 1e6}));
  GenerateOptions options;
  options.method = Method::boxes;
  options.depth = 0;
  const Result<GeneratedCage> whole = generate(model, options);
  ASSERT_TRUE(whole) << whole.error().message;
  const auto told = std::ranges::find(whole->remarks, Reason::specks_enclosed, &Remark::reason);
  ASSERT_NE(told, whole->remarks.end());
  EXPECT_TRUE(told->message.starts_with("1 tiny piece far from the rest is enclosed, too"));

  const Result<GeneratedCage> near = generate(sphere_with(dust({1.25, 0, 0})), options);
  ASSERT_TRUE(near) << near.error().message;
  EXPECT_EQ(std::ranges::count(near->remarks, Reason::specks_enclosed, &Remark::reason), 0)
      << "what does not make the model notably longer may well be a part of it";

  options = {};
  options.vertices = 30;
  options.ignore_specks = true;
  const TriangleMesh sphere = make_icosphere(3);
  const std::vector<double> density(model.positions.size(), 1);
  options.density = density;
  for (const bool has_polygons : {false, true}) {
    const Result<GeneratedCage> made = has_polygons
                                           ? generate_for_polygons(PolygonMesh(model), options)
                                           : generate(model, options);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ(made->remarks.back().reason, Reason::specks_ignored);
    EXPECT_LT(diagonal(made->faces.positions), 2 * diagonal(sphere.positions));
    EXPECT_LT(made->figures.volume_ratio, 1.5) << "figures are those of what remains";
    const auto judged = validate_cage(made->faces, TriangleView(sphere));
    EXPECT_TRUE(judged && judged->valid());
  }
}

} // namespace
} // namespace cagewright
