// What artists do with the model and its cage beyond the first day, by mouse and by keys.
#include "window_fixture.h"

#include "app/edit/hidden.h"
#include "app/panels/welcome_page.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QListWidget>
#include <QMenu>
#include <QSlider>
#include <QStandardPaths>
#include <QToolButton>
#include <QWheelEvent>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

namespace cagewright::app {
namespace {

class Craft : public Window {
protected:
  void click_at(QPoint place, Qt::KeyboardModifiers modifiers = {}) {
    QTest::mouseClick(&view(), Qt::LeftButton, modifiers, place);
    settle();
  }
  void click_vertex(Index v) { click_at(at(document().shown_cage_positions()[v])); }
  /// Chooses in the preferences, as a person would.
  void prefer(const char* box, const QString& data) {
    bool chosen = false;
    QTimer timer;
    QObject::connect(&timer, &QTimer::timeout, [&] {
      auto* dialog = qobject_cast<PreferencesDialog*>(QApplication::activeModalWidget());
      if (dialog == nullptr) {
        return;
      }
      auto* choice = dialog->findChild<QComboBox*>(box);
      const int at = choice->findData(data);
      choice->setCurrentIndex(at >= 0 ? at : choice->findText(data));
      chosen = true;
      dialog->accept();
    });
    timer.start(20);
    trigger("preferences");
    EXPECT_TRUE(chosen);
  }
  void wheel(int delta) {
    const QPointF place(300, 300);
    QWheelEvent event(place, view().mapToGlobal(place), {}, QPoint(0, delta), Qt::NoButton, {},
                      Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&view(), &event);
  }
  /// A pixel on the model, and off its cage's vertices: the middle of its front.
  /// \param beside  a pixel that is to be so far away
  QPoint on_model(QPoint beside = {-1000, -1000}, int away = 0) {
    const Vec3 backward = view().camera().axes().row(2);
    std::optional<Vec3> front;
    for (const Vec3& p : document().model_positions()) {
      if ((at(p) - beside).manhattanLength() >= away &&
          (!front || p.dot(backward) > front->dot(backward))) {
        front = p;
      }
    }
    return at(front.value_or(Vec3::Zero()));
  }
  std::size_t keys_of_time_line() { return document().state().time_line.keys.size(); }
};

TEST_F(Craft, HidesWhatIsInTheWayAndIsolates) {
  open_caged();
  const Index front = front_vertex();
  click_vertex(front);
  ASSERT_EQ(document().selection().vertices, std::vector<Index>{front});
  press_at_focus(Qt::Key_H);
  const std::size_t hidden = document().state().hidden_faces.size();
  EXPECT_GE(hidden, 3U);
  EXPECT_TRUE(document().selection().empty()) << "what is hidden is not selected";
  keep("hidden");
  click_vertex(front);
  EXPECT_NE(document().selection().vertices, std::vector<Index>{front}) << "it is out of reach";
  press_at_focus(Qt::Key_A);
  EXPECT_EQ(document().selection().vertices.size(), cage().size() - 1);
  press_at_focus(Qt::Key_H, Qt::AltModifier);
  EXPECT_TRUE(document().state().hidden_faces.empty());

  press_at_focus(Qt::Key_3);
  press_at_focus(Qt::Key_A, Qt::AltModifier);
  click_at(at(document().shown_cage_positions()[front]) + QPoint(25, 0));
  ASSERT_EQ(document().selection().faces.size(), 1U);
  press_at_focus(Qt::Key_Slash);
  EXPECT_EQ(document().state().hidden_faces.size(), document().cage_rest().face_count() - 1);
  press_at_focus(Qt::Key_A);
  EXPECT_EQ(document().selection().faces.size(), 1U);
  press_at_focus(Qt::Key_Slash);
  EXPECT_TRUE(document().state().hidden_faces.empty());
  // Steps of undo like others, and gone with the cage they are of.
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_FALSE(document().state().hidden_faces.empty());
  press_at_focus(Qt::Key_U, Qt::ControlModifier); // no command: nothing happens
  session().editor().replace_cage(document().state().rest, nullptr, "Again");
  EXPECT_TRUE(document().state().hidden_faces.empty());
}

TEST_F(Craft, HasTheKeysAndButtonsOfOtherPrograms) {
  open_caged();
  prefer("key_map", "maya");
  ASSERT_EQ(view().key_map(), KeyMap::maya);
  // Alt and a button.
  double before = view().camera().distance();
  drag({200, 300}, {200, 240}, Qt::AltModifier, Qt::RightButton);
  EXPECT_NE(view().camera().distance(), before);
  const double yaw = view().camera().view().yaw_degrees;
  drag({200, 300}, {280, 300}, Qt::AltModifier);
  EXPECT_NE(view().camera().view().yaw_degrees, yaw);
  const Vec3 target = view().camera().target();
  drag({200, 300}, {240, 300}, Qt::AltModifier, Qt::MiddleButton);
  EXPECT_GT((view().camera().target() - target).norm(), 1e-6);
  EXPECT_EQ(QApplication::activePopupWidget(), nullptr) << "a drag asks for no menu";
  // Letters.
  press_at_focus(Qt::Key_E);
  EXPECT_EQ(document().tools().tool, Tool::rotate);
  press_at_focus(Qt::Key_R);
  EXPECT_EQ(document().tools().tool, Tool::scale);
  press_at_focus(Qt::Key_Q);
  EXPECT_EQ(document().tools().tool, Tool::select_box);
  press_at_focus(Qt::Key_W);
  EXPECT_EQ(document().tools().tool, Tool::translate);
  EXPECT_FALSE(view().transforming());
  press_at_focus(Qt::Key_A);
  EXPECT_TRUE(document().selection().empty()) << "A frames, it does not select";
  press_at_focus(Qt::Key_F11);
  EXPECT_EQ(document().selection().mode, SelectionMode::face);
  press_at_focus(Qt::Key_A, Qt::ControlModifier);
  EXPECT_EQ(document().selection().faces.size(), document().cage_rest().face_count());
  press_at_focus(Qt::Key_A, Qt::AltModifier);
  press_at_focus(Qt::Key_S);
  EXPECT_FALSE(view().transforming()) << "S is no scaling here";
  bind();
  press_at_focus(Qt::Key_S);
  EXPECT_EQ(keys_of_time_line(), 1U);

  prefer("key_map", "three_button");
  document().set_tools({});
  settle();
  const double turned = view().camera().view().yaw_degrees;
  drag({12, 200}, {90, 200}); // beside the cage
  EXPECT_NE(view().camera().view().yaw_degrees, turned);
  before = view().camera().distance();
  drag({200, 300}, {200, 240}, {}, Qt::RightButton);
  EXPECT_NE(view().camera().distance(), before);
  EXPECT_EQ(QApplication::activePopupWidget(), nullptr);
  press_at_focus(Qt::Key_1);
  press_at_focus(Qt::Key_B);
  drag({2, 70}, {view().width() - 3, view().height() - 3});
  EXPECT_FALSE(document().selection().empty()) << "B selects by a box";

  prefer("key_map", "blender");
  before = view().camera().distance();
  wheel(120);
  EXPECT_LT(view().camera().distance(), before);
  prefer("wheel", "Forward: farther");
  before = view().camera().distance();
  wheel(120);
  EXPECT_GT(view().camera().distance(), before);
  press_at_focus(Qt::Key_3);
  press_at_focus(Qt::Key_E);
  EXPECT_EQ(document().tools().tool, Tool::translate) << "E is no tool here";
}

TEST_F(Craft, GivesNoKeyToTwoCommandsInAnyKeyMap) {
  for (const char* map : {"maya", "three_button", "blender"}) {
    prefer("key_map", map);
    std::map<QString, QString> taken;
    for (QAction* action : window->findChildren<QAction*>()) {
      for (const QKeySequence& keys : action->shortcuts()) {
        const auto [place, is_new] = taken.try_emplace(keys.toString(), action->objectName());
        EXPECT_TRUE(is_new) << map << ": " << keys.toString().toStdString() << " is that of "
                            << place->second.toStdString() << " and of "
                            << action->objectName().toStdString();
      }
    }
    EXPECT_GT(taken.size(), 40U);
  }
}

TEST_F(Craft, OffersSamplesAndWhatWasOpenedLast) {
  QStandardPaths::setTestModeEnabled(true);
  auto* welcome = find<WelcomePage>("welcome");
  ASSERT_TRUE(welcome->isVisible());
  EXPECT_EQ(welcome->findChild<QToolButton*>("recent"), nullptr);
  keep("welcome");
  click("sample_bound");
  ASSERT_TRUE(wait_until([this] { return document().mode() == Mode::deform; }));
  EXPECT_FALSE(welcome->isVisible());
  ASSERT_TRUE(wait_until([this] { return !session().checker().busy(); }));
  EXPECT_TRUE(document().check().report->valid()) << "the cage that comes with it";
  window->close();
  window.reset();
  make_window();
  welcome = find<WelcomePage>("welcome");
  ASSERT_NE(welcome->findChild<QToolButton*>("recent"), nullptr);
  keep("welcome-recent");
  click("recent");
  ASSERT_TRUE(wait_until([this] { return document().has_model(); }));
  EXPECT_EQ(document().model()->path.filename(), "creature.obj");
}

TEST_F(Craft, FoldsTheTimeLineUntilThereIsSomethingOnIt) {
  auto* line = find<QDockWidget>("dock_time_line");
  EXPECT_TRUE(line->isHidden());
  open_caged();
  bind();
  EXPECT_TRUE(line->isHidden());
  press_at_focus(Qt::Key_K);
  EXPECT_TRUE(line->isVisible());
  EXPECT_EQ(keys_of_time_line(), 1U);
  line->close();
  press_at_focus(Qt::Key_K, Qt::ControlModifier);
  EXPECT_TRUE(line->isHidden()) << "what the user closes stays closed";
  trigger("reset_panels");
  EXPECT_TRUE(line->isVisible());
}

TEST_F(Craft, MixesPosesAndKeysTheMix) {
  open_caged();
  bind();
  const std::vector<Vec3> rest = cage();
  const Index a = front_vertex();
  const auto make_pose = [&](const Vec3& by) {
    session().editor().reset_pose();
    session().editor().move({a}, std::vector<Vec3>{rest[a] + by}, "Move");
    press_at_focus(Qt::Key_K, Qt::ControlModifier);
  };
  make_pose({0.4, 0, 0});
  make_pose({0, 0.2, 0});
  ASSERT_EQ(document().state().poses.size(), 2U);
  click("reset_pose");
  find<QDockWidget>("dock_poses")->raise();
  settle();
  const auto is_at = [&](const Vec3& by) { return (cage()[a] - rest[a] - by).norm() < 1e-9; };
  QUndoStack& stack = session().editor().undo_stack();
  const int steps = stack.count();
  auto* first = find<QSlider>("share_0");
  // A drag of the handle is one step.
  QTest::mousePress(first, Qt::LeftButton, {}, QPoint(3, first->height() / 2));
  test::move_mouse(*first, QPoint(first->width() / 3, first->height() / 2), Qt::LeftButton);
  test::move_mouse(*first, QPoint(first->width() / 2, first->height() / 2), Qt::LeftButton);
  QTest::mouseRelease(first, Qt::LeftButton, {}, QPoint(first->width() / 2, first->height() / 2));
  const double share = document().state().poses[0].share;
  EXPECT_GT(share, 0.2);
  EXPECT_LT(share, 0.8);
  EXPECT_TRUE(is_at({0.4 * share, 0, 0}));
  EXPECT_EQ(stack.count(), steps + 1);
  find<QDoubleSpinBox>("share_number_1")->setValue(-0.5); // numbers go farther
  EXPECT_TRUE(is_at({0.4 * share, -0.1, 0}));
  keep("mixer");
  show_time_line();
  find<QSpinBox>("frame")->setValue(1);
  document().set_time(std::nullopt);
  press_at_focus(Qt::Key_K);
  find<QDoubleSpinBox>("share_number_0")->setValue(1);
  find<QDoubleSpinBox>("share_number_1")->setValue(1);
  EXPECT_TRUE(is_at({0.4, 0.2, 0}));
  session().editor().set_keyframe(21);
  ASSERT_EQ(keys_of_time_line(), 2U);
  find<QSpinBox>("frame")->setValue(11); // half way, by symmetry of the curve
  EXPECT_NEAR(find<QDoubleSpinBox>("share_number_1")->value(), 0.25, 0.011);
  EXPECT_NEAR(document().shown_pose_shares()[0], (share + 1) / 2, 1e-9);
  // A mix goes on from what is seen there.
  find<QDoubleSpinBox>("share_number_1")->setValue(0);
  EXPECT_TRUE(is_at({0.4 * (share + 1) / 2, 0, 0}));
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_NEAR(find<QDoubleSpinBox>("share_number_1")->value(), 0.25, 0.011)
      << "and comes back to it";
}

TEST_F(Craft, DragsTheModelAndTheCageComesAlong) {
  open_caged();
  take_tool(Tool::pull);
  click_at(on_model());
  EXPECT_TRUE(document().state().pins.empty()) << "not before it is bound";
  bind();
  const std::vector<Vec3> rest = cage();
  const QPoint place = on_model();
  drag(place, place + QPoint(60, -30));
  settle();
  ASSERT_EQ(document().state().pins.size(), 1U);
  const QPoint now = at(document().place_of(document().state().pins[0]));
  EXPECT_LE((now - place - QPoint(60, -30)).manhattanLength(), 2) << "it is under the pointer";
  EXPECT_GT(greatest_distance(cage(), rest), 1e-3);
  const std::vector<Vec3> pulled = cage();
  // Another one that only holds.
  click_at(on_model(now, 90));
  ASSERT_EQ(document().state().pins.size(), 2U);
  EXPECT_EQ(cage(), pulled);
  keep("pins");
  const Vec3 held = document().place_of(document().state().pins[1]);
  drag(now, now + QPoint(0, 50));
  EXPECT_LT((document().place_of(document().state().pins[1]) - held).norm(), 1e-9) << "it holds";
  EXPECT_NE(cage(), pulled);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(cage(), pulled) << "one step";
  // Escape takes a drag back.
  QTest::mousePress(&view(), Qt::LeftButton, {}, now);
  test::move_mouse(view(), now + QPoint(30, 30), Qt::LeftButton);
  EXPECT_NE(cage(), pulled);
  QTest::keyClick(&view(), Qt::Key_Escape);
  EXPECT_EQ(cage(), pulled);
  QTest::mouseRelease(&view(), Qt::LeftButton, {}, now + QPoint(30, 30));
  EXPECT_EQ(cage(), pulled);
  // Ctrl+click takes a pin away, the menu all of them.
  click_at(now, Qt::ControlModifier);
  EXPECT_EQ(document().state().pins.size(), 1U);
  trigger("remove_pins");
  EXPECT_TRUE(document().state().pins.empty());
  session().refine();
  EXPECT_EQ(document().mode(), Mode::refine);
}

TEST_F(Craft, PaintsWhereTheNextCageIsFiner) {
  open_model();
  take_tool(Tool::paint);
  ToolSettings tools = document().tools();
  tools.brush_radius = 90;
  tools.brush_strength = 1;
  document().set_tools(tools);
  const QPoint place = on_model();
  drag(place, place + QPoint(40, 0));
  settle();
  ASSERT_TRUE(document().state().density);
  const std::vector<float> painted = *document().state().density;
  EXPECT_GT(*std::ranges::max_element(painted), 0.5F);
  EXPECT_EQ(*std::ranges::min_element(painted), 0.0F);
  EXPECT_LT(std::ranges::count_if(painted, [](float d) { return d > 0; }),
            static_cast<std::ptrdiff_t>(painted.size() / 2));
  EXPECT_EQ(session().settings().density, DensitySource::painted);
  keep("painted");
  drag(place + QPoint(0, 60), place + QPoint(20, 60), Qt::ControlModifier);
  EXPECT_LT(*std::ranges::min_element(*document().state().density), -0.2F);
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(*document().state().density, painted) << "a stroke is one step";
  drag(place, place + QPoint(40, 0), Qt::ShiftModifier);
  EXPECT_LT(*std::ranges::max_element(*document().state().density),
            *std::ranges::max_element(painted));
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  const double radius = document().tools().brush_radius;
  QWheelEvent event(QPointF(300, 300), view().mapToGlobal(QPointF(300, 300)), {}, QPoint(0, 120),
                    Qt::NoButton, Qt::ControlModifier, Qt::NoScrollPhase, false);
  QCoreApplication::sendEvent(&view(), &event);
  EXPECT_GT(document().tools().brush_radius, radius);

  // More of the cage's vertices lie where it was painted.
  const auto share_near = [&] {
    std::size_t near = 0;
    for (const Vec3& c : cage()) {
      std::size_t nearest = 0;
      for (std::size_t v = 0; v < painted.size(); ++v) {
        const auto& p = document().model()->mesh.positions;
        if ((p[v] - c).norm() < (p[nearest] - c).norm()) {
          nearest = v;
        }
      }
      near += painted[nearest] > 0.3F ? 1 : 0;
    }
    return static_cast<double>(near) / static_cast<double>(cage().size());
  };
  generate();
  const double finer = share_near();
  trigger("clear_density");
  EXPECT_EQ(session().settings().density, DensitySource::even);
  generate();
  EXPECT_GT(finer, share_near());
}

TEST_F(Craft, DrawsRoundWhatTheCageIsFor) {
  open_model();
  take_tool(Tool::region);
  const auto region = [this] { return document().state().region; };
  const auto lasso = [this](std::vector<QPoint> corners, Qt::KeyboardModifiers modifiers) {
    test::move_mouse(view(), corners[0]);
    QTest::mousePress(&view(), Qt::LeftButton, modifiers, corners[0]);
    for (const QPoint& corner : corners) {
      test::move_mouse(view(), corner, Qt::LeftButton, modifiers);
    }
    QTest::mouseRelease(&view(), Qt::LeftButton, modifiers, corners.back());
    wait_for_job();
  };
  const QPoint middle(view().width() / 2, view().height() / 2);
  const std::vector<QPoint> right = {{middle.x(), 4},
                                     {view().width() - 4, 4},
                                     {view().width() - 4, view().height() - 4},
                                     {middle.x(), view().height() - 4}};
  lasso(right, Qt::ControlModifier);
  ASSERT_TRUE(region());
  const std::vector<Index> seen = region()->faces;
  const PolygonMesh& mesh = document().model()->mesh;
  EXPECT_GT(seen.size(), mesh.face_count() / 10);
  EXPECT_LT(seen.size(), mesh.face_count() / 2) << "neither the left, nor the back";
  for (const Index f : seen) {
    EXPECT_GT(at(mesh.positions[mesh.face(f)[0]]).x(), middle.x() - 40);
  }
  keep("region-lasso");
  // The back as well, by a box; it adds.
  trigger("see_through");
  press_at_focus(Qt::Key_B);
  drag(right[0], right[2]);
  wait_for_job();
  const std::vector<Index> through = region()->faces;
  EXPECT_GT(through.size(), seen.size() * 3 / 2);
  EXPECT_TRUE(std::ranges::includes(through, seen));
  // Shift takes away, and one that is begun is given up by Esc.
  lasso({right[0], right[1], {right[1].x(), middle.y()}, {middle.x(), middle.y()}},
        Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_LT(region()->faces.size(), through.size());
  press_at_focus(Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(region()->faces, through) << "each is a step";
  QTest::mousePress(&view(), Qt::LeftButton, Qt::ControlModifier, right[0]);
  test::move_mouse(view(), right[2], Qt::LeftButton, Qt::ControlModifier);
  press_at_focus(Qt::Key_Escape);
  QTest::mouseRelease(&view(), Qt::LeftButton, {}, right[2]);
  wait_for_job();
  EXPECT_EQ(region()->faces, through);
  lasso({{2, 2}, {12, 2}, {12, 12}}, Qt::ControlModifier);
  EXPECT_EQ(region()->faces, through) << "there is nothing";
  trigger("see_through");
}

TEST_F(Craft, SaysWhatTheCageIsForInTheRoomThereIs) {
  PolygonMesh named = model();
  named.group_names = {"the left half of a torus that has quite a long name", "right"};
  for (Index f = 0; f < named.face_count(); ++f) {
    named.face_groups.push_back(f < named.face_count() / 2 ? 0 : 1);
  }
  ASSERT_TRUE(write_mesh(named, path("named.obj").toStdString()));
  session().open(path("named.obj").toStdString());
  wait_for_job();
  auto* button = find<QToolButton>("region");
  EXPECT_EQ(button->text(), "the whole model") << "as wide as the panel is at first";
  const std::vector<NamedPart> parts = named_parts(*document().model());
  session().choose_region(parts[0].name, parts[0].faces);
  wait_for_job();
  constexpr int arrow = 14;
  const auto fits = [&] {
    return button->fontMetrics().horizontalAdvance(button->text()) + arrow < button->width();
  };
  EXPECT_TRUE(fits()) << button->text().toStdString();
  EXPECT_TRUE(button->text().endsWith(QChar(0x2026)));
  window->resizeDocks({find<QDockWidget>("dock_generate")}, {420}, Qt::Horizontal);
  settle();
  const QString wide = button->text();
  EXPECT_TRUE(fits());
  window->resizeDocks({find<QDockWidget>("dock_generate")}, {220}, Qt::Horizontal);
  settle();
  EXPECT_TRUE(fits());
  EXPECT_LT(button->text().size(), wide.size());
  keep("region-button");
}

/// How far apart two pictures of a window are, in levels of 0 to 255, in the mean.
double mean_difference(const QImage& a, const QImage& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const QRgb p = a.pixel(x, y);
      const QRgb q = b.pixel(x, y);
      sum += std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) +
             std::abs(qBlue(p) - qBlue(q));
    }
  }
  return sum / 3 / a.width() / a.height();
}

TEST_F(Craft, ShowsAtRestWhatItShowedBefore) {
  open_caged();
  Layers layers = document().layers();
  layers.occlusion = false;
  document().set_layers(layers);
  settle();
  const QImage first = window->grab().toImage();
  view().finish_picture();
  settle();
  EXPECT_LT(mean_difference(first, window->grab().toImage()), 2) << "with smooth outlines";
  layers.occlusion = true;
  document().set_layers(layers);
  settle();
  view().finish_picture();
  EXPECT_LT(mean_difference(first, window->grab().toImage()), 8) << "and with shade in corners";
}

/// The mean color of the picture where the model is seen.
std::array<double, 3> color_round(const QImage& picture, QPoint place) {
  std::array<double, 3> sum = {0, 0, 0};
  for (int y = -3; y <= 3; ++y) {
    for (int x = -3; x <= 3; ++x) {
      const QColor c = picture.pixelColor(place + QPoint(x, y));
      sum[0] += c.redF() / 49;
      sum[1] += c.greenF() / 49;
      sum[2] += c.blueF() / 49;
    }
  }
  return sum;
}

TEST_F(Craft, ShowsMaterialsAndTexturesOfTheModel) {
  // A wall of three: a texture that is red above and blue below, a green material, none.
  std::ofstream(path("wall.obj").toStdString())
      << "mtllib wall.mtl\n"
         "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 2 0\nv 1 2 0\nv 2 2 0\nv 3 2 0\n"
         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
         "usemtl painted\nf 1/1 2/2 6/3 5/4\nusemtl green\nf 2 3 7 6\nusemtl none\nf 3 4 8 7\n";
  std::ofstream(path("wall.mtl").toStdString())
      << "newmtl painted\nKd 1 1 1\nmap_Kd -s 1 1 1 two colors.png\nnewmtl green\nKd 0 1 0\n";
  QImage texture(8, 8, QImage::Format_RGB32);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      texture.setPixelColor(x, y, y < 4 ? Qt::red : Qt::blue);
    }
  }
  ASSERT_TRUE(texture.save(path("two colors.png")));
  session().open(path("wall.obj").toStdString());
  wait_for_job();
  view().set_standard_view("front");
  view().frame_all();
  const auto color = [this](const Vec3& place) {
    settle();
    view().finish_picture();
    const double ratio = view().devicePixelRatioF();
    return color_round(view().grabFramebuffer(), at(place) * ratio);
  };
  const std::array<double, 3> plain = color({0.5, 1.5, 0});
  EXPECT_LT(std::abs(plain[0] - plain[2]), 0.2);
  auto* look = find<QComboBox>("look");
  look->setCurrentIndex(look->findText("Its own colors"));
  const std::array<double, 3> red = color({0.5, 1.5, 0});
  EXPECT_GT(red[0], red[2] + 0.4);
  const std::array<double, 3> blue = color({0.5, 0.5, 0});
  EXPECT_GT(blue[2], blue[0] + 0.4);
  const std::array<double, 3> green = color({1.5, 1, 0});
  EXPECT_GT(green[1], green[0] + 0.4);
  const std::array<double, 3> white = color({2.5, 1, 0});
  EXPECT_LT(std::abs(white[0] - white[2]), 0.2);
  EXPECT_GT(white[1], 0.5);
  keep("materials");
  look->setCurrentIndex(0);
  EXPECT_LT(std::abs(color({0.5, 1.5, 0})[0] - plain[0]), 0.05) << "as before";
}

TEST_F(Craft, LooksLikeWhatIsChosenAndGetsFinerAtRest) {
  open_caged();
  const auto settled = [this] { // as fine as it gets
    settle();
    view().finish_picture();
    return view().grabFramebuffer();
  };
  std::map<int, QImage> pictures;
  auto* look = find<QComboBox>("look");
  const int own = static_cast<int>(SurfaceLook::own);
  for (int i = 0; i < own; ++i) {
    look->setCurrentIndex(i);
    pictures[i] = settled();
    window->grab().save(QString("%1/window-look-%2.png").arg(CAGEWRIGHT_SCREENSHOTS).arg(i));
    for (int j = 0; j < i; ++j) {
      EXPECT_NE(pictures[j], pictures[i]) << i << " and " << j << " look alike";
    }
  }
  look->setCurrentIndex(own);
  EXPECT_EQ(settled(), pictures[0]) << "it has no colors of its own";
  look->setCurrentIndex(0);
  EXPECT_EQ(settled(), pictures[0]) << "the same again";
  find<QCheckBox>("occlusion")->setChecked(false);
  EXPECT_NE(settled(), pictures[0]) << "without the shade in corners";
}

} // namespace
} // namespace cagewright::app
