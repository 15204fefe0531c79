#include "obb/principal_axes.h"
#include "support/models.h"
#include "voxel/test_meshes.h"
#include "voxel/voxelize.h"

#include <gtest/gtest.h>

#include <functional>

namespace cagewright {
namespace {

VoxelGrid grid_of(const TriangleMesh& mesh, std::uint64_t seed, int resolution = 48) {
  Result<VoxelGrid> grid = voxelize(mesh, box_in_frame(test::rotation(seed), mesh.positions),
                                    {.resolution = resolution});
  EXPECT_TRUE(grid) << grid.error().message;
  return grid ? std::move(*grid) : VoxelGrid{};
}

struct Shape {
  std::string name;
  TriangleMesh mesh;
  std::function<bool(const Vec3&)> inside;
};

std::vector<Shape> shapes() {
  return {{"cube", make_cube(), [](const Vec3& p) { return p.cwiseAbs().maxCoeff() < 1; }},
          {"sphere", make_icosphere(4), [](const Vec3& p) { return p.norm() < 1; }},
          {"torus", make_torus(0.35, 80, 40),
           [](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 1, p.z()) < 0.35; }}};
}

// Of all voxels without surface, the share whose kind is wrong.
double share_wrong(const VoxelGrid& grid, const std::function<bool(const Vec3&)>& inside) {
  std::size_t wrong = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    if (grid.kinds[i] != VoxelKind::feature) {
      wrong += (grid.kinds[i] == VoxelKind::inner) != inside(grid.center(i));
      ++all;
    }
  }
  return static_cast<double>(wrong) / static_cast<double>(all);
}

TEST(Classify, IsExactForClosedShapes) {
  for (const Shape& shape : shapes()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const VoxelGrid grid = grid_of(shape.mesh, seed);
      EXPECT_GT(grid.count(VoxelKind::inner), 1000U) << shape.name;
      EXPECT_EQ(share_wrong(grid, shape.inside), 0) << shape.name;
    }
  }
}

TEST(Classify, IsExactOnTheAxesOfSymmetricShapes) {
  // Vertices and edges lie exactly on planes and lines through voxel centers.
  for (const Shape& shape : shapes()) {
    for (const int resolution : {15, 16}) {
      const auto grid =
          voxelize(shape.mesh, pca_box(shape.mesh.positions), {.resolution = resolution});
      ASSERT_TRUE(grid);
      EXPECT_EQ(share_wrong(*grid, shape.inside), 0) << shape.name;
    }
  }
}

TEST(Classify, DoesNotMindOrientationDoublingOrLooseTriangles) {
  for (const Shape& shape : shapes()) {
    const TriangleMesh& mesh = shape.mesh;
    TriangleMesh doubled = mesh;
    doubled.triangles.insert(doubled.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
    TriangleMesh two_sided = mesh;
    const TriangleMesh back = test::inverted(mesh);
    two_sided.triangles.insert(two_sided.triangles.end(), back.triangles.begin(),
                               back.triangles.end());
    for (const TriangleMesh& worse :
         {test::inverted(mesh), test::with_flips(mesh, 0.3, 1), doubled, two_sided,
          joined(mesh, mesh), joined(mesh, back), test::as_soup(mesh),
          test::as_soup(test::with_flips(mesh, 0.5, 2))}) {
      EXPECT_EQ(grid_of(worse, 2).kinds, grid_of(mesh, 2).kinds) << shape.name;
    }
  }
}

TEST(Classify, SurvivesTheLossOfATenthOfTheFaces) {
  for (const Shape& shape : shapes()) {
    if (shape.name == "cube") {
      continue; // it has but twelve
    }
    for (const std::uint64_t seed : {1, 2, 3}) {
      const TriangleMesh torn = test::with_holes(shape.mesh, 0.1, seed);
      EXPECT_LT(share_wrong(grid_of(torn, seed), shape.inside), 0.005) << shape.name;
      EXPECT_LT(share_wrong(grid_of(test::inverted(torn), seed), shape.inside), 0.005);
    }
  }
}

TEST(Classify, DoesNotLeakThroughAWideHole) {
  // A sixth of the sphere's height is missing, much more than a voxel.
  TriangleMesh cup{make_icosphere(4).positions, {}};
  for (const Triangle& t : make_icosphere(4).triangles) {
    if (cup.positions[t[0]].z() < 0.7) {
      cup.triangles.push_back(t);
    }
  }
  for (const TriangleMesh& mesh : {cup, test::inverted(cup)}) {
    const VoxelGrid grid = grid_of(mesh, 5);
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      const Vec3 p = grid.center(i);
      if (grid.kinds[i] != VoxelKind::feature && (p.z() < 0.4 || p.norm() > 1)) {
        ASSERT_EQ(grid.kinds[i] == VoxelKind::inner, p.norm() < 1) << p.transpose();
      }
    }
  }
}

TEST(Classify, CountsCavitiesAsInner) {
  const TriangleMesh outer = make_icosphere(3);
  const TriangleMesh shell = test::moved(outer, Mat3::Identity(), 0.5, Vec3::Zero());
  for (const TriangleMesh& nested : {joined(outer, shell), joined(outer, test::inverted(shell)),
                                     joined(test::inverted(outer), shell)}) {
    EXPECT_EQ(share_wrong(grid_of(nested, 3), [](const Vec3& p) { return p.norm() < 1; }), 0);
  }
}

TEST(Classify, TakesTheUnionOfPiecesThatIntersect) {
  const TriangleMesh sphere = make_icosphere(4);
  const TriangleMesh other = test::moved(sphere, Mat3::Identity(), 1, {0.8, 0.2, 0.1});
  const auto inside = [](const Vec3& p) {
    return p.norm() < 1 || (p - Vec3(0.8, 0.2, 0.1)).norm() < 1;
  };
  EXPECT_EQ(share_wrong(grid_of(joined(sphere, other), 1), inside), 0);
  EXPECT_EQ(share_wrong(grid_of(joined(sphere, test::inverted(other)), 1), inside), 0);
}

TEST(Classify, IgnoresSheetsInsideAndOutside) {
  const TriangleMesh sheet{{{-1.5, 0.1, -1.5}, {1.5, 0.2, -1.5}, {0, 0.1, 1.5}}, {{0, 1, 2}}};
  const VoxelGrid grid = grid_of(joined(make_icosphere(3), sheet), 4);
  EXPECT_EQ(share_wrong(grid, [](const Vec3& p) { return p.norm() < 1; }), 0);
}

TEST(Classify, FindsNoInsideInASheet) {
  TriangleMesh half = make_torus(0.35, 80, 40);
  half.triangles.resize(2);
  EXPECT_EQ(grid_of(half, 1).count(VoxelKind::inner), 0U);
  const TriangleMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.3}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(grid_of(square, 2).count(VoxelKind::inner), 0U);
}

// Compared with the winding number, which is right for open models as far as anything is.
class ClassifyModel : public testing::TestWithParam<const char*> {};

TEST_P(ClassifyModel, AgreesWithTheWindingNumber) {
  const auto model = test::real_model({GetParam()});
  if (!model) {
    GTEST_SKIP() << "no " << GetParam() << " in CAGEWRIGHT_MODELS";
  }
  for (const TriangleMesh& mesh : {*model, test::inverted(*model)}) {
    const VoxelGrid grid = grid_of(mesh, 1, 40);
    Random random(1);
    int wrong = 0;
    int all = 0;
    while (all < 300) {
      const std::size_t i = random.below(grid.kinds.size());
      if (grid.kinds[i] != VoxelKind::feature) {
        const bool inside = std::abs(test::winding_number(mesh, grid.center(i))) > 0.5;
        wrong += (grid.kinds[i] == VoxelKind::inner) != inside;
        ++all;
      }
    }
    EXPECT_LE(wrong, all / 50);
  }
}

INSTANTIATE_TEST_SUITE_P(RealModels, ClassifyModel,
                         testing::Values("cow.off", "bull.off", "turbine.off", "cheese.off",
                                         "cheese_g133.off", "elephant-with-holes.off",
                                         "elephant_holes.off", "arm.obj", "teapot.obj",
                                         "suzanne.obj", "bunny.obj"));

} // namespace
} // namespace cagewright
