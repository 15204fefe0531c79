#include "app/edit/outlined_faces.h"

#include "app/edit/pick.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/triangulate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

/// A ball of `mesh`'s faces, seen from a corner, and an outline round all of the picture's right.
struct Scene {
  PolygonMesh mesh;
  std::vector<Triangle> triangles;
  TriangleBvh bvh;
  ScreenOutline outline;

  explicit Scene(PolygonMesh shape)
      : mesh(std::move(shape)), triangles(triangulate(mesh).triangles),
        bvh(TriangleView{mesh.positions, triangles}) {
    outline.camera.resize(640, 480);
    const Box3 box(Vec3(-1.5, -1.5, -1.5), Vec3(1.5, 1.5, 1.5));
    outline.camera.set_scene(box);
    outline.camera.frame(box);
    outline.camera.orbit({90, 47});
    outline.pixels = rectangle({320, 0}, {640, 480});
  }

  [[nodiscard]] Vec3 middle(Index face) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : mesh.face(face)) {
      sum += mesh.positions[v];
    }
    return sum / static_cast<double>(mesh.face(face).size());
  }
  [[nodiscard]] std::vector<Index> found() const { return *outlined_faces(mesh, bvh, outline); }
};

TEST(OutlinedFaces, AreThoseWithinThatAreSeen) {
  const Scene scene{PolygonMesh(make_icosphere(3))};
  const std::vector<Index> found = scene.found();
  for (Index f = 0; f < scene.mesh.face_count(); ++f) {
    const Vec3 p = scene.middle(f);
    const double x = scene.outline.camera.project(p)->pixel.x();
    const double facing = p.dot(scene.outline.camera.to_viewer(p));
    const bool is_found = std::ranges::binary_search(found, f);
    if (x < 320 || facing < -0.15) {
      EXPECT_FALSE(is_found);
    } else if (x > 320 && facing > 0.15) {
      EXPECT_TRUE(is_found);
    }
  }
  EXPECT_TRUE(std::ranges::is_sorted(found));
}

TEST(OutlinedFaces, AreHiddenOnesTooWhenAsked) {
  Scene scene{PolygonMesh(make_icosphere(3))};
  scene.outline.see_through = true;
  scene.outline.pixels = rectangle({0, 0}, {640, 480});
  EXPECT_EQ(scene.found().size(), scene.mesh.face_count());
}

TEST(OutlinedFaces, NeedNotBeFlatOrThereOnce) {
  // Quads that are bent across, so that their middles lie behind them, and each of them twice.
  PolygonMesh bent;
  const int n = 8;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double height = (i + j) % 2 == 0 ? 0.15 : -0.15;
      bent.positions.emplace_back(2.0 * i / n - 1, 2.0 * j / n - 1, height);
    }
  }
  for (int copy = 0; copy < 2; ++copy) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const auto at = [&](int a, int b) { return static_cast<Index>(a * (n + 1) + b); };
        bent.add_face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  Scene scene{std::move(bent)};
  scene.outline.camera.look(StandardView::front);
  scene.outline.pixels = rectangle({0, 0}, {640, 480});
  EXPECT_EQ(scene.found().size(), scene.mesh.face_count());
}

TEST(OutlinedFaces, StopWhenAsked) {
  const Scene scene{PolygonMesh(make_icosphere(3))};
  const StopFlag stop;
  stop.request_stop();
  const Result<std::vector<Index>> found =
      outlined_faces(scene.mesh, scene.bvh, scene.outline, Progress(stop));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace cagewright::app
