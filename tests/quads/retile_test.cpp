#include "quads/retile.h"

#include "quad_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace cagewright {
namespace {

using test::QuadScene;

TEST(Retile, MakesQuadsOfTrianglesAndKeepsTheCageValid) {
  QuadScene scene;
  scene.cage = QuadCage(scene.triangles); // nothing is paired yet
  const std::size_t triangles = scene.count(3);
  const std::vector<Vec3> positions = scene.cage.positions();
  const std::size_t exchanged = retile(scene.cage, scene.guard, scene.field, {});
  EXPECT_GT(exchanged, 0U);
  EXPECT_LT(scene.count(3), triangles);
  EXPECT_GT(scene.count(4), 0U);
  EXPECT_EQ(scene.cage.positions(), positions) << "faces change, vertices do not";
  scene.expect_sound();
}

TEST(Retile, KeepsTheBordersOfParts) {
  QuadScene scene;
  std::vector<Index> parts;
  for (const Triangle& t : scene.triangles.triangles) {
    const std::vector<Vec3>& p = scene.triangles.positions;
    parts.push_back(p[t[0]].z() + p[t[1]].z() + p[t[2]].z() > 0 ? 1 : 0);
  }
  scene.cage = QuadCage(scene.triangles, parts);
  const auto border = [&] {
    std::vector<std::array<Index, 2>> sides;
    for (Index f = 0; f < scene.cage.face_end(); ++f) {
      const CageFace& face = scene.cage.face(f);
      for (int i = 0; i < face.size; ++i) {
        const Index across = scene.cage.face_left_of(face[i + 1], face[i]);
        if (face.part == 1 && scene.cage.face(across).part == 0) {
          sides.push_back({face[i], face[i + 1]});
        }
      }
    }
    std::sort(sides.begin(), sides.end());
    return sides;
  };
  const auto before = border();
  ASSERT_FALSE(before.empty());
  pair_triangles(scene.cage, scene.guard, scene.field, {});
  retile(scene.cage, scene.guard, scene.field, {});
  EXPECT_EQ(border(), before);
  scene.expect_sound();
}

TEST(Retile, StopsWhenAskedWithAValidCage) {
  QuadScene scene;
  StopFlag source;
  source.request_stop();
  retile(scene.cage, scene.guard, scene.field, {}, Progress(source));
  scene.expect_sound();
}

} // namespace
} // namespace cagewright
