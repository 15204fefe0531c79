#include "improve/placement.h"

#include "improve_scene.h"

#include <gtest/gtest.h>

namespace cagewright {
namespace {

using test::ImproveScene;

TEST(PlaceClearOfModel, LowersTheObjectiveClearOfTheModel) {
  const ImproveScene scene(test::bumpy_model(), test::scaled(test::bumpy_model(2), 1.2));
  const CageMesh& mesh = scene.cage.mesh;
  const std::vector<double> values = scene.objective.face_values(mesh);
  int placed = 0;
  for (Index v = 0; v < mesh.vertex_end(); v += 7) {
    const std::optional<Vec3> at =
        place_clear_of_model(scene.guard, scene.objective, mesh, mesh.move(v, mesh.position(v)));
    if (at) {
      ++placed;
      const Patch patch = mesh.move(v, *at);
      EXPECT_FALSE(scene.guard.too_near(mesh, patch));
      EXPECT_LT(scene.objective.change(mesh, values, patch), 0);
    }
  }
  EXPECT_GT(placed, 15) << "there is much room below every vertex";
}

TEST(PlaceClearOfModel, OfACollapseTooKeepsTheClearance) {
  const ImproveScene scene;
  const CageMesh& mesh = scene.cage.mesh;
  int placed = 0;
  for (Index f = 0; f < mesh.face_end(); f += 11) {
    if (std::optional<Patch> patch = mesh.collapse(mesh.face(f)[0], mesh.face(f)[1])) {
      if (const auto at = place_clear_of_model(scene.guard, scene.objective, mesh, *patch)) {
        ++placed;
        patch->position = *at;
        EXPECT_FALSE(scene.guard.too_near(mesh, *patch));
      }
    }
  }
  EXPECT_GT(placed, 10);
}

TEST(PlaceOutsidePatch, EnclosesWhatTheOldFacesDid) {
  const ImproveScene scene;
  const CageMesh& mesh = scene.cage.mesh;
  int placed = 0;
  for (Index f = 0; f < mesh.face_end(); f += 5) {
    std::optional<Patch> patch = mesh.collapse(mesh.face(f)[0], mesh.face(f)[1]);
    const std::optional<Vec3> at = patch ? place_outside_patch(mesh, *patch) : std::nullopt;
    if (!at) {
      continue;
    }
    ++placed;
    patch->position = *at;
    EXPECT_GE(Objective::volume_change(mesh, *patch), 0) << "a hull grows";
    for (const Index g : patch->removed) {
      const Corners t = corners_of(mesh, g);
      EXPECT_GE((t[1] - t[0]).cross(t[2] - t[0]).normalized().dot(*at - t[0]), -1e-9);
    }
  }
  EXPECT_GT(placed, 20);
}

TEST(PromisedGain, IsThereWhereThereIsRoom) {
  const ImproveScene roomy;
  const CageMesh& mesh = roomy.cage.mesh;
  EXPECT_GT(promised_gain(roomy.guard, roomy.objective, mesh, mesh.move(3, mesh.position(3))), 0);
}

} // namespace
} // namespace cagewright
