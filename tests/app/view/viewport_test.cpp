#include "app/view/viewport.h"

#include "app/document/binding.h"
#include "app/edit/cage_watch.h"
#include "app/edit/mirror_edit.h"
#include "app/edit/select.h"
#include "app/jobs/deform_loop.h"
#include "core/random.h"
#include "mesh/shapes.h"
#include "mouse.h"
#include "quads.h"
#include "waiting.h"

#include <QGuiApplication>
#include <QSignalSpy>
#include <QTest>
#include <QWheelEvent>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace cagewright::app {
namespace {

PolygonMesh ball() {
  TriangleMesh mesh = make_icosphere(4);
  for (Vec3& p : mesh.positions) {
    const double waves = 1 + 0.12 * std::sin(6 * p.x()) * std::sin(5 * p.y());
    p *= 0.8 * waves;
  }
  return PolygonMesh(mesh);
}

/// A window with a model and a cage of quads round it.
class ViewportWith : public testing::Test {
protected:
  Document document;
  Editor editor{document};
  Viewport view{editor};

  void SetUp() override {
    Result<std::shared_ptr<const Model>> model = prepare_model(ball(), {});
    ASSERT_TRUE(model);
    document.set_model(*model);
    set_cage(test::quad_cube(3));
    view.resize(640, 480);
    view.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&view));
    view.setFocus();
    view.set_standard_view("three-quarter");
    view.frame_all();
    settle();
  }

  void set_cage(const PolygonMesh& cage) {
    State state = document.state();
    state.rest = std::make_shared<const PolygonMesh>(cage);
    state.cage = std::make_shared<const std::vector<Vec3>>(cage.positions);
    state.selection = {};
    document.set_state(state);
  }

  void settle() {
    QGuiApplication::sync(); // what the display has still to say
    view.grabFramebuffer();
  }

  QImage keep(const char* name) {
    settle();
    const QImage image = view.grabFramebuffer();
    image.save(QString("%1/%2.png").arg(CAGEWRIGHT_SCREENSHOTS, name));
    return image;
  }

  [[nodiscard]] QPoint at(const Vec3& p) const {
    const Pixel pixel = view.camera().project(p)->pixel;
    return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
  }
  [[nodiscard]] QPoint at_vertex(Index v) const { return at(document.cage_positions()[v]); }

  void drag(QPoint from, QPoint to, Qt::KeyboardModifiers modifiers = {},
            Qt::MouseButton button = Qt::LeftButton) {
    test::drag_mouse(view, from, to, modifiers, button);
  }

  /// The vertex nearest to the viewer.
  [[nodiscard]] Index front_vertex() const {
    const std::span<const Vec3> p = document.cage_positions();
    const Vec3 backward = view.camera().axes().row(2);
    return static_cast<Index>(std::max_element(p.begin(), p.end(),
                                               [&](const Vec3& a, const Vec3& b) {
                                                 return a.dot(backward) < b.dot(backward);
                                               }) -
                              p.begin());
  }

  void key(int k, Qt::KeyboardModifiers modifiers = {}) {
    QTest::keyClick(&view, static_cast<Qt::Key>(k), modifiers);
  }
};

TEST_F(ViewportWith, ShowsModelAndCage) {
  const QImage image = keep("cage-of-quads");
  ASSERT_EQ(image.size(), view.size() * view.devicePixelRatioF());
  document.set_layers([&] {
    Layers layers = document.layers();
    layers.model = false;
    return layers;
  }());
  const QImage without = keep("cage-without-model");
  EXPECT_NE(image.pixel(image.width() / 2, image.height() / 2),
            without.pixel(image.width() / 2, image.height() / 2));
}

TEST_F(ViewportWith, SelectsByClicks) {
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  EXPECT_EQ(document.selection().vertices, std::vector<Index>{v});
  key(Qt::Key_2);
  EXPECT_EQ(document.selection().mode, SelectionMode::edge);
  key(Qt::Key_3);
  EXPECT_EQ(document.selection().mode, SelectionMode::face);
  const QPoint middle(320, 240);
  QTest::mouseClick(&view, Qt::LeftButton, {}, middle);
  EXPECT_EQ(document.selection().faces.size(), 1U);
  keep("face-selected");
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(4, 4));
  EXPECT_TRUE(document.selection().empty());
}

TEST_F(ViewportWith, AddsAndTakesAwayWithShift) {
  ToolSettings tools;
  tools.tool = Tool::select_box; // no gizmo in the way
  document.set_tools(tools);
  const Index v = front_vertex();
  const CageGraph graph(document.cage());
  const Index other = graph.other_end(graph.vertex_edges(v)[0], v);
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  QTest::mouseClick(&view, Qt::LeftButton, Qt::ShiftModifier, at_vertex(other));
  EXPECT_EQ(document.selection().size(), 2U);
  QTest::mouseClick(&view, Qt::LeftButton, Qt::ShiftModifier, at_vertex(v));
  EXPECT_EQ(document.selection().vertices, std::vector<Index>{other});
}

TEST_F(ViewportWith, SelectsByABoxAndALasso) {
  ToolSettings tools;
  tools.tool = Tool::select_box;
  tools.see_through = true;
  document.set_tools(tools);
  drag({3, 3}, {636, 476});
  EXPECT_EQ(document.selection().size(), document.cage_positions().size());
  tools.see_through = false;
  document.set_tools(tools);
  drag({3, 3}, {636, 476});
  EXPECT_LT(document.selection().size(), document.cage_positions().size());
  EXPECT_GT(document.selection().size(), 10U);
  const Index v = front_vertex();
  const QPoint c = at_vertex(v);
  QTest::mousePress(&view, Qt::LeftButton, Qt::ControlModifier, c + QPoint(-12, -12));
  for (const QPoint& p : {QPoint(12, -12), QPoint(12, 12), QPoint(-12, 12)}) {
    test::move_mouse(view, c + p, Qt::LeftButton, Qt::ControlModifier);
  }
  QTest::mouseRelease(&view, Qt::LeftButton, Qt::ControlModifier, c + QPoint(-12, 12));
  EXPECT_EQ(document.selection().vertices, std::vector<Index>{v});
}

TEST_F(ViewportWith, DraggingAHandleMovesAlongItsAxisInOneStepOfUndo) {
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  settle();
  const std::optional<GizmoFrame> gizmo = view.gizmo();
  ASSERT_TRUE(gizmo);
  const std::vector<Vec3> before(document.cage_positions().begin(),
                                 document.cage_positions().end());
  const int steps = editor.undo_stack().count();
  const double pixel = view.camera().pixel_size(gizmo->origin);
  const QPoint handle = at(gizmo->origin + 50 * pixel * Vec3::UnitX());
  const QPoint end = at(gizmo->origin + 90 * pixel * Vec3::UnitX());
  keep("gizmo");
  drag(handle, end);
  const Vec3 moved = document.cage_positions()[v] - before[v];
  EXPECT_NEAR(moved.x(), 40 * pixel, 4 * pixel);
  EXPECT_EQ(moved.y(), 0);
  EXPECT_EQ(moved.z(), 0);
  EXPECT_EQ(editor.undo_stack().count(), steps + 1);
  editor.undo_stack().undo();
  EXPECT_TRUE(std::equal(before.begin(), before.end(), document.cage_positions().begin()));
}

TEST_F(ViewportWith, DraggingAVertexMovesIt) {
  const Index v = front_vertex();
  const QPoint from = at_vertex(v);
  drag(from, from + QPoint(30, -25));
  EXPECT_EQ(document.selection().vertices, std::vector<Index>{v});
  EXPECT_LT(QLineF(at_vertex(v), from + QPoint(30, -25)).length(), 3);
}

TEST_F(ViewportWith, MovesExactlyByTypedNumbers) {
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  const Vec3 before = document.cage_positions()[v];
  for (const int k : {Qt::Key_G, Qt::Key_Y, Qt::Key_Minus, Qt::Key_Period, Qt::Key_2, Qt::Key_5}) {
    key(k);
  }
  EXPECT_TRUE(view.transforming());
  keep("typed-move");
  key(Qt::Key_Return);
  EXPECT_FALSE(view.transforming());
  EXPECT_TRUE((document.cage_positions()[v] - before).isApprox(Vec3(0, -0.25, 0)));
}

TEST_F(ViewportWith, EscapeAndTheRightButtonPutEverythingBack) {
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  const Vec3 before = document.cage_positions()[v];
  const int steps = editor.undo_stack().count();
  for (const bool by_key : {true, false}) {
    key(Qt::Key_G);
    test::move_mouse(view, {100, 100});
    if (by_key) {
      key(Qt::Key_Escape);
    } else {
      QTest::mouseClick(&view, Qt::RightButton, {}, {100, 100});
    }
    EXPECT_FALSE(view.transforming());
    EXPECT_EQ(document.cage_positions()[v], before);
    EXPECT_EQ(editor.undo_stack().count(), steps);
  }
}

TEST_F(ViewportWith, OrbitsPansAndZooms) {
  const QJsonObject start = view.camera_state();
  drag({300, 200}, {360, 230}, {}, Qt::MiddleButton);
  EXPECT_NE(view.camera_state()["yaw_degrees"], start["yaw_degrees"]);
  const QJsonObject orbited = view.camera_state();
  drag({300, 200}, {360, 230}, Qt::ShiftModifier, Qt::MiddleButton);
  EXPECT_EQ(view.camera_state()["yaw_degrees"], orbited["yaw_degrees"]);
  EXPECT_NE(view.camera_state()["target"], orbited["target"]);
  QWheelEvent wheel(QPointF(320, 240), view.mapToGlobal(QPointF(320, 240)), {}, {0, 120},
                    Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&view, &wheel);
  EXPECT_LT(view.camera_state()["distance"].toDouble(), start["distance"].toDouble());
  const QJsonObject zoomed = view.camera_state();
  drag({300, 200}, {340, 200}, Qt::AltModifier);
  EXPECT_NE(view.camera_state()["yaw_degrees"], zoomed["yaw_degrees"]);
  view.set_camera_state(start);
  EXPECT_EQ(view.camera_state(), start);
}

TEST_F(ViewportWith, LooksFromTheSidesByTheKeypad) {
  key(Qt::Key_7, Qt::KeypadModifier);
  EXPECT_TRUE(Vec3(view.camera().axes().row(2)).isApprox(Vec3::UnitY()));
  key(Qt::Key_1, Qt::KeypadModifier | Qt::ControlModifier);
  EXPECT_TRUE(Vec3(view.camera().axes().row(2)).isApprox(Vec3(-Vec3::UnitZ())));
  key(Qt::Key_5, Qt::KeypadModifier);
  EXPECT_TRUE(view.orthographic());
  keep("back-orthographic");
}

TEST_F(ViewportWith, SelectsByKeys) {
  key(Qt::Key_A);
  EXPECT_EQ(document.selection().size(), document.cage_positions().size());
  key(Qt::Key_I, Qt::ControlModifier);
  EXPECT_TRUE(document.selection().empty());
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(front_vertex()));
  key(Qt::Key_Plus, Qt::ControlModifier);
  EXPECT_EQ(document.selection().size(), 4U) << "a corner of a cube and its neighbors";
  key(Qt::Key_Minus, Qt::ControlModifier);
  EXPECT_EQ(document.selection().size(), 1U);
  key(Qt::Key_L);
  EXPECT_EQ(document.selection().size(), document.cage_positions().size());
}

TEST_F(ViewportWith, EditsTopologyByKeys) {
  key(Qt::Key_3);
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(320, 240));
  ASSERT_EQ(document.selection().faces.size(), 1U);
  const std::size_t faces = document.cage_rest().face_count();
  key(Qt::Key_E);
  EXPECT_TRUE(view.transforming()) << "goes on with moving what was raised";
  key(Qt::Key_Return);
  EXPECT_EQ(document.cage_rest().face_count(), faces + 4);
  keep("extruded");
  key(Qt::Key_Delete);
  EXPECT_TRUE(test::is_sound(document.cage_rest()));
  while (editor.undo_stack().canUndo()) {
    editor.undo_stack().undo();
  }
  EXPECT_EQ(document.cage_rest().face_count(), faces);
}

/// \param more  than of the other colors; what is behind the model's cage is pale
int count_red(const QImage& image, int more = 60) {
  int red = 0;
  for (int y = 0; y < image.height(); y += 4) {
    for (int x = 0; x < image.width(); x += 4) {
      const QColor c = image.pixelColor(x, y);
      red += c.red() > c.green() + more && c.red() > c.blue() + more ? 1 : 0;
    }
  }
  return red;
}

TEST_F(ViewportWith, ShowsOffendingFacesRed) {
  document.set_offending_faces({0, 1, 2, 9, 20});
  EXPECT_GT(count_red(keep("offending-faces")), 50);
}

TEST_F(ViewportWith, ShowsFacesRedWhileTheyAreDraggedIntoTheModel) {
  constexpr int pale = 25;
  view.set_standard_view("front");
  const std::span<const Vec3> cage = document.cage_positions();
  const auto right = static_cast<Index>(
      std::ranges::max_element(
          cage, {}, [](const Vec3& p) { return p.x() - std::abs(p.y()) - std::abs(p.z()); }) -
      cage.begin());
  editor.select({.mode = SelectionMode::vertex, .vertices = {right}, .edges = {}, .faces = {}});
  const QPoint from = at_vertex(right);
  test::move_mouse(view, from);
  key(Qt::Key_G);
  test::move_mouse(view, from + QPoint(5, 0));
  settle();
  const int outside = count_red(view.grabFramebuffer(), pale);
  test::move_mouse(view, at(Vec3::Zero()));
  settle();
  EXPECT_GT(count_red(keep("dragged-inside"), pale), outside + 100)
      << "while the mouse is still held";
  test::move_mouse(view, from + QPoint(5, 0));
  settle();
  EXPECT_EQ(count_red(view.grabFramebuffer(), pale), outside) << "and no more when it is outside";
  key(Qt::Key_Escape);
}

TEST_F(ViewportWith, ShowsBoxesCutsAndVoxels) {
  const Result<BoxDecomposition> stages = decompose(document.model()->view(), {.resolution = 24});
  ASSERT_TRUE(stages);
  document.set_stages(std::make_shared<const BoxDecomposition>(*stages));
  Layers layers;
  layers.boxes = true;
  layers.depth = 2;
  layers.model = false;
  document.set_layers(layers);
  keep("boxes");
  layers.boxes = false;
  layers.cuts = true;
  layers.model = true;
  document.set_layers(layers);
  keep("cuts");
  layers = {};
  layers.model = false;
  layers.feature_voxels = true;
  document.set_layers(layers);
  keep("voxels");
}

TEST_F(ViewportWith, ShowsWeightsAndTheDarkColors) {
  std::vector<float> weights;
  for (const Vec3& p : document.model_positions()) {
    weights.push_back(static_cast<float>(0.5 + 0.6 * p.y()));
  }
  Layers layers;
  layers.weights = true;
  document.set_layers(layers);
  document.set_model_weights(weights);
  const QImage light = keep("weights");
  view.set_dark(true);
  const QImage dark = keep("weights-dark");
  EXPECT_LT(dark.pixelColor(630, 10).lightness(), light.pixelColor(630, 10).lightness());
}

TEST_F(ViewportWith, ShowsTheRotationGizmoAndTheWireframe) {
  ToolSettings tools;
  tools.tool = Tool::rotate;
  document.set_tools(tools);
  Layers layers;
  layers.wireframe = true;
  layers.smooth_normals = false;
  document.set_layers(layers);
  key(Qt::Key_3);
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(320, 240));
  keep("rotate-wireframe");
  tools.tool = Tool::scale;
  document.set_tools(tools);
  keep("scale");
}

TEST_F(ViewportWith, MovesPartnersWhenSymmetric) {
  ToolSettings tools;
  tools.symmetric = true;
  tools.proportional = true;
  tools.proportional_radius = 0.25;
  document.set_tools(tools);
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  key(Qt::Key_G);
  test::move_mouse(view, at_vertex(v) + QPoint(40, -30));
  keep("symmetric-proportional");
  key(Qt::Key_Return);
  const std::vector<Vec3> now(document.cage_positions().begin(), document.cage_positions().end());
  const std::optional<Symmetry> symmetry = find_symmetry(now, 0, 1e-9);
  ASSERT_TRUE(symmetry);
  EXPECT_EQ(std::count(symmetry->partner.begin(), symmetry->partner.end(), Symmetry::none), 0);
}

TEST_F(ViewportWith, MovesABoundModelByTheMouse) {
  DeformLoop loop(document);
  const auto rest = std::make_shared<const PolygonMesh>(document.cage());
  Result<Deformer> deformer = Deformer::bind(document.model()->mesh, *rest);
  ASSERT_TRUE(deformer) << deformer.error().message;
  editor.bind(std::make_shared<const Binding>(*std::move(deformer), CoordinateSettings(),
                                              *prepare_coordinates(*rest)),
              rest);
  loop.finish();
  const std::vector<Vec3> before(document.model_positions().begin(),
                                 document.model_positions().end());
  const Index v = front_vertex();
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(v));
  settle();
  ASSERT_TRUE(view.gizmo());
  const Vec3 origin = view.gizmo()->origin;
  const double pixel = view.camera().pixel_size(origin);
  drag(at(origin + 50 * pixel * Vec3::UnitX()), at(origin + 110 * pixel * Vec3::UnitX()));
  loop.finish();
  keep("deformed-by-the-mouse");
  const Vec3 moved = document.cage_positions()[v] - rest->positions[v];
  EXPECT_GT(moved.x(), 30 * pixel);
  EXPECT_NEAR(moved.y(), 0, 1e-12);
  // The model follows as the weights say, which add up to the vertex's own share.
  double greatest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3 step = document.model_positions()[i] - before[i];
    EXPECT_NEAR(step.y(), 0, 1e-6);
    EXPECT_NEAR(step.z(), 0, 1e-6);
    greatest = std::max(greatest, step.x() / moved.x());
  }
  EXPECT_GT(greatest, 0.02);
  EXPECT_LT(greatest, 1);
  editor.undo_stack().undo();
  loop.finish();
  EXPECT_TRUE(document.model_positions()[7].isApprox(before[7], 1e-12));
}

TEST_F(ViewportWith, StopsAtContactWhenDraggedByTheMouse) {
  ToolSettings tools;
  tools.stop_at_contact = true;
  document.set_tools(tools);
  QSignalSpy messages(&editor, &Editor::message);
  view.set_standard_view("front");
  settle();
  // A vertex in the middle of the front, pushed into the model.
  key(Qt::Key_3);
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(320, 240));
  ASSERT_EQ(document.selection().faces.size(), 1U);
  view.set_standard_view("right");
  settle();
  ASSERT_TRUE(view.gizmo());
  const Vec3 origin = view.gizmo()->origin;
  const double pixel = view.camera().pixel_size(origin);
  drag(at(origin + 50 * pixel * Vec3::UnitZ()),
       at(origin + (50 - 1.5 / pixel) * pixel * Vec3::UnitZ()));
  keep("stopped-at-contact");
  EXPECT_GT(messages.count(), 0);
  const CageWatch judge(document.cage(),
                        std::make_shared<const WatchedModel>(document.model()->view()));
  EXPECT_TRUE(judge.is_valid()) << "the drag went further than it may";
  const std::vector<Index> corners = vertices_of(document.selection(), CageGraph(document.cage()));
  EXPECT_LT(document.cage_positions()[corners[0]].z(), 1) << "it went nowhere";
  EXPECT_GT(document.cage_positions()[corners[0]].z(), 0);
}

TEST_F(ViewportWith, ExtrudesBothSidesAlikeWhenSymmetric) {
  ToolSettings tools;
  tools.symmetric = true;
  document.set_tools(tools);
  view.set_standard_view("right");
  settle();
  key(Qt::Key_3);
  QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(320, 240));
  ASSERT_EQ(document.selection().faces.size(), 1U);
  const std::size_t faces = document.cage_rest().face_count();
  key(Qt::Key_E);
  key(Qt::Key_Return);
  EXPECT_EQ(document.cage_rest().face_count(), faces + 8);
  const PolygonMesh cage = document.cage();
  EXPECT_TRUE(is_mirrored(cage, find_partners(cage.positions, Vec3::Zero(), Vec3::UnitX(), 1e-12)));
}

TEST_F(ViewportWith, StandsModelsUpAlongZ) {
  view.set_up_axis(UpAxis::z);
  view.set_standard_view("front");
  EXPECT_TRUE(Vec3(view.camera().axes().row(1)).isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(Vec3(view.camera().axes().row(2)).isApprox(Vec3(-Vec3::UnitY())));
  const QJsonObject state = view.camera_state();
  view.set_up_axis(UpAxis::y);
  view.set_camera_state(state);
  EXPECT_EQ(view.up_axis(), UpAxis::z);
}

TEST_F(ViewportWith, DrawsALargeModelAsItIsOnceItRests) {
  Result<std::shared_ptr<const Model>> large = prepare_model(PolygonMesh(make_icosphere(7)), {});
  ASSERT_TRUE(large);
  EXPECT_GT((*large)->coarse.size(), 5000U);
  EXPECT_LT((*large)->coarse.size(), (*large)->triangles.size() / 3);
  document.set_model(*large);
  set_cage(test::quad_cube(3));
  Layers layers = document.layers();
  layers.wireframe = true;
  document.set_layers(layers);
  view.set_standard_view("front");
  view.frame_all();
  view.set_coarse_while_moving(false);
  view.finish_picture();
  const QImage with_all = view.grabFramebuffer();
  // Marks alone change, then are as before: the picture of the model is the kept one.
  key(Qt::Key_A);
  EXPECT_NE(view.grabFramebuffer(), with_all);
  key(Qt::Key_A, Qt::AltModifier);
  EXPECT_EQ(view.grabFramebuffer(), with_all);
  view.set_coarse_while_moving(true);
  view.set_standard_view("back");
  view.grabFramebuffer();
  view.set_standard_view("front");
  view.frame_all();
  EXPECT_NE(view.grabFramebuffer(), with_all);
  view.finish_picture();
  EXPECT_EQ(view.grabFramebuffer(), with_all);
}

TEST_F(ViewportWith, NeverDrawsAllOfALargeModelAtOnce) {
  Result<std::shared_ptr<const Model>> large = prepare_model(PolygonMesh(make_icosphere(7)), {});
  ASSERT_TRUE(large);
  const std::size_t all = (*large)->triangles.size();
  document.set_model(*large);
  settle();
  view.canvas()->take_most_at_once();
  EXPECT_FALSE(view.canvas()->shows_all());
  ASSERT_TRUE(test::wait_until([&] { return view.canvas()->shows_all(); }));
  EXPECT_LT(view.canvas()->take_most_at_once(), all / 2);
}

TEST_F(ViewportWith, TakesPicturesOfAnySizeWithoutTheGizmo) {
  QTest::mouseClick(&view, Qt::LeftButton, {}, at_vertex(front_vertex()));
  const QImage image = view.picture({800, 300});
  EXPECT_EQ(image.size(), QSize(800, 300));
  image.save(QString("%1/picture.png").arg(CAGEWRIGHT_SCREENSHOTS));
  EXPECT_EQ(view.camera().width(), 640) << "the view is as it was";
}

TEST_F(ViewportWith, SurvivesRandomActions) {
  Random random(17);
  const std::vector<int> keys = {Qt::Key_G, Qt::Key_R,      Qt::Key_S,      Qt::Key_X,
                                 Qt::Key_Y, Qt::Key_Return, Qt::Key_Escape, Qt::Key_A,
                                 Qt::Key_1, Qt::Key_2,      Qt::Key_3,      Qt::Key_B,
                                 Qt::Key_E, Qt::Key_F,      Qt::Key_L,      Qt::Key_O,
                                 Qt::Key_5, Qt::Key_Minus,  Qt::Key_Delete, Qt::Key_Tab};
  const auto place = [&] {
    return QPoint(static_cast<int>(random.below(640)), static_cast<int>(random.below(480)));
  };
  for (int i = 0; i < 250; ++i) {
    const auto modifiers = random.below(3) == 0   ? Qt::ShiftModifier
                           : random.below(4) == 0 ? Qt::ControlModifier
                                                  : Qt::NoModifier;
    switch (random.below(6)) {
    case 0:
    case 1:
      key(keys[random.below(keys.size())], modifiers);
      break;
    case 2:
      QTest::mouseClick(&view, random.below(4) == 0 ? Qt::RightButton : Qt::LeftButton, modifiers,
                        place());
      break;
    case 3:
      drag(place(), place(), modifiers, random.below(3) == 0 ? Qt::MiddleButton : Qt::LeftButton);
      break;
    case 4:
      QTest::mouseDClick(&view, Qt::LeftButton, modifiers, place());
      break;
    default:
      if (!editor.moving()) {
        random.below(2) == 0 ? editor.undo_stack().undo() : editor.undo_stack().redo();
      }
      break;
    }
    if (document.has_cage() && document.cage_rest().face_count() > 400) {
      while (!editor.moving() && editor.undo_stack().canUndo()) {
        editor.undo_stack().undo();
      }
    }
    ASSERT_TRUE(test::is_sound(document.cage_rest()));
    for (const Vec3& p : document.cage_positions()) {
      ASSERT_TRUE(p.allFinite());
    }
    if (i % 50 == 0) {
      settle();
    }
  }
  key(Qt::Key_Escape);
  EXPECT_FALSE(view.transforming());
}

} // namespace
} // namespace cagewright::app
