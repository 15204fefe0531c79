#include "voxel/voxelize.h"

#include "obb/principal_axes.h"
#include "support/models.h"
#include "voxel/test_meshes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <limits>

namespace cagewright {
namespace {

VoxelGrid grid_of(TriangleView mesh, const OrientedBox& frame,
                  const VoxelizeOptions& options = {}) {
  Result<VoxelGrid> grid = voxelize(mesh, frame, options);
  EXPECT_TRUE(grid) << grid.error().message;
  return grid ? std::move(*grid) : VoxelGrid{};
}

VoxelGrid grid_of(const TriangleMesh& mesh, const VoxelizeOptions& options = {}) {
  return grid_of(mesh, pca_box(mesh.positions), options);
}

OrientedBox frame_at(std::uint64_t seed, const TriangleMesh& mesh) {
  return box_in_frame(test::rotation(seed), mesh.positions);
}

void expect_feature_at(const VoxelGrid& grid, const Vec3& p) {
  const Vec3 g = grid.to_grid(p);
  const std::array<int, 3> cell = {static_cast<int>(std::floor(g.x())),
                                   static_cast<int>(std::floor(g.y())),
                                   static_cast<int>(std::floor(g.z()))};
  ASSERT_EQ(grid.kinds[grid.index(cell)], VoxelKind::feature) << "at " << g.transpose();
}

// Samples edges and interiors, points at the ends of their ranges included.
void expect_no_point_missed(TriangleView mesh, const VoxelGrid& grid) {
  Random random(1);
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[t[0]];
    const Vec3 ab = mesh.positions[t[1]] - a;
    const Vec3 ac = mesh.positions[t[2]] - a;
    ASSERT_NO_FATAL_FAILURE(expect_feature_at(grid, a));
    for (int i = 0; i < 20; ++i) {
      double u = random.uniform();
      double v = i % 4 == 0 ? 0 : random.uniform();
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      ASSERT_NO_FATAL_FAILURE(expect_feature_at(grid, a + u * ab + v * ac));
    }
  }
}

TEST(Voxelize, MissesNoPointOfTheSurface) {
  for (const TriangleMesh& shape : {make_cube(), make_icosphere(3), make_torus(0.3, 60, 30)}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const OrientedBox frame = seed == 0 ? pca_box(shape.positions) : frame_at(seed, shape);
      for (const int resolution : {2, 3, 17, 64}) {
        ASSERT_NO_FATAL_FAILURE(
            expect_no_point_missed(shape, grid_of(shape, frame, {.resolution = resolution})));
      }
    }
  }
}

TEST(Voxelize, MarksNoVoxelFarFromTheSurface) {
  const TriangleMesh sphere = make_icosphere(5);
  const VoxelGrid grid = grid_of(sphere);
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const double gap = std::abs(grid.center(i).norm() - 1);
    if (grid.kinds[i] == VoxelKind::feature) {
      EXPECT_LT(gap, grid.size * (std::sqrt(3.0) / 2 + 0.05));
    } else {
      EXPECT_GT(gap, grid.size * 0.49);
    }
  }
}

TEST(Voxelize, PlacesTheFacesOfTheFrameInsideVoxels) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const OrientedBox frame{{1, 2, 3},
                            test::rotation(static_cast<std::uint64_t>(i)),
                            {random.uniform(0, 1), 1, random.uniform(0, 1)}};
    const VoxelGrid grid = grid_of(to_mesh(frame), frame, {.resolution = 2 + i});
    EXPECT_DOUBLE_EQ(grid.size, 2.0 / (1 + i));
    EXPECT_EQ(grid.dims[1], 2 + i + 2);
    const std::array<Vec3, 8> corners = frame.corners();
    for (const Vec3& corner : {grid.to_grid(corners[0]), grid.to_grid(corners[7])}) {
      EXPECT_NEAR(corner[1] - std::floor(corner[1]), 0.5, 1e-9);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(corner[k] - std::floor(corner[k]), 0.5, 0.5 - 0.23);
        EXPECT_GT(corner[k], 1);
        EXPECT_LT(corner[k], grid.dims[k] - 1);
      }
    }
  }
}

TEST(Voxelize, LeavesTheOutermostLayerOuter) {
  // Also where the mesh sticks out of the frame.
  const TriangleMesh torus = make_torus(0.4, 40, 20);
  OrientedBox frame = frame_at(3, torus);
  for (const double shrink : {1.0, 0.7}) {
    frame.half *= shrink;
    const VoxelGrid grid = grid_of(torus, frame, {.resolution = 30, .margin = 1.3});
    expect_no_point_missed(torus, grid);
    for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
      const std::array<int, 3> c = grid.cell(i);
      for (int k = 0; k < 3; ++k) {
        if (c[k] == 0 || c[k] + 1 == grid.dims[k]) {
          ASSERT_EQ(grid.kinds[i], VoxelKind::outer);
        }
      }
    }
  }
}

TEST(Voxelize, GivesMovedAndScaledCopiesTheSameKinds) {
  for (const TriangleMesh& shape : {make_cube(), make_icosphere(2), make_torus(0.3, 32, 16)}) {
    const double size = diagonal(shape.positions);
    const VoxelGrid grid = grid_of(shape);
    for (const double scale : {1e-6, 1.0, 1e6}) {
      for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(1e5, -1e5, 1e5), Vec3(-3e4, 7e4, 0)}) {
        const VoxelGrid copy =
            grid_of(test::moved(shape, Mat3::Identity(), scale, scale * size * shift));
        EXPECT_EQ(copy.dims, grid.dims);
        EXPECT_EQ(copy.kinds, grid.kinds) << scale << " " << shift.transpose();
      }
    }
  }
}

TEST(Voxelize, GivesTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = test::with_holes(make_icosphere(5), 0.1, 1);
  VoxelGrid one;
  tbb::task_arena(1).execute([&] { one = grid_of(mesh); });
  for (int run = 0; run < 5; ++run) {
    VoxelGrid many;
    tbb::task_arena(2).execute([&] { many = grid_of(mesh); });
    EXPECT_EQ(one.kinds, many.kinds);
  }
}

TEST(Voxelize, GrowsVoxelsByTheMargin) {
  const TriangleMesh sphere = make_icosphere(4);
  const VoxelGrid grid = grid_of(sphere, {.resolution = 40, .margin = 2});
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const double gap = std::abs(grid.center(i).norm() - 1) / grid.size;
    if (gap < 2.4) { // the half voxel and the margin, less the facets' flatness
      EXPECT_EQ(grid.kinds[i], VoxelKind::feature);
    } else if (gap > 2.5 * std::sqrt(3.0) + 0.1) {
      EXPECT_NE(grid.kinds[i], VoxelKind::feature);
    }
  }
}

TEST(Voxelize, GivesAFlatSheetOneLayer) {
  const TriangleMesh sheet{{{0, 0, 5}, {2, 0, 5}, {2, 1, 5}, {0, 1, 5}}, {{0, 1, 2}, {0, 2, 3}}};
  const VoxelGrid grid = grid_of(sheet);
  EXPECT_EQ(grid.dims[2], 3);
  EXPECT_EQ(grid.count(VoxelKind::inner), 0U);
  EXPECT_EQ(grid.count(VoxelKind::feature), static_cast<std::size_t>(64 * (grid.dims[1] - 2)));
}

TEST(Voxelize, TakesASingleTriangleAndASegment) {
  for (const Vec3& c : {Vec3(0, 1, 0), Vec3(2, 3, 4)}) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 1.5, 2}, c}, {{0, 1, 2}}};
    const VoxelGrid grid = grid_of(mesh);
    EXPECT_EQ(grid.count(VoxelKind::inner), 0U);
    expect_no_point_missed(mesh, grid);
  }
}

TEST(Voxelize, MarksVerticesThatNoTriangleUses) {
  TriangleMesh mesh = make_cube();
  mesh.positions.emplace_back(5, 0, 0);
  mesh.positions.emplace_back(0.1, 0.2, 0.3);
  const VoxelGrid grid = grid_of(mesh);
  expect_feature_at(grid, mesh.positions[8]);
  expect_feature_at(grid, mesh.positions[9]);
}

TEST(Voxelize, RefusesModelsWithoutExtent) {
  const TriangleMesh point{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}};
  const Result<VoxelGrid> none = voxelize(TriangleMesh{}, OrientedBox{});
  const Result<VoxelGrid> same = voxelize(point, pca_box(point.positions));
  ASSERT_FALSE(none);
  ASSERT_FALSE(same);
  EXPECT_EQ(none.error().message, "the model has no vertices");
  EXPECT_EQ(same.error().message, "the model has no extent: all its points coincide");
  EXPECT_EQ(same.error().code, ErrorCode::unfit_model);
}

TEST(Voxelize, RefusesWhatIsNotFinite) {
  TriangleMesh cube = make_cube();
  const OrientedBox frame = pca_box(cube.positions);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e308}) {
    cube.positions[3].y() = bad;
    const Result<VoxelGrid> grid = voxelize(cube, frame);
    ASSERT_FALSE(grid);
    EXPECT_EQ(grid.error().code, ErrorCode::unfit_model);
  }
}

TEST(Voxelize, RefusesOptionsOutOfRangeAndGridsTooLarge) {
  TriangleMesh cube = make_cube();
  const OrientedBox frame = pca_box(cube.positions);
  EXPECT_EQ(voxelize(cube, frame, {.resolution = 1}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(voxelize(cube, frame, {.resolution = 5000}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(voxelize(cube, frame, {.margin = -1}).error().code, ErrorCode::invalid_option);
  EXPECT_EQ(voxelize(cube, frame, {.resolution = 4096}).error().code, ErrorCode::too_large);
  cube.positions[0] = {-1e100, 0, 0};
  EXPECT_EQ(voxelize(cube, frame).error().code, ErrorCode::too_large);
}

TEST(Voxelize, StopsWhenAsked) {
  const TriangleMesh sphere = make_icosphere(4);
  const OrientedBox frame = pca_box(sphere.positions);
  for (const double when : {0.0, 0.5, 0.75, 0.9}) {
    StopFlag stop;
    const Progress progress(stop, [&](double fraction, std::string_view) {
      if (fraction >= when) {
        stop.request_stop();
      }
    });
    const Result<VoxelGrid> grid = voxelize(sphere, frame, {}, progress);
    ASSERT_FALSE(grid) << when;
    EXPECT_EQ(grid.error().code, ErrorCode::cancelled);
  }
}

class VoxelizeModel : public testing::TestWithParam<const char*> {};

TEST_P(VoxelizeModel, MissesNoPointOfTheSurface) {
  const auto model = test::real_model({GetParam()});
  if (!model) {
    GTEST_SKIP() << "no " << GetParam() << " in CAGEWRIGHT_MODELS";
  }
  for (const std::uint64_t seed : {1, 2}) {
    ASSERT_NO_FATAL_FAILURE(expect_no_point_missed(
        *model, grid_of(*model, frame_at(seed, *model), {.resolution = 48})));
  }
}

INSTANTIATE_TEST_SUITE_P(RealModels, VoxelizeModel,
                         testing::Values("cow.off", "fandisk.off", "bull.off", "turbine.off",
                                         "teapot.obj", "suzanne.obj", "elephant_holes.off"));

} // namespace
} // namespace cagewright
