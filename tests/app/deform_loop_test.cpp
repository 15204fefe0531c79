#include "app/jobs/deform_loop.h"

#include "app/commands/editor.h"
#include "app/document/binding.h"
#include "mesh/shapes.h"

#include <QCoreApplication>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace cagewright::app {
namespace {

/// A sphere in a cube of quads, bound.
class DeformLoopTest : public testing::Test {
protected:
  void SetUp() override {
    Result<std::shared_ptr<const Model>> model = prepare_model(PolygonMesh(make_icosphere(2)), {});
    ASSERT_TRUE(model);
    document.set_model(*model);
    PolygonMesh cage = make_quad_cube();
    for (Vec3& p : cage.positions) {
      p *= 3;
    }
    rest = std::make_shared<const PolygonMesh>(cage);
    editor.replace_cage(rest, nullptr, "Cage");
    model_at_rest = model_now();
    bind();
    loop.finish();
  }

  void bind() {
    Result<Deformer> deformer = Deformer::bind(document.model()->mesh, *rest);
    ASSERT_TRUE(deformer) << deformer.error().message;
    editor.bind(std::make_shared<const Binding>(*std::move(deformer), CoordinateSettings(),
                                                *prepare_coordinates(*rest)),
                rest);
  }
  std::vector<Vec3> model_now() {
    return {document.model_positions().begin(), document.model_positions().end()};
  }
  /// The whole cage by so much along x: the model follows by as much.
  void move_cage(double by) {
    std::vector<Index> all;
    std::vector<Vec3> to;
    for (Index v = 0; v < rest->positions.size(); ++v) {
      all.push_back(v);
      to.emplace_back(rest->positions[v] + by * Vec3::UnitX());
    }
    editor.move(all, to, "Move");
  }
  double model_moved() { return model_now()[0].x() - model_at_rest[0].x(); }
  void show_weights_of(Index vertex) {
    Layers layers = document.layers();
    layers.weights = true;
    document.set_layers(layers);
    editor.select({.mode = SelectionMode::vertex, .vertices = {vertex}, .edges = {}, .faces = {}});
  }

  Document document;
  Editor editor{document};
  DeformLoop loop{document};
  std::shared_ptr<const PolygonMesh> rest;
  std::vector<Vec3> model_at_rest;
};

TEST_F(DeformLoopTest, ShowsTheLastOfMovesThatComeFasterThanItWorks) {
  for (int i = 1; i <= 200; ++i) {
    move_cage(0.01 * i);
  }
  loop.finish();
  EXPECT_NEAR(model_moved(), 2, 1e-5);
}

TEST_F(DeformLoopTest, FinishesWhatTheDisplayHasNotSeenYet) {
  move_cage(1);
  loop.wait(); // made, not shown: no event has been handled
  EXPECT_NEAR(model_moved(), 0, 1e-5);
  show_weights_of(0);
  loop.wait(); // an answer with colours alone is put to it
  QCoreApplication::processEvents();
  EXPECT_NEAR(model_moved(), 1, 1e-5) << "the move before the colours is not lost";
  EXPECT_EQ(document.model_weights().size(), model_at_rest.size());
}

TEST_F(DeformLoopTest, KeepsColorsThatAMoveFollows) {
  show_weights_of(0);
  loop.wait();
  move_cage(1);
  loop.wait();
  QCoreApplication::processEvents();
  EXPECT_EQ(document.model_weights().size(), model_at_rest.size());
  EXPECT_NEAR(model_moved(), 1, 1e-5);
}

TEST_F(DeformLoopTest, LosesNothingThatIsAskedForInOneBreath) {
  // Colors and moves that come before the thread has woken become one request. Often enough that
  // some do, whatever the machine is doing.
  for (int i = 1; i <= 40; ++i) {
    document.set_layers({});
    show_weights_of(static_cast<Index>(i % 8));
    move_cage(0.01 * i);
    loop.finish();
    ASSERT_EQ(document.model_weights().size(), model_at_rest.size()) << i;
    ASSERT_NEAR(model_moved(), 0.01 * i, 1e-5) << i;
    document.set_layers({});
    move_cage(0.02 * i);
    show_weights_of(static_cast<Index>((i + 3) % 8));
    loop.finish();
    ASSERT_EQ(document.model_weights().size(), model_at_rest.size()) << i;
    ASSERT_NEAR(model_moved(), 0.02 * i, 1e-5) << i;
  }
}

TEST_F(DeformLoopTest, ShowsNoAnswerOfABindingThatIsNoMore) {
  move_cage(1);
  loop.wait();
  while (editor.undo_stack().canUndo() && document.mode() == Mode::deform) {
    editor.undo_stack().undo();
  }
  ASSERT_EQ(document.mode(), Mode::refine);
  QCoreApplication::processEvents();
  EXPECT_EQ(model_now(), model_at_rest) << "an unbound model is as it was read";
}

TEST_F(DeformLoopTest, ShowsTheModelOfTheNewBindingNotOfTheOld) {
  move_cage(1);
  loop.wait();
  editor.refine(); // back to the cage at rest
  bind();
  loop.finish();
  EXPECT_NEAR(model_moved(), 0, 1e-5);
}

} // namespace
} // namespace cagewright::app
