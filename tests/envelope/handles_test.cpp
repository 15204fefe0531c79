#include "envelope/handles.h"

#include "core/random.h"
#include "envelope/envelope.h"
#include "envelope/well_composed.h"
#include "mesh/shapes.h"
#include "voxel/mirrored_grid.h"
#include "voxel/voxel_mesh.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

VoxelGrid empty_grid(int size) {
  VoxelGrid grid;
  grid.dims = {size, size, size};
  grid.kinds.assign(grid.index(0, 0, size), VoxelKind::outer);
  return grid;
}

TriangleMesh surface_of(VoxelGrid grid) {
  for (VoxelKind& kind : grid.kinds) {
    kind = kind == VoxelKind::outer ? kind : VoxelKind::feature;
  }
  return to_triangle_mesh(voxel_boxes(grid, {VoxelKind::feature}));
}

// A connected tangle of rods along the axes, all of them through lattice points three apart.
VoxelGrid random_rods(Random& random, bool mirrored) {
  VoxelGrid grid = empty_grid(17);
  for (int rod = 0; rod < 14; ++rod) {
    std::array<int, 3> at{};
    for (int& x : at) {
      x = 2 + 3 * static_cast<int>(random.uniform(0, 4.999));
    }
    for (at[rod % 3] = 2; at[rod % 3] < 15; ++at[rod % 3]) {
      grid.kinds[grid.index(at)] = VoxelKind::feature;
    }
  }
  for (int k = 0; k < 3; ++k) { // joined through one point
    std::array<int, 3> at = {8, 8, 8};
    for (at[k] = 2; at[k] < 15; ++at[k]) {
      for (int m = 2; m < 15; ++m) {
        std::array<int, 3> beside = at;
        beside[(k + 1) % 3] = m;
        grid.kinds[grid.index(beside)] = VoxelKind::feature;
      }
    }
  }
  make_manifold(grid, mirrored);
  return grid;
}

TEST(Handles, AreCountedAsOnTheMesh) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const VoxelGrid grid = random_rods(random, false);
    const TriangleMesh mesh = surface_of(grid);
    const auto euler =
        static_cast<long>(mesh.positions.size()) - static_cast<long>(mesh.triangles.size() / 2);
    EXPECT_EQ(genus_of(grid), 1 - euler / 2);
  }
}

TEST(Handles, AreFilledAndTheSurfaceStaysManifoldAndAroundWhatItWas) {
  int most_filled = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (const bool mirrored : {false, true}) {
      Random random(seed);
      const VoxelGrid before = random_rods(random, mirrored);
      VoxelGrid grid = before;
      const int left = fill_handles(grid, 2, 8, mirrored);
      EXPECT_LE(left, 2);
      EXPECT_EQ(left, genus_of(grid));
      most_filled = std::max(most_filled, genus_of(before) - left);
      EXPECT_TRUE(is_embedded(surface_of(grid)));
      for (std::size_t i = 0; i < before.kinds.size(); ++i) {
        const std::array<int, 3> c = before.cell(i);
        const int more = (grid.dims[0] - before.dims[0]) / 2;
        EXPECT_TRUE(!before.occupied(i) ||
                    grid.occupied(grid.index(c[0] + more, c[1] + more, c[2] + more)));
      }
      EXPECT_TRUE(!mirrored || mirror_occupied(grid) == 0);
    }
  }
  EXPECT_GT(most_filled, 2);
}

TEST(Handles, AreFilledWithSkinsOfOneVoxel) {
  VoxelGrid grid = empty_grid(17);
  int hole = 0;
  for (int z = 5; z < 12; ++z) { // a frame seven voxels thick
    for (int y = 3; y < 14; ++y) {
      for (int x = 3; x < 14; ++x) {
        const bool is_hole = x > 5 && x < 11 && y > 5 && y < 11;
        hole += is_hole && z == 5 ? 1 : 0;
        grid.kinds[grid.index(x, y, z)] = is_hole ? VoxelKind::outer : VoxelKind::feature;
      }
    }
  }
  const auto count = [](const VoxelGrid& g) { return g.kinds.size() - g.count(VoxelKind::outer); };
  const std::size_t before = count(grid);
  VoxelGrid wide = grid;
  EXPECT_EQ(fill_handles(grid, 0, 2, false), 1); // a ball so small gets through
  EXPECT_EQ(count(grid), before);
  EXPECT_EQ(fill_handles(wide, 0, 8, false), 0);
  EXPECT_EQ(count(wide), before + static_cast<std::size_t>(hole));
}

// A sausage bent to a ring: its ends are near each other, and do not touch.
TriangleMesh bent_sausage(double tube) {
  TriangleMesh mesh = make_icosphere(4);
  for (Vec3& p : mesh.positions) {
    const double angle = 0.985 * std::numbers::pi * p.z();
    const double radius = 1 + tube * p.x();
    p = Vec3(radius * std::cos(angle), radius * std::sin(angle), tube * p.y());
  }
  return mesh;
}

TEST(Handles, OfAnEnvelopeAreThoseOfTheModel) {
  const TriangleMesh sausage = bent_sausage(0.6);
  EXPECT_EQ(envelope(sausage, {.resolution = 30})->genus, 1);
  const Result<Envelope> filled = envelope(sausage, {.resolution = 30, .fill = 0.3});
  EXPECT_EQ(filled->genus, 0);
  EXPECT_EQ(filled->fill, 0.3);
  EXPECT_TRUE(validate_cage(filled->mesh, sausage)->valid());
  EXPECT_EQ(envelope(sausage, {.resolution = 30, .fill = 0.02})->genus, 1); // it is wider

  const TriangleMesh torus = make_torus(0.6, 60, 30);
  EXPECT_EQ(envelope(torus, {.resolution = 30, .fill = 0.3})->genus, 1);
  EXPECT_EQ(envelope(torus, {.resolution = 30, .vertices = 6, .fill = 0.3})->genus, 0);
}

TEST(Handles, OfHalfAnEnvelopeAreFilledInTheWhole) {
  TriangleMesh sausage = bent_sausage(0.6);
  for (Vec3& p : sausage.positions) {
    p = Vec3(p.y(), p.z(), p.x()); // its own mirror image in x = 0
  }
  const Result<Envelope> half = envelope(sausage, {.resolution = 30, .fill = 0.3, .half = true});
  ASSERT_TRUE(half) << half.error().message;
  EXPECT_EQ(half->genus, 0);
  EXPECT_TRUE(std::all_of(half->mesh.positions.begin(), half->mesh.positions.end(),
                          [](const Vec3& p) { return p.x() >= 0; }));
}

} // namespace
} // namespace cagewright
