#include "app/edit/pick.h"

#include "app/edit/select.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include "quads.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace cagewright::app {
namespace {

struct Scene {
  PolygonMesh cage;
  CageGraph graph;
  OrbitCamera camera;
  Picker picker;

  explicit Scene(PolygonMesh mesh) : cage(std::move(mesh)), graph(cage), picker(cage, graph) {
    camera.resize(640, 480);
    const Box3 box(Vec3(-1.5, -1.5, -1.5), Vec3(1.5, 1.5, 1.5));
    camera.set_scene(box);
    camera.frame(box);
    camera.orbit({90, 47});
  }
  [[nodiscard]] Pixel at(const Vec3& p) const { return camera.project(p)->pixel; }
};

TEST(Pick, FindsVisibleVerticesUnderTheCursorAndNoHiddenOnes) {
  const Scene scene{PolygonMesh(make_icosphere(2))};
  int seen = 0;
  for (Index v = 0; v < scene.cage.positions.size(); ++v) {
    const Vec3& p = scene.cage.positions[v];
    const auto pick = scene.picker.pick(scene.camera, scene.at(p), SelectionMode::vertex);
    const double facing = p.dot(scene.camera.to_viewer(p));
    if (facing > 0.15) {
      ASSERT_TRUE(pick);
      EXPECT_EQ(pick->element, v);
      ++seen;
    } else if (facing < -0.15) {
      EXPECT_TRUE(!pick || pick->element != v) << "behind the ball";
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Pick, SeesThroughWhenAsked) {
  const Scene scene{PolygonMesh(make_icosphere(1))};
  const PickOptions through{.radius = 4, .see_through = true};
  int hidden = 0;
  for (Index v = 0; v < scene.cage.positions.size(); ++v) {
    const Vec3& p = scene.cage.positions[v];
    const auto pick = scene.picker.pick(scene.camera, scene.at(p), SelectionMode::vertex, through);
    ASSERT_TRUE(pick);
    EXPECT_LE(pick->distance, 4);
    hidden += pick->element == v && p.dot(scene.camera.to_viewer(p)) < 0 ? 1 : 0;
  }
  EXPECT_GT(hidden, 10);
}

TEST(Pick, FindsNothingOutOfReach) {
  const Scene scene(test::quad_cube());
  EXPECT_FALSE(scene.picker.pick(scene.camera, {2, 2}, SelectionMode::vertex));
  EXPECT_FALSE(scene.picker.pick(scene.camera, {2, 2}, SelectionMode::edge));
  EXPECT_FALSE(scene.picker.pick(scene.camera, {2, 2}, SelectionMode::face));
}

TEST(Pick, FindsEdgesAtTheirPointUnderTheCursor) {
  const Scene scene(test::quad_torus());
  Random random(8);
  for (Index e = 0; e < scene.graph.edge_count(); ++e) {
    const auto [a, b] = scene.graph.edge(e);
    const double t = random.uniform(0.3, 0.7);
    const Vec3 p = (1 - t) * scene.cage.positions[a] + t * scene.cage.positions[b];
    const auto pick = scene.picker.pick(scene.camera, scene.at(p), SelectionMode::edge);
    if (scene.picker.is_visible(scene.camera, p)) {
      ASSERT_TRUE(pick);
      EXPECT_LT(pick->distance, 1.5);
      if (pick->element == e) {
        EXPECT_LT((pick->point - p).norm(), 1e-6) << "in space, not only on the screen";
      }
    }
  }
}

TEST(Pick, FindsTheFrontFace) {
  const Scene scene(test::quad_cube(3));
  int seen = 0;
  for (Index f = 0; f < scene.cage.face_count(); ++f) {
    const auto face = scene.cage.face(f);
    const Vec3 center = (scene.cage.positions[face[0]] + scene.cage.positions[face[2]]) / 2;
    const auto pick = scene.picker.pick(scene.camera, scene.at(center), SelectionMode::face);
    ASSERT_TRUE(pick);
    if (pick->element == f) {
      ++seen;
      EXPECT_TRUE(scene.picker.is_visible(scene.camera, center)) << f;
    }
  }
  EXPECT_GE(seen, 9) << "a side at least";
}

TEST(Pick, BoxOverEverythingSelectsWhatIsSeen) {
  const Scene scene{PolygonMesh(make_icosphere(2))};
  const std::vector<Pixel> all = rectangle({0, 0}, {640, 480});
  for (const SelectionMode mode :
       {SelectionMode::vertex, SelectionMode::edge, SelectionMode::face}) {
    const Selection through =
        scene.picker.within(scene.camera, all, mode, {.radius = 0, .see_through = true});
    EXPECT_EQ(through, select_all(mode, scene.graph));
    const Selection seen = scene.picker.within(scene.camera, all, mode);
    EXPECT_GT(seen.size(), through.size() / 3);
    EXPECT_LT(seen.size(), 2 * through.size() / 3);
    const Selection reversed =
        scene.picker.within(scene.camera, rectangle({640, 480}, {0, 0}), mode);
    EXPECT_EQ(reversed, seen) << "a box may be drawn in any direction";
  }
}

TEST(Pick, LassoTakesWhatItGoesRound) {
  const Scene scene(test::quad_cube(2));
  const Vec3& p = scene.cage.positions[0];
  const Pixel c = scene.at(p);
  const std::vector<Pixel> lasso = {c + Pixel(-9, -5), c + Pixel(8, -8), c + Pixel(9, 6),
                                    c + Pixel(0, 10)};
  const Selection s = scene.picker.within(scene.camera, lasso, SelectionMode::vertex,
                                          {.radius = 0, .see_through = true});
  EXPECT_EQ(s.vertices, std::vector<Index>{0});
}

TEST(Pick, AnswersForTenThousandFaces) {
  const Scene scene{PolygonMesh(make_icosphere(5))};
  const auto pick = scene.picker.pick(scene.camera, {320, 240}, SelectionMode::vertex);
  ASSERT_TRUE(pick);
  EXPECT_LT(pick->distance, 12);
}

TEST(Pick, TakesEveryFaceThatIsSeenHoweverBent) {
  PolygonMesh bent = test::quad_torus(12, 10);
  Random random(11);
  for (Vec3& p : bent.positions) {
    p += 0.04 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  }
  const Scene scene{bent};
  std::vector<char> seen(bent.face_count(), 0);
  for (int x = 0; x < 640; x += 4) {
    for (int y = 0; y < 480; y += 4) {
      if (const auto pick = scene.picker.face_at(scene.camera, {x, y})) {
        ++seen[pick->element];
      }
    }
  }
  const Selection found =
      scene.picker.within(scene.camera, rectangle({0, 0}, {640, 480}), SelectionMode::face, {});
  int many = 0;
  for (Index f = 0; f < bent.face_count(); ++f) {
    const bool taken = std::ranges::binary_search(found.faces, f);
    if (seen[f] > 12) { // of pixels in a grid of four
      EXPECT_TRUE(taken) << "face " << f;
      ++many;
    }
    EXPECT_TRUE(seen[f] > 0 || !taken) << "face " << f << " is hidden";
  }
  EXPECT_GT(many, 30);
}

} // namespace
} // namespace cagewright::app
