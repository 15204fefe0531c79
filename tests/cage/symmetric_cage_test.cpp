#include <cagewright/cage/generate.h>

#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include "support/figures.h"
#include "support/pairing.h"
#include "validate/greatest_gap.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace cagewright {
namespace {

using test::ellipsoid;
using test::expect_paired_exactly;

// A body with a head and two arms, one of which may hang lower; and two crumbs beside it.
TriangleMesh figure(double lower = 0) {
  TriangleMesh mesh = ellipsoid({0, 0, 0}, {1, 1.6, 0.7});
  mesh = joined(mesh, ellipsoid({0, 2, 0.2}, {0.6, 0.6, 0.6}));
  mesh = joined(mesh, ellipsoid({1.4, 0.6, 0.2}, {0.9, 0.25, 0.25}));
  mesh = joined(mesh, ellipsoid({-1.4, 0.6 - lower, 0.2}, {0.9, 0.25, 0.25}));
  mesh = joined(mesh, ellipsoid({1.4, 2, 0.2}, {0.05, 0.05, 0.05}));
  return joined(mesh, ellipsoid({-1.4, 2, 0.2}, {0.05, 0.05, 0.05}));
}

TriangleMesh moved(TriangleMesh mesh, const Mat3& turn, const Vec3& offset) {
  for (Vec3& p : mesh.positions) {
    p = turn * p + offset;
  }
  return mesh;
}

GenerateOptions options(int vertices, Symmetry symmetry) {
  GenerateOptions result;
  result.vertices = vertices;
  result.rounds = 1;
  result.symmetry = symmetry;
  return result;
}

TEST(SymmetricCage, IsValidWithinTheBudgetClearAndPairedExactly) {
  const TriangleMesh model = moved(figure(), Mat3(Mat3::Identity()), {0.3, 0, 0});
  for (const Method method : {Method::envelope, Method::boxes_improved}) {
    for (const int vertices : {40, 61}) {
      GenerateOptions wanted = options(vertices, Symmetry::automatic);
      wanted.method = method;
      const Result<GeneratedCage> made = generate(model, wanted);
      ASSERT_TRUE(made) << made.error().message;
      EXPECT_TRUE(made->is_as_asked());
      EXPECT_EQ(test::first_remark(*made), "");
      EXPECT_LE(made->triangles.positions.size(), static_cast<std::size_t>(vertices));
      EXPECT_TRUE(validate_cage(made->triangles, model)->valid());
      EXPECT_GE(mesh_distance(TriangleBvh(made->triangles), TriangleBvh(model)).distance,
                (1 - 1e-9) * made->clearance * diagonal(model.positions));
      expect_paired_exactly(*made);
      EXPECT_NEAR(made->mirror->plane.offset, 0.3, 1e-9);
    }
  }
}

TEST(SymmetricCage, OfAModelThatIsNotSymmetricEnclosesItAllTheSame) {
  const TriangleMesh model = figure(1);
  for (const Symmetry symmetry : {Symmetry::x, Symmetry::y, Symmetry::z}) {
    const Result<GeneratedCage> made = generate(model, options(60, symmetry));
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(validate_cage(made->triangles, model)->valid());
    expect_paired_exactly(*made);
  }
}

TEST(SymmetricCage, IsNotMadeOfAModelThatIsNot) {
  const Result<GeneratedCage> made = generate(figure(1), options(40, Symmetry::automatic));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made->mirror);
  EXPECT_NE(test::first_remark(*made), "");
  const Result<GeneratedCage> off = generate(figure(), options(40, Symmetry::off));
  EXPECT_FALSE(off->mirror);
  EXPECT_EQ(test::first_remark(*off), "");
}

TEST(SymmetricCage, StaysWithinAGapOfTheModelAndNotOnlyOfItsMirrorImage) {
  // The lower arm's image is where the model has nothing.
  for (const double lower : {0.0, 1.2}) {
    const TriangleMesh model = figure(lower);
    GenerateOptions wanted = options(60, Symmetry::x);
    wanted.max_gap = 0.1;
    const Result<GeneratedCage> made = generate(model, wanted);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(validate_cage(made->triangles, model)->valid());
    expect_paired_exactly(*made);
    const double diag = diagonal(model.positions);
    const GreatestGap gap = greatest_gap(made->triangles, TriangleBvh(model), 1e-4 * diag);
    EXPECT_LE(gap.lower, *made->gap * diag);
    EXPECT_GE(gap.upper, 0.99 * *made->gap * diag);
    EXPECT_EQ(made->is_as_asked(), *made->gap <= wanted.max_gap);
    EXPECT_EQ(made->is_as_asked(), lower == 0) << *made->gap;
  }
}

TEST(SymmetricCage, InAnyPlaneIsPairedToRounding) {
  const TriangleMesh model =
      moved(figure(), Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
            {10, 20, 30});
  const Result<GeneratedCage> made = generate(model, options(50, Symmetry::automatic));
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(validate_cage(made->triangles, model)->valid());
  ASSERT_TRUE(made->mirror);
  EXPECT_LT(made->mirror->error, 1e-13);
  for (Index v = 0; v < made->triangles.positions.size(); ++v) {
    const Vec3& image = made->triangles.positions[made->mirror->vertex_partners[v]];
    EXPECT_LT((made->mirror->plane.mirrored(made->triangles.positions[v]) - image).norm(), 1e-13);
  }
}

TEST(SymmetricCage, IsTheSameOnOneThreadAsOnMany) {
  const TriangleMesh model = figure();
  const Result<GeneratedCage> many = generate(model, options(30, Symmetry::automatic));
  tbb::task_arena(1).execute([&] {
    const Result<GeneratedCage> one = generate(model, options(30, Symmetry::automatic));
    EXPECT_EQ(one->triangles.positions, many->triangles.positions);
    EXPECT_EQ(one->triangles.triangles, many->triangles.triangles);
  });
}

} // namespace
} // namespace cagewright
