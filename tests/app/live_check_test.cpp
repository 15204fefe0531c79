#include "app/commands/editor.h"
#include "app/document/document.h"
#include "mesh/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace cagewright::app {
namespace {

/// A sphere in a cube, being refined.
class LiveCheckTest : public testing::Test {
protected:
  void SetUp() override {
    Result<std::shared_ptr<const Model>> model = prepare_model(PolygonMesh(make_icosphere(3)), {});
    ASSERT_TRUE(model);
    document.set_model(*model);
    PolygonMesh cage(make_cube());
    for (Vec3& p : cage.positions) {
      p *= 4;
    }
    editor.replace_cage(std::make_shared<const PolygonMesh>(cage), nullptr, "Cage");
  }

  Document document;
  Editor editor{document};
};

TEST_F(LiveCheckTest, TellsTheOffendingFacesWhileTheMouseIsStillHeld) {
  const Vec3 corner = document.cage_positions()[0];
  editor.begin_move({0});
  editor.move_to(std::vector<Vec3>{0.9 * corner});
  EXPECT_TRUE(document.offending_faces().empty());
  editor.move_to(std::vector<Vec3>{Vec3::Zero()});
  ASSERT_FALSE(document.offending_faces().empty()) << "the corner is inside the model";
  for (const Index f : document.offending_faces()) {
    const auto face = document.cage_rest().face(f);
    EXPECT_TRUE(std::find(face.begin(), face.end(), Index{0}) != face.end());
  }
  editor.move_to(std::vector<Vec3>{corner});
  EXPECT_TRUE(document.offending_faces().empty()) << "all is well again, and so it is told";
  editor.cancel_move();
}

TEST_F(LiveCheckTest, StopsTheVertexAtContactAndLeavesTheCageValid) {
  ToolSettings tools;
  tools.stop_at_contact = true;
  document.set_tools(tools);
  const Vec3 corner = document.cage_positions()[0];
  editor.begin_move({0});
  editor.move_to(std::vector<Vec3>{Vec3::Zero()});
  EXPECT_TRUE(document.offending_faces().empty());
  EXPECT_GT(document.cage_positions()[0].norm(), 1);
  EXPECT_LT(document.cage_positions()[0].norm(), corner.norm());
  editor.cancel_move();
  EXPECT_EQ(document.cage_positions()[0], corner);
}

} // namespace
} // namespace cagewright::app
