#include "app/commands/editor.h"

#include "mesh/shapes.h"

#include <gtest/gtest.h>

namespace cagewright::app {
namespace {

class DocumentTest : public testing::Test {
protected:
  void SetUp() override {
    const auto model = prepare_model(PolygonMesh(make_icosphere(2)), {});
    ASSERT_TRUE(model) << model.error().message;
    document_.set_model(*model);
    TriangleMesh cube = make_cube();
    editor_.edit_topology(PolygonMesh(cube), {}, "cube");
  }

  Document document_;
  Editor editor_{document_};
};

TEST_F(DocumentTest, TakesADragBackInOneStep) {
  const std::vector<Vec3> before(document_.cage_positions().begin(),
                                 document_.cage_positions().end());
  editor_.begin_move({3});
  for (int i = 1; i <= 5; ++i) {
    editor_.move_to(std::vector<Vec3>{Vec3(i, i, i)});
  }
  editor_.end_move("Move");
  EXPECT_EQ(document_.cage_positions()[3], Vec3(5, 5, 5));
  editor_.undo_stack().undo();
  EXPECT_TRUE(std::ranges::equal(document_.cage_positions(), before));
  editor_.undo_stack().redo();
  EXPECT_EQ(document_.cage_positions()[3], Vec3(5, 5, 5));
}

TEST_F(DocumentTest, PutsACancelledDragBackWithoutAStep) {
  const int steps = editor_.undo_stack().count();
  const Vec3 before = document_.cage_positions()[0];
  editor_.begin_move({0});
  editor_.move_to(std::vector<Vec3>{Vec3(9, 9, 9)});
  editor_.cancel_move();
  EXPECT_EQ(document_.cage_positions()[0], before);
  EXPECT_EQ(editor_.undo_stack().count(), steps);
}

TEST_F(DocumentTest, CutsTheSelectionToWhatTheNewCageHas) {
  editor_.select({.mode = SelectionMode::vertex, .vertices = {1, 7}, .edges = {}, .faces = {}});
  State state = document_.state();
  state.rest = std::make_shared<const PolygonMesh>(make_tetrahedron());
  state.cage = std::make_shared<const std::vector<Vec3>>(state.rest->positions);
  editor_.change(state, "smaller");
  EXPECT_EQ(document_.selection().vertices, std::vector<Index>{1});
}

} // namespace
} // namespace cagewright::app
