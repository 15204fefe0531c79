// The menus of the main window: what there is to do, and by which keys.
#include "app/main_window.h"

#include "app/icons.h"
#include "app/panels/command_search.h"
#include "app/panels/guide_bar.h"
#include "app/panels/layers_panel.h"
#include "app/panels/poses_panel.h"
#include "app/panels/time_line_panel.h"
#include "app/panels/tool_bar.h"
#include "app/view/viewport.h"
#include <cagewright/version.h>

#include <QActionGroup>
#include <QApplication>
#include <QDialog>
#include <QDockWidget>
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QMenuBar>
#include <QMessageBox>
#include <QRegularExpression>
#include <QSettings>
#include <QStatusBar>
#include <QTextBrowser>
#include <QVBoxLayout>

#include <utility>

namespace cagewright::app {

QAction* MainWindow::add(QMenu* menu, const char* name, const QString& text,
                         const QKeySequence& keys, const QString& tip,
                         const std::function<void()>& act) {
  auto* action = new QAction(text, this);
  action->setObjectName(name);
  action->setShortcut(keys);
  action->setStatusTip(tip);
  action->setToolTip(tip);
  connect(action, &QAction::triggered, this, act);
  menu->addAction(action);
  return action;
}

QAction* MainWindow::add_in_view(QMenu* menu, const char* name, const QString& text,
                                 const QKeySequence& keys, const QString& tip,
                                 const std::function<void()>& act) {
  QAction* action = add(menu, name, text, keys, tip, act);
  action->setShortcutContext(Qt::WidgetShortcut);
  viewport_->addAction(action);
  return action;
}

void MainWindow::make_menus() {
  make_file_menu();
  make_edit_menu();
  make_view_menu();
  make_cage_menu();
  make_pose_menu();
  make_help_menu();
  for (const auto& [command, picture] :
       {std::pair("open", "open"), std::pair("save", "save"), std::pair("undo", "undo"),
        std::pair("redo", "redo"), std::pair("generate_cage", "generate"),
        std::pair("bind_model", "bind"), std::pair("export_model", "export"),
        std::pair("keyframe", "keyframe"), std::pair("play_pause", "play")}) {
    if (QAction* action = findChild<QAction*>(command)) {
      action->setIcon(icon(picture));
    }
  }
  QAction* first_tool = tools_->actions().first();
  for (const char* command : {"open", "save", "undo", "redo"}) {
    tools_->insertAction(first_tool, findChild<QAction*>(command));
  }
  tools_->insertSeparator(first_tool);
  auto* modes = new QActionGroup(this);
  for (const CageAction mode :
       {CageAction::vertex_mode, CageAction::edge_mode, CageAction::face_mode}) {
    auto* action = findChild<QAction*>(command_name(mode));
    action->setIcon(icon(command_name(mode)));
    action->setCheckable(true);
    modes->addAction(action);
    tools_->insertAction(first_tool, action);
  }
  tools_->insertSeparator(first_tool);
}

void MainWindow::apply_key_map(KeyMap map) {
  if (usual_keys_.empty()) {
    for (QAction* tool : tools_->actions()) {
      if (tool->objectName().startsWith("tool_")) { // letters, in the view only
        tool->setShortcutContext(Qt::WidgetShortcut);
        viewport_->addAction(tool);
      }
    }
    for (const QAction* action : findChildren<QAction*>()) {
      if (!action->objectName().isEmpty()) {
        usual_keys_[action->objectName()] = action->shortcuts();
      }
    }
  }
  viewport_->set_key_map(map);
  // None is taken from one command before it is another's.
  for (const bool give : {false, true}) {
    for (QAction* action : findChildren<QAction*>()) {
      const auto usual = usual_keys_.find(action->objectName());
      if (usual == usual_keys_.end()) {
        continue;
      }
      const QList<QKeySequence> keys = keys_of(map, usual->first, usual->second);
      if (keys != action->shortcuts()) {
        action->setShortcuts(give ? keys : QList<QKeySequence>());
      }
    }
  }
}

QString MainWindow::model_filter(bool all) const {
  return all ? tr("Models and projects (*.obj *.ply *.stl *.off *.glb *.gltf *.cagewright);;"
                  "All files (*)")
             : tr("Models (*.obj *.ply *.stl *.off *.glb *.gltf);;All files (*)");
}

QString MainWindow::suggested(const QString& suffix, const QString& extension) const {
  const Document& document = const_cast<MainWindow*>(this)->session_.document();
  if (!document.has_model()) {
    return "untitled" + suffix + extension;
  }
  const QFileInfo model(QString::fromStdString(document.model()->path.string()));
  return model.path() + "/" + model.completeBaseName() + suffix +
         (extension.isEmpty() ? "." + model.suffix() : extension);
}

void MainWindow::make_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  add(menu, "open", tr("&Open..."), QKeySequence::Open, tr("Opens a model or a project"),
      [this] { choose_model(); });
  QAction* load = add(menu, "load_cage", tr("&Load Cage..."), {"Ctrl+Shift+O"},
                      tr("Takes a cage from a file"), [this] { choose_cage(); });
  QAction* more_models =
      add(menu, "add_model", tr("Add &Model..."), {},
          tr("Another model under the same cage: clothes, eyes. Each is exported to its own file"),
          [this] {
            const QString path = ask_for_model(tr("Add a Model"));
            if (!path.isEmpty()) {
              session_.add_model(path.toStdString());
            }
          });
  recent_ = menu->addMenu(tr("Open &Recent"));
  connect(recent_, &QMenu::aboutToShow, this, &MainWindow::show_recent);
  menu->addSeparator();
  QAction* save_action = add(menu, "save", tr("&Save Project"), QKeySequence::Save,
                             tr("Saves cage, poses, options and view"), [this] { save(); });
  QAction* save_as_action = add(menu, "save_as", tr("Save Project &As..."), QKeySequence::SaveAs,
                                tr("Saves the project under another name"), [this] { save_as(); });
  menu->addSeparator();
  const auto has_model = [this] {
    return session_.document().has_model() && !session_.jobs().busy();
  };
  const auto has_cage = [this] { return session_.document().has_cage(); };
  const auto deforming = [this] {
    return session_.document().mode() == Mode::deform && !session_.jobs().busy();
  };
  QAction* model = add(menu, "export_model", tr("&Export Model..."), {"Ctrl+E"},
                       tr("Writes the model as it is shown; a file of the same format keeps "
                          "texture coordinates, groups and materials"),
                       [this] { export_model(); });
  QMenu* more = menu->addMenu(tr("E&xport More"));
  QAction* poses =
      add(more, "export_poses", tr("All &Poses..."), {}, tr("A file for each pose, named after it"),
          [this] {
            choose_export(tr("Export Poses"), suggested("-deformed", {}), export_filter(),
                          [this](const auto& path) { session_.export_poses(path); });
          });
  QAction* sequence =
      add(more, "export_sequence", tr("&Sequence..."), {},
          tr("A file for each frame of the time line"), [this] {
            choose_export(tr("Export Sequence"), suggested("-sequence", {}), export_filter(),
                          [this](const auto& path) {
                            bool ok = true;
                            const int step = QInputDialog::getInt(this, tr("Export Sequence"),
                                                                  tr("Write every so many frames"),
                                                                  1, 1, 1000, 1, &ok);
                            if (ok) {
                              session_.export_sequence(path, step);
                            }
                          });
          });
  QAction* animation =
      add(more, "export_animation", tr("&Animation..."), {},
          tr("The time line as one file: GLB with morph targets, or a point cache"), [this] {
            choose_export(tr("Export Animation"), suggested("-animated", ".glb"),
                          tr("Animated glTF (*.glb);;Point cache (*.pc2);;LightWave cache (*.mdd)"),
                          [this](const auto& path) { session_.export_animation(path); });
          });
  QAction* cage =
      add(more, "export_cage", tr("&Cage..."), {}, tr("The cage as it is shown"), [this] {
        choose_export(tr("Save Cage"), suggested("-cage", ".obj"),
                      tr("Meshes (*.obj *.ply *.stl *.off)"),
                      [this](const auto& path) { session_.save_cage(path); });
      });
  QAction* weights =
      add(more, "export_weights", tr("&Weights..."), {},
          tr("How much each vertex of the model follows each of the cage, for NumPy"), [this] {
            choose_export(tr("Export Weights"), suggested("-weights", ".npz"),
                          tr("NumPy archives (*.npz)"),
                          [this](const auto& path) { session_.export_weights(path); });
          });
  QAction* mix = add(
      more, "export_mix", tr("Mi&x Weights..."), {},
      tr("What is painted for another kind of coordinates: for cagewright bind --mix-weights"),
      [this] {
        choose_export(tr("Export Mix Weights"), suggested("-mix", ".txt"), tr("Numbers (*.txt)"),
                      [this](const auto& path) { session_.export_mix(path); });
      });
  needs_.push_back({mix, [this] { return session_.document().state().mix != nullptr; }});
  add(more, "export_image", tr("&Image of the View..."), {}, tr("A picture of what is shown"),
      [this] { export_image(); });
  menu->addSeparator();
  add(menu, "preferences", tr("&Preferences..."), {"Ctrl+,"}, tr("Colors, autosave, hints"),
      [this] {
        PreferencesDialog dialog(preferences_, this);
        if (dialog.exec() == QDialog::Accepted) {
          apply(dialog.preferences());
          preferences_.save();
        }
      });
  add(menu, "quit", tr("&Quit"), QKeySequence::Quit, tr("Ends the program"), [this] { close(); });
  needs_.push_back({load, has_model});
  needs_.push_back({more_models, has_model});
  needs_.push_back({save_action, [this] { return session_.document().has_model(); }});
  needs_.push_back({save_as_action, [this] { return session_.document().has_model(); }});
  needs_.push_back({model, deforming});
  needs_.push_back({poses, [this, deforming] {
                      return deforming() && !session_.document().state().poses.empty();
                    }});
  needs_.push_back({animation, [this, deforming] {
                      return deforming() && !session_.document().state().time_line.keys.empty();
                    }});
  needs_.push_back({sequence, [this, deforming] {
                      return deforming() && !session_.document().state().time_line.keys.empty();
                    }});
  needs_.push_back({cage, has_cage});
  needs_.push_back({weights, [has_model, has_cage] { return has_model() && has_cage(); }});
}

void MainWindow::make_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QUndoStack& stack = session_.editor().undo_stack();
  QAction* undo = stack.createUndoAction(this);
  undo->setObjectName("undo");
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = stack.createRedoAction(this);
  redo->setObjectName("redo");
  redo->setShortcuts({QKeySequence(QKeySequence::Redo), QKeySequence("Ctrl+Y")});
  menu->addAction(undo);
  menu->addAction(redo);
  make_select_menu(menu->addMenu(tr("&Select")));
  menu->addSeparator();
  tools_->add_to(menu);
}

void MainWindow::add_action(QMenu* menu, CageAction action, const QString& text,
                            const QKeySequence& keys, const QString& tip) {
  QAction* made = add_in_view(menu, command_name(action), text, keys, tip, [this, action] {
    if (action == CageAction::extrude) {
      viewport_->extrude(); // and goes on with moving
    } else {
      perform(action, session_.editor());
    }
  });
  needs_.push_back({made, [this, action] {
                      const Document& document = session_.document();
                      return document.has_cage() &&
                             (!changes_topology(action) || document.mode() == Mode::refine);
                    }});
}

void MainWindow::make_select_menu(QMenu* menu) {
  using enum CageAction;
  add_action(menu, select_all, tr("&All"), {"A"}, tr("Selects everything of the cage"));
  add_action(menu, select_none, tr("&None"), {"Alt+A"}, tr("Selects nothing"));
  add_action(menu, invert, tr("&Invert"), {"Ctrl+I"}, tr("Selects what is not selected"));
  add_action(menu, grow, tr("&Grow"), {"Ctrl++"}, tr("Adds the neighbors"));
  add_action(menu, shrink, tr("&Shrink"), {"Ctrl+-"}, tr("Takes the rim away"));
  add_action(menu, select_linked, tr("&Linked"), {"Ctrl+L"},
             tr("Adds all that hangs together with the selection"));
  add_action(menu, select_loop, tr("L&oop"), {}, tr("The edges that go straight on"));
  add_action(menu, select_ring, tr("&Ring"), {}, tr("The edges opposite to each other"));
  add_action(menu, mirror_selection, tr("&Mirror"), {}, tr("Adds the mirror images"));
  menu->addSeparator();
  add_action(menu, vertex_mode, tr("&Vertices"), {"1"}, tr("Vertices are selected from now on"));
  add_action(menu, edge_mode, tr("&Edges"), {"2"}, tr("Edges are selected from now on"));
  add_action(menu, face_mode, tr("&Faces"), {"3"}, tr("Faces are selected from now on"));
}

void MainWindow::make_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  add_in_view(menu, "frame_all", tr("Frame &All"), {"Home"}, tr("Brings everything into view"),
              [this] { viewport_->frame_all(); });
  add_in_view(menu, "frame_selection", tr("&Frame Selection"), {"F"},
              tr("Brings the selection into view"), [this] { viewport_->frame_selection(); });
  QAction* orthographic =
      add_in_view(menu, "orthographic", tr("&Orthographic"), {"5"},
                  tr("Without perspective: parallel lines stay parallel"),
                  [this] { viewport_->set_orthographic(!viewport_->orthographic()); });
  orthographic->setCheckable(true);
  connect(viewport_, &Viewport::cameraChanged, orthographic,
          [this, orthographic] { orthographic->setChecked(viewport_->orthographic()); });
  QAction* z_up =
      add(menu, "z_up", tr("&Z Is Up"), {},
          tr("Which way the model stands: Z is up in CAD and Blender, Y elsewhere. Files "
             "are written as they were read"),
          [this] {
            const bool on = viewport_->up_axis() != UpAxis::z;
            viewport_->set_up_axis(on ? UpAxis::z : UpAxis::y);
            preferences_.z_up = on;
            preferences_.save();
          });
  z_up->setCheckable(true);
  connect(viewport_, &Viewport::cameraChanged, z_up,
          [this, z_up] { z_up->setChecked(viewport_->up_axis() == UpAxis::z); });
  QAction* coarse =
      add(menu, "coarse_while_moving", tr("&Coarse While Moving"), {},
          tr("Large models are drawn with fewer triangles while they or the view move, if this "
             "computer is slow to draw them"),
          [this] {
            preferences_.coarse_while_moving = !viewport_->coarse_while_moving();
            viewport_->set_coarse_while_moving(preferences_.coarse_while_moving);
            preferences_.save();
          });
  coarse->setCheckable(true);
  connect(menu, &QMenu::aboutToShow, coarse,
          [this, coarse] { coarse->setChecked(viewport_->coarse_while_moving()); });
  QMenu* standard = menu->addMenu(tr("&Standard Views"));
  const std::pair<QString, const char*> names[] = {{tr("Front"), "front"},
                                                   {tr("Back"), "back"},
                                                   {tr("Left"), "left"},
                                                   {tr("Right"), "right"},
                                                   {tr("Top"), "top"},
                                                   {tr("Bottom"), "bottom"},
                                                   {tr("Three-Quarter"), "three-quarter"}};
  int number = 0;
  for (const auto& [text, name] : names) {
    add(standard, name, text, QKeySequence(QString("Alt+%1").arg(++number)), tr("Looks from there"),
        [this, key = QString(name)] { viewport_->set_standard_view(key); });
  }
  add_in_view(menu, "cycle_shading", tr("Next S&hading"), {"Z"},
              tr("Smooth, with the model's edges, flat"), [this] { cycle_shading(); });
  add(menu, "full_view", tr("F&ull View"), {"Ctrl+Space"}, tr("The view alone, and back"),
      [this] { toggle_full_view(); });
  menu->addSeparator();
  using enum CageAction;
  add_action(menu, hide, tr("&Hide Selection"), {"H"},
             tr("Puts the selected part of the cage out of sight and out of reach"));
  add_action(menu, isolate, tr("&Isolate"), {"/"},
             tr("Shows nothing of the cage but the selection; again: everything"));
  add_action(menu, reveal, tr("Sho&w All"), {"Alt+H"}, tr("Brings back what is hidden"));
  menu->addSeparator();
  layers_->add_to(menu->addMenu(tr("&Layers")));
  panels_menu_ = menu->addMenu(tr("&Panels"));
  for (QDockWidget* dock : findChildren<QDockWidget*>()) {
    panels_menu_->addAction(dock->toggleViewAction());
  }
  panels_menu_->addAction(tools_->toggleViewAction());
  panels_menu_->addSeparator();
  add(panels_menu_, "reset_panels", tr("&Back to Their Places"), {},
      tr("All panels as at the first start"), [this] { reset_panels(); });
  QAction* dark = add(menu, "dark", tr("&Dark Colors"), {}, tr("Light on dark"), [] {});
  dark->setCheckable(true);
  connect(dark, &QAction::triggered, this, [this](bool on) {
    Preferences preferences = preferences_;
    preferences.theme = on ? "dark" : "light";
    apply(preferences);
    preferences_.save();
  });
  connect(menu, &QMenu::aboutToShow, dark,
          [this, dark] { dark->setChecked(preferences_.theme == "dark"); });
}

void MainWindow::make_cage_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Cage"));
  const auto free = [this] { return !session_.jobs().busy(); };
  QAction* generate = add(menu, "generate_cage", tr("&Generate"), {"Ctrl+G"},
                          tr("Makes a cage for the model"), [this] { session_.generate(); });
  QAction* bind = add(menu, "bind_model", tr("&Bind"), {"Ctrl+B"}, tr("Ties the model to the cage"),
                      [this] { session_.bind(); });
  QAction* refine =
      add(menu, "refine_cage", tr("&Refine"), {"Ctrl+Shift+B"},
          tr("Unties the model, to edit the cage itself"), [this] { session_.refine(); });
  QAction* switch_mode = add_in_view(menu, "switch_mode", tr("Refine or De&form"), {"Tab"},
                                     tr("From refining the cage to deforming the model, and back"),
                                     [this] { session_.switch_mode(); });
  QAction* cancel = add(menu, "cancel_job", tr("&Cancel"), {"Ctrl+."},
                        tr("Stops what is under way"), [this] { session_.cancel(); });
  menu->addSeparator();
  using enum CageAction;
  add_action(menu, split, tr("&Split Edges"), {}, tr("A new vertex in the middle of each edge"));
  QAction* loop_cut = add_in_view(menu, "loop_cut", tr("&Loop Cut"), {"Ctrl+R"},
                                  tr("Cuts a ring of quads: point at an edge, the wheel says how "
                                     "often; click, slide, click"),
                                  [this] { viewport_->begin_loop_cut(); });
  needs_.push_back({loop_cut, [this] {
                      const Document& d = session_.document();
                      return d.has_cage() && d.mode() == Mode::refine;
                    }});
  add_action(menu, split_ring, tr("Split &Rings"), {},
             tr("A loop of edges through the middle of the run of quads of each selected edge"));
  add_action(menu, collapse, tr("C&ollapse"), {}, tr("Draws the selected edges together"));
  add_action(menu, flip, tr("&Flip Edge"), {}, tr("The other diagonal of two triangles"));
  add_action(menu, subdivide, tr("S&ubdivide"), {}, tr("Cuts each face in four"));
  add_action(menu, CageAction::remove, tr("Dele&te"), {"Del"},
             tr("Takes the selection away; the cage closes over it"));
  add_action(menu, extrude, tr("E&xtrude Faces"), {"E"}, tr("Moves faces out, with new sides"));
  menu->addSeparator();
  QMenu* repair = menu->addMenu(tr("&Make It Fit"));
  const auto refining = [this, free] {
    const Document& d = session_.document();
    return free() && d.has_cage() && d.mode() == Mode::refine;
  };
  QAction* fit = add(repair, "fit_cage_to_model", tr("&Fit Cage to Model"), {},
                     tr("Scales, turns and shifts a cage of another unit, up axis or place"),
                     [this] { session_.fit_cage_to_model(); });
  needs_.push_back(
      {fit, [this, refining] { return refining() && session_.document().has_model(); }});
  needs_.push_back({add(repair, "weld_cage", tr("&Weld"), {},
                        tr("Makes vertices in one place one vertex, where the cage is open"),
                        [this] { session_.weld_cage(); }),
                    refining});
  needs_.push_back({add(repair, "turn_cage_outward", tr("&Turn Inside Out"), {},
                        tr("Turns all faces outward"), [this] { session_.turn_cage_outward(); }),
                    refining});
  menu->addSeparator();
  add_in_view(menu, "less_depth", tr("One Cut &Less Deep"), {"["},
              tr("Shows the boxes before the last cuts"), [this] { layers_->step_depth(-1); });
  add_in_view(menu, "more_depth", tr("One Cut &Deeper"), {"]"},
              tr("Shows the boxes after the next cuts"), [this] { layers_->step_depth(1); });
  needs_.push_back({generate, [this, free] { return free() && session_.document().has_model(); }});
  needs_.push_back(
      {add(menu, "clear_density", tr("Clear Painted D&ensity"), {},
           tr("Takes away what was painted on the model"), [this] { viewport_->clear_density(); }),
       [this] { return session_.document().state().density != nullptr; }});
  needs_.push_back({add(menu, "clear_mix", tr("Clear Painted Mi&x"), {},
                        tr("The whole model follows by the first kind of coordinates"),
                        [this] { viewport_->clear_mix(); }),
                    [this] { return session_.document().state().mix != nullptr; }});
  needs_.push_back({bind, [this, free] {
                      const Document& d = session_.document();
                      return free() && d.has_model() && d.has_cage() && d.mode() == Mode::refine;
                    }});
  needs_.push_back({switch_mode, [this, free] {
                      return free() && session_.document().has_model() &&
                             session_.document().has_cage();
                    }});
  needs_.push_back({refine, [this] { return session_.document().mode() == Mode::deform; }});
  needs_.push_back({cancel, [this] { return session_.jobs().busy(); }});
}

void MainWindow::make_pose_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Pose"));
  const auto deforming = [this] { return session_.document().mode() == Mode::deform; };
  needs_.push_back({add(menu, "keep_pose", tr("&Keep"), {"Ctrl+K"},
                        tr("Keeps the cage as it is as a pose"), [this] { poses_->add_pose(); }),
                    deforming});
  needs_.push_back(
      {add(menu, "reset", tr("&Reset"), {"Ctrl+Shift+R"}, tr("The cage goes back to rest"),
           [this] { session_.editor().reset_pose(); }),
       deforming});
  needs_.push_back({add(menu, "remove_pins", tr("Remove &Pins"), {},
                        tr("Takes away the pins by which the model is dragged"),
                        [this] { viewport_->remove_pins(); }),
                    [this] { return !session_.document().state().pins.empty(); }});
  menu->addSeparator();
  needs_.push_back({add_in_view(menu, "keyframe", tr("Set Key&frame"), {"K"},
                                tr("The cage as it is becomes a keyframe"),
                                [this] { time_line_->set_keyframe(); }),
                    deforming});
  needs_.push_back(
      {add_in_view(menu, "play_pause", tr("&Play or Pause"), {"Space"}, tr("Plays the keyframes"),
                   [this] { time_line_->toggle_playing(); }),
       deforming});
}

void MainWindow::make_help_menu() {
  QMenu* menu = menuBar()->addMenu(tr("He&lp"));
  add(menu, "first_steps", tr("&First Steps"), {"F1"}, tr("From a model to a deformed one"),
      [this] { show_first_steps(); });
  add(menu, "search", tr("&Search a Command..."), {"F3"}, tr("Any command, by a part of its name"),
      [this] { search_command(); });
  add(menu, "keys", tr("&Keys and Mouse"), {"Shift+F1"}, tr("What keys and mouse do in the view"),
      [this] { show_keys(); });
  add(menu, "about", tr("&About"), {}, tr("Which program this is"), [this] {
    QMessageBox::about(this, tr("About Cagewright"),
                       tr("<b>Cagewright %1</b><p>Builds a cage round a 3D model, proves that it "
                          "is valid, and deforms the model by moving the cage.</p>"
                          "<p>Licence: %2</p>")
                           .arg(QCoreApplication::applicationVersion(),
                                CAGEWRIGHT_WITH_BOXES ? "GPL-3.0-or-later" : "MIT"));
  });
}

void MainWindow::show_first_steps() {
  guide_->show();
  QMessageBox::information(
      this, tr("First Steps"),
      tr("<ol><li><b>Open</b> a model (Ctrl+O), or drop a file onto the window.</li>"
         "<li><b>Generate Cage</b> (Ctrl+G) makes a coarse shell round it. The figures at the "
         "right say whether it is valid: it always is when it was generated.</li>"
         "<li>Edit the cage if you like; faces that no longer fit turn red.</li>"
         "<li><b>Bind</b> (Ctrl+B) ties the model to the cage.</li>"
         "<li>Click a vertex of the cage, or several with Shift, and drag an arrow. The model "
         "follows. Keep states as poses, or as keyframes on the time line.</li>"
         "<li><b>Export Model</b> (Ctrl+E) writes the deformed model.</li></ol>"
         "<p>Everything can be undone (Ctrl+Z). The bar above the view says what comes next.</p>"));
}

QList<QAction*> MainWindow::commands() const {
  QList<QAction*> found;
  const std::function<void(const QMenu*)> add_all = [&](const QMenu* menu) {
    for (QAction* action : menu->actions()) {
      if (action->menu() != nullptr) {
        if (action->menu() != recent_) {
          add_all(action->menu());
        }
      } else if (!action->isSeparator() && !action->text().isEmpty() && !found.contains(action)) {
        action->setProperty(menu_property, menu->title().remove('&'));
        found.append(action);
      }
    }
  };
  for (const QAction* top : menuBar()->actions()) {
    add_all(top->menu());
  }
  return found;
}

void MainWindow::search_command() {
  auto* search = new CommandSearch(commands(), this);
  search->move(viewport_->mapToGlobal(QPoint((viewport_->width() - search->width()) / 2, 60)));
  search->show();
}

void MainWindow::show_keys() {
  const auto row = [](const QString& keys, const QString& what) {
    return QString("<tr><td><b>%1</b></td><td>%2</td></tr>")
        .arg(keys.toHtmlEscaped(), what.toHtmlEscaped());
  };
  QString text = tr("<h3>Mouse</h3>") + "<table cellpadding='3'>";
  for (const auto& [button, effect] : mouse_help(viewport_->key_map())) {
    text += row(button, effect);
  }
  text += "</table>" + tr("<h3>Keys in the view</h3>") + "<table cellpadding='3'>";
  text += viewport_->key_map() == KeyMap::maya
              ? row("Q, W, E, R", tr("tools: select, move, rotate, scale"))
              : row("G, R, S", tr("move, rotate, scale at once"));
  text += row("X, Y, Z", tr("while doing so: along an axis; with Shift in the plane across it"));
  text += row(tr("0-9 . -"), tr("while doing so: exact numbers; Tab: the next one"));
  text += row(tr("Enter, click"), tr("while doing so: done"));
  text += row(tr("Esc, right button, Ctrl+Z"), tr("while doing so: take it back"));
  text += row(tr("Ctrl, Shift"), tr("while doing so: snap, precise"));
  text += row("B", tr("select by a box that may begin anywhere"));
  text += row("O", tr("proportional editing; the wheel changes how far it reaches"));
  text += row("M", tr("select the mirror images, too"));
  text += row("L", tr("select what hangs together"));
  text += row("X", tr("delete"));
  text += row("C", tr("hold to see the model at rest"));
  text += row(tr("Keypad 1 3 7 9 5"), tr("front, right, top, opposite, orthographic; Ctrl: from "
                                         "the other side"));
  text += row(tr("Arrows, keypad 2 4 6 8"), tr("turn the view"));
  text += "</table>" + tr("<h3>Commands</h3>") + "<table cellpadding='3'>";
  for (const QAction* command : commands()) {
    QStringList keys;
    for (const QKeySequence& key : command->shortcuts()) {
      keys.append(key.toString(QKeySequence::NativeText));
    }
    if (!keys.isEmpty()) {
      text += row(keys.join(", "), full_name(*command));
    }
  }
  text += "</table>";
  auto* dialog = new QDialog(this);
  dialog->setObjectName("keys_page");
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(tr("Keys and Mouse"));
  auto* layout = new QVBoxLayout(dialog);
  auto* page = new QTextBrowser;
  page->setHtml(text);
  layout->addWidget(page);
  dialog->resize(560, 640);
  dialog->show(); // beside the work
}

// ---- Files

void MainWindow::choose_model() {
  const QString start = QSettings().value("last_folder").toString();
  const QString path = QFileDialog::getOpenFileName(this, tr("Open a Model or a Project"), start,
                                                    model_filter(true));
  if (!path.isEmpty()) {
    QSettings().setValue("last_folder", QFileInfo(path).path());
    open(path);
  }
}

QString MainWindow::ask_for_model(const QString& title) {
  const QString start = QSettings().value("last_folder").toString();
  return QFileDialog::getOpenFileName(this, title, start, model_filter(false));
}

void MainWindow::choose_cage() {
  const QString path = ask_for_model(tr("Load a Cage"));
  if (!path.isEmpty()) {
    session_.load_cage(path.toStdString());
  }
}

void MainWindow::choose_export(const QString& title, const QString& name, const QString& filter,
                               const std::function<void(const std::filesystem::path&)>& write) {
  QFileDialog dialog(this, title, QFileInfo(name).path(), filter);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setFileMode(QFileDialog::AnyFile);
  dialog.setDefaultSuffix(QFileInfo(name).suffix()); // for names without an extension
  dialog.selectFile(QFileInfo(name).fileName());
  connect(&dialog, &QFileDialog::filterSelected, &dialog, [&dialog](const QString& chosen) {
    static const QRegularExpression first("\\*\\.(\\w+)");
    const QString suffix = first.match(chosen).captured(1);
    const QStringList selected = dialog.selectedFiles();
    if (!suffix.isEmpty() && !selected.isEmpty()) {
      dialog.setDefaultSuffix(suffix);
      dialog.selectFile(QFileInfo(selected.first()).completeBaseName() + "." + suffix);
    }
  });
  if (dialog.exec() == QDialog::Accepted && !dialog.selectedFiles().isEmpty()) {
    write(dialog.selectedFiles().first().toStdString());
  }
}

QString MainWindow::export_filter() const {
  const QString other = tr("Positions and faces only (*.obj *.ply *.stl *.off)");
  const Document& document = const_cast<MainWindow*>(this)->session_.document();
  if (!document.has_model() || document.model()->path.empty()) {
    return other;
  }
  const QString own = QFileInfo(QString::fromStdString(document.model()->path.string())).suffix();
  return tr("As the model, with all that is in its file (*.%1)").arg(own) + ";;" + other;
}

void MainWindow::export_model() {
  choose_export(tr("Export Model"), suggested("-deformed", {}), export_filter(),
                [this](const auto& path) { session_.export_model(path); });
}

void MainWindow::export_image() {
  choose_export(tr("Image of the View"), suggested("-view", ".png"), tr("Pictures (*.png *.jpg)"),
                [this](const std::filesystem::path& path) {
                  const QSize size = viewport_->size() * viewport_->devicePixelRatio();
                  const QString name = QString::fromStdString(path.string());
                  if (viewport_->picture(size).save(name)) {
                    statusBar()->showMessage(tr("Wrote %1").arg(name), 15000);
                  } else {
                    show_error(tr("Image of the View"), tr("%1 cannot be written").arg(name));
                  }
                });
}

bool MainWindow::save() {
  return session_.project_path().empty() ? save_as()
                                         : session_.save_project(session_.project_path());
}

bool MainWindow::save_as() {
  bool saved = false;
  choose_export(tr("Save Project"), suggested({}, ".cagewright"),
                tr("Cagewright projects (*.cagewright)"),
                [&](const auto& path) { saved = session_.save_project(path); });
  return saved;
}

void MainWindow::show_recent() {
  recent_->clear();
  for (const QString& path : recent_files()) {
    connect(recent_->addAction(path), &QAction::triggered, this, [this, path] { open(path); });
  }
  if (recent_->isEmpty()) {
    recent_->addAction(tr("None yet"))->setEnabled(false);
    return;
  }
  recent_->addSeparator();
  connect(recent_->addAction(tr("Forget Them")), &QAction::triggered, this,
          [] { clear_recent_files(); });
}

} // namespace cagewright::app
