#include "voxel/surface_patches.h"

#include "voxel/test_meshes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>

namespace cagewright {
namespace {

double volume(const TriangleMesh& mesh, const SurfacePatches& patches) {
  return signed_volume(TriangleView{mesh.positions, patches.triangles});
}

TEST(SurfacePatches, TurnClosedPatchesOutward) {
  const TriangleMesh far = test::moved(make_icosphere(2), Mat3::Identity(), 1, {5, 0, 0});
  for (const TriangleMesh& mesh :
       {joined(make_cube(), far), joined(make_cube(), test::inverted(far)),
        test::with_flips(joined(make_cube(), far), 0.4, 1),
        test::as_soup(test::with_flips(joined(make_cube(), far), 0.4, 2))}) {
    const SurfacePatches patches = surface_patches(mesh);
    EXPECT_EQ(patches.closed, std::vector<bool>({true, true}));
    EXPECT_NEAR(volume(mesh, patches), 8 + signed_volume(make_icosphere(2)), 1e-9);
  }
}

TEST(SurfacePatches, CountRepeatedTrianglesOnce) {
  TriangleMesh cube = make_cube();
  const TriangleMesh back = test::inverted(cube);
  cube.triangles.insert(cube.triangles.end(), back.triangles.begin(), back.triangles.end());
  cube.triangles.push_back({1, 1, 2});
  const SurfacePatches patches = surface_patches(cube);
  EXPECT_EQ(patches.triangles.size(), 12U);
  EXPECT_TRUE(patches.all_closed());
}

TEST(SurfacePatches, EndAtEdgesOfThreeTriangles) {
  TriangleMesh cube = make_cube();
  cube.positions.emplace_back(3, 3, 0);
  cube.triangles.push_back({3, 7, 8}); // a fin on the edge x = y = 1
  const SurfacePatches patches = surface_patches(cube);
  EXPECT_EQ(patches.closed.size(), 2U);
  EXPECT_FALSE(patches.all_closed());
  EXPECT_NE(patches.patch[0], patches.patch[12]);
}

TEST(SurfacePatches, DoNotTakeAMoebiusStripForClosed) {
  // A projective plane of ten triangles: every edge has two, but no orientation is consistent.
  const TriangleMesh plane{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}},
                           {{0, 1, 4},
                            {0, 4, 3},
                            {0, 3, 5},
                            {0, 5, 2},
                            {0, 2, 1},
                            {1, 2, 3},
                            {1, 3, 5},
                            {1, 5, 4},
                            {2, 3, 4},
                            {2, 4, 5}}};
  const SurfacePatches patches = surface_patches(plane);
  EXPECT_EQ(patches.closed, std::vector<bool>({false}));
}

TEST(SurfacePatches, OfAnOpenMeshKeepTheMajoritysOrientation) {
  TriangleMesh open = make_icosphere(3);
  open.triangles.resize(1000);
  const SurfacePatches patches = surface_patches(test::with_flips(open, 0.2, 3));
  EXPECT_EQ(patches.triangles, surface_patches(open).triangles);
}

} // namespace
} // namespace cagewright
