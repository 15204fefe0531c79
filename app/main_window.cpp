#include "app/main_window.h"

#include "app/document/selected_vertices.h"
#include "app/panels/figures_panel.h"
#include "app/panels/generate_panel.h"
#include "app/panels/guide_bar.h"
#include "app/panels/layers_panel.h"
#include "app/panels/poses_panel.h"
#include "app/panels/sections_panel.h"
#include "app/panels/selection_panel.h"
#include "app/panels/time_line_panel.h"
#include "app/panels/tool_bar.h"
#include "app/theme.h"
#include "app/view/viewport.h"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QSettings>
#include <QSlider>
#include <QStatusBar>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace cagewright::app {
namespace {

QDockWidget* dock(QMainWindow* window, const char* name, const QString& title, QWidget* content,
                  Qt::DockWidgetArea area, bool scrolls) {
  auto* made = new QDockWidget(title, window);
  made->setObjectName(name);
  if (scrolls) {
    auto* scroll = new QScrollArea;
    scroll->setWidget(content);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    made->setWidget(scroll);
  } else {
    made->setWidget(content);
  }
  window->addDockWidget(area, made);
  return made;
}

/// Two docks in one place, each as high as it was when it was seen last.
void share_height(QDockWidget* first, int first_height, QDockWidget* second, int second_height) {
  const auto heights = std::make_shared<std::map<QDockWidget*, int>>();
  (*heights)[first] = first_height;
  (*heights)[second] = second_height;
  const auto take_turns = [heights](QDockWidget* shown, QDockWidget* other) {
    QObject::connect(shown, &QDockWidget::visibilityChanged, shown, [=](bool visible) {
      auto* window = qobject_cast<QMainWindow*>(shown->parentWidget());
      if (visible && window != nullptr && window->tabifiedDockWidgets(shown).contains(other)) {
        if (window->isVisible() && other->height() > 0) {
          heights->at(other) = shown->height(); // as high as the other one was until now
        }
        window->resizeDocks({shown}, {heights->at(shown)}, Qt::Vertical);
      }
    });
  };
  take_turns(first, second);
  take_turns(second, first);
}

QString file_of(const QDropEvent& event) {
  const QList<QUrl> urls = event.mimeData()->urls();
  return urls.isEmpty() ? QString() : urls.first().toLocalFile();
}

} // namespace

MainWindow::MainWindow(const QDir& recovery_folder, QWidget* parent)
    : QMainWindow(parent), preferences_(Preferences::load()), recovery_(session_, recovery_folder) {
  setAcceptDrops(true);
  setDockNestingEnabled(true);
  resize(QSize(1440, 900).boundedTo(screen()->availableSize())); // until the user says otherwise
  make_panels();
  make_status_bar();
  make_menus();
  connect_session();
  first_layout_ = saveState();
  const QSettings settings;
  restoreGeometry(settings.value("window/geometry").toByteArray());
  restoreState(settings.value("window/state").toByteArray());
  session_.set_settings(generate_settings_from_json(settings.value("generate").toJsonObject()));
  apply(preferences_);
  update_title();
  update_actions();
  // Clicks leave the focus where it is: with the view.
  for (QAbstractButton* button : findChildren<QAbstractButton*>()) {
    button->setFocusPolicy(Qt::TabFocus);
  }
  for (QSlider* slider : findChildren<QSlider*>()) {
    slider->setFocusPolicy(Qt::TabFocus);
  }
  viewport_->setFocus();
  qApp->installEventFilter(this);
}

MainWindow::~MainWindow() {
  qApp->removeEventFilter(this);
  disconnect(&session_, nullptr, this, nullptr);
  disconnect(&session_.document(), nullptr, this, nullptr);
  disconnect(&session_.jobs(), nullptr, this, nullptr);
  disconnect(&session_.editor().undo_stack(), nullptr, this, nullptr);
  // The view and the panels look at the session: they go before it.
  delete takeCentralWidget();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) {
    delete dock;
  }
  delete tools_;
}

void MainWindow::make_panels() {
  auto* middle = new QWidget;
  auto* layout = new QVBoxLayout(middle);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  guide_ = new GuideBar(session_);
  layout->addWidget(guide_);
  viewport_ = new Viewport(session_.editor());
  viewport_->setObjectName("viewport");
  layout->addWidget(viewport_, 1);
  setCentralWidget(middle);

  welcome_ = new QLabel(viewport_);
  welcome_->setObjectName("welcome");
  welcome_->setAlignment(Qt::AlignCenter);
  welcome_->setTextFormat(Qt::RichText);
  welcome_->setAttribute(Qt::WA_TransparentForMouseEvents);
  welcome_->setText(
      tr("<p style='font-size:20pt'>Drop a model here</p>"
         "<p style='font-size:12pt'>or press <b>Ctrl+O</b> to open one</p>"
         "<p style='font-size:11pt'>Then: <b>Generate Cage</b> &rarr; <b>Bind</b> &rarr; drag the "
         "cage's vertices &rarr; <b>Export Model</b></p>"));

  tools_ = new ToolBar(session_.document());
  addToolBar(tools_);

  generate_ = new GeneratePanel(session_);
  layers_ = new LayersPanel(session_);
  poses_ = new PosesPanel(session_.editor());
  time_line_ = new TimeLinePanel(session_.editor());
  sections_ = new SectionsPanel(session_.document());
  auto* figures = new FiguresPanel(session_.document());
  connect(figures, &FiguresPanel::violationChosen, this, &MainWindow::show_violation);
  auto* selection = new SelectionPanel(session_.editor());
  dock(this, "dock_generate", tr("Make a Cage"), generate_, Qt::LeftDockWidgetArea, false);
  QDockWidget* figures_dock =
      dock(this, "dock_figures", tr("Figures"), figures, Qt::RightDockWidgetArea, true);
  QDockWidget* select =
      dock(this, "dock_selection", tr("Selection"), selection, Qt::RightDockWidgetArea, true);
  QDockWidget* layers =
      dock(this, "dock_layers", tr("Layers"), layers_, Qt::RightDockWidgetArea, true);
  QDockWidget* poses = dock(this, "dock_poses", tr("Poses"), poses_, Qt::RightDockWidgetArea, true);
  tabifyDockWidget(layers, poses);
  layers->raise();
  QDockWidget* line =
      dock(this, "dock_time_line", tr("Time Line"), time_line_, Qt::BottomDockWidgetArea, false);
  QDockWidget* sections = dock(this, "dock_sections", tr("Boxes and Cross-Sections"), sections_,
                               Qt::BottomDockWidgetArea, false);
  tabifyDockWidget(line, sections);
  line->raise();
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  resizeDocks({line}, {110}, Qt::Vertical);
  share_height(line, 110, sections, 280);
  resizeDocks({figures_dock, select, layers}, {212, 172, 340}, Qt::Vertical);
  connect(generate_, &GeneratePanel::loadCageRequested, this, &MainWindow::choose_cage);
  connect(guide_, &GuideBar::openRequested, this, &MainWindow::choose_model);
  connect(guide_, &GuideBar::exportRequested, this, &MainWindow::export_model);
}

void MainWindow::make_status_bar() {
  step_ = new QLabel;
  progress_ = new QProgressBar;
  progress_->setObjectName("progress");
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  progress_->setFixedWidth(200);
  cancel_ = new QToolButton;
  cancel_->setObjectName("cancel");
  cancel_->setText(tr("Cancel"));
  cancel_->setToolTip(tr("Stops what is under way; nothing is changed (Ctrl+.)"));
  mode_ = new QLabel;
  mode_->setObjectName("mode");
  mode_->setToolTip(tr("Refine: the cage itself is edited. Deform: the cage moves the model"));
  for (QWidget* widget : std::initializer_list<QWidget*>{step_, progress_, cancel_}) {
    statusBar()->addPermanentWidget(widget);
    widget->hide();
  }
  statusBar()->addPermanentWidget(mode_);
  connect(cancel_, &QToolButton::clicked, &session_, &Session::cancel);
}

void MainWindow::connect_session() {
  const auto say = [this](const QString& text) { statusBar()->showMessage(text, 15000); };
  connect(&session_, &Session::message, this, say);
  connect(viewport_, &Viewport::hint, this,
          [this](const QString& text) { statusBar()->showMessage(text); });
  connect(&session_, &Session::failed, this, &MainWindow::show_error);
  connect(&session_, &Session::titleChanged, this, &MainWindow::update_title);
  connect(&session_, &Session::opened, this, [](const QString& path) { add_recent_file(path); });
  connect(&session_, &Session::cameraRestored, this, [this](const QJsonObject& camera) {
    if (camera.isEmpty()) {
      viewport_->frame_all();
    } else {
      viewport_->set_camera_state(camera);
    }
  });
  connect(&session_, &Session::modelMissing, this,
          [this](const QString& project, const QString& model) {
            const QString chosen = QFileDialog::getOpenFileName(
                this, tr("Where is %1?").arg(QFileInfo(model).fileName()),
                QFileInfo(project).path(), model_filter(false));
            if (chosen.isEmpty()) {
              show_error(tr("Open Project"), tr("The project's model is not there: %1").arg(model));
            } else {
              session_.open_project_with_model(project.toStdString(), chosen.toStdString());
            }
          });
  session_.set_asker([this](const Question& question) {
    QMessageBox box(QMessageBox::Question, question.title, question.text, QMessageBox::Cancel,
                    this);
    const QAbstractButton* go_on = box.addButton(question.go_on, QMessageBox::AcceptRole);
    box.exec();
    return box.clickedButton() == go_on;
  });
  connect(&session_, &Session::bindingDoubtful, this, &MainWindow::ask_about_binding);
  session_.set_camera_source([this] { return viewport_->camera_state(); });

  JobRunner& jobs = session_.jobs();
  connect(&jobs, &JobRunner::started, this, [this](const QString& title) {
    statusBar()->clearMessage();
    step_->setText(title + "...");
    progress_->setValue(0);
    cancel_->setEnabled(true);
    for (QWidget* widget : std::initializer_list<QWidget*>{step_, progress_, cancel_}) {
      widget->show();
    }
    update_actions();
  });
  connect(&jobs, &JobRunner::progressed, this,
          [this](double fraction, const QString& step, const QString& left) {
            progress_->setValue(static_cast<int>(1000 * fraction));
            step_->setText(
                QString("%1: %2%3")
                    .arg(session_.jobs().title(), step, left.isEmpty() ? left : ", " + left));
          });
  connect(&jobs, &JobRunner::finished, this, [this] {
    for (QWidget* widget : std::initializer_list<QWidget*>{step_, progress_, cancel_}) {
      widget->hide();
    }
    update_actions();
  });
  Document& document = session_.document();
  connect(&document, &Document::modelChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::cageChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::modeChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::posesChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::timeLineChanged, this, &MainWindow::update_actions);
}

void MainWindow::update_title() {
  const QString title = session_.title();
  setWindowTitle(title.isEmpty() ? tr("Cagewright") : title + "[*] - " + tr("Cagewright"));
  setWindowModified(!title.isEmpty() && session_.modified());
}

void MainWindow::update_actions() {
  for (const Need& need : needs_) {
    need.action->setEnabled(need.met());
  }
  const Document& document = session_.document();
  mode_->setText(!document.has_cage()              ? QString()
                 : document.mode() == Mode::refine ? tr("Refine")
                                                   : tr("Deform"));
  welcome_->setVisible(!document.has_model() && !document.has_cage());
}

void MainWindow::apply(const Preferences& preferences) {
  preferences_ = preferences;
  const Theme theme = theme_named(preferences.theme);
  apply_theme(*qApp, theme);
  viewport_->set_dark(theme == Theme::dark);
  viewport_->set_coarse_while_moving(preferences.coarse_while_moving);
  viewport_->set_up_axis(preferences.z_up ? UpAxis::z : UpAxis::y);
  sections_->set_dark(theme == Theme::dark);
  welcome_->setStyleSheet(theme == Theme::dark ? "color: #c9ccd1" : "color: #4a4d52");
  recovery_.set_interval(preferences.autosave_seconds);
  guide_->setVisible(preferences.hints);
}

void MainWindow::show_error(const QString& title, const QString& text) {
  auto* box = new QMessageBox(QMessageBox::Warning, title, text, QMessageBox::Ok, this);
  box->setObjectName("error");
  box->setAttribute(Qt::WA_DeleteOnClose);
  box->setTextInteractionFlags(Qt::TextSelectableByMouse);
  box->open(); // not modal for the program: jobs go on
}

void MainWindow::ask_about_binding(const std::shared_ptr<const ValidityReport>& report) {
  QStringList found;
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (report->counts[k] > 0) {
      found.append(describe(static_cast<ViolationKind>(k), report->counts[k]));
    }
  }
  auto* box = new QMessageBox(
      QMessageBox::Warning, tr("Bind"),
      tr("This is not a valid cage of the model: parts of the model may not follow it, or follow "
         "wrongly.<ul><li>%1</li></ul>")
          .arg(found.join("</li><li>")),
      QMessageBox::NoButton, this);
  box->setObjectName("binding_question");
  box->setAttribute(Qt::WA_DeleteOnClose);
  const auto offer = [&](const char* name, const QString& text, QMessageBox::ButtonRole role,
                         const std::function<void()>& act) {
    QPushButton* button = box->addButton(text, role);
    button->setObjectName(name);
    connect(button, &QPushButton::clicked, this, act);
    return button;
  };
  const auto any = [&](std::initializer_list<ViolationKind> kinds) {
    return std::ranges::any_of(kinds, [&](ViolationKind k) { return report->count(k) > 0; });
  };
  using enum ViolationKind;
  if (any({open_edge, coincident_vertices, unused_vertex, degenerate_face})) {
    offer("weld", tr("Weld"), QMessageBox::ActionRole, [this] {
      session_.weld_cage_and_bind();
    })->setToolTip(tr("Makes vertices in one place one vertex"));
  }
  if (any({inverted_piece, flipped_edge})) {
    offer("turn_outward", tr("Turn Inside Out"), QMessageBox::ActionRole, [this] {
      session_.turn_cage_outward_and_bind();
    })->setToolTip(tr("Turns all faces outward"));
  }
  offer("show_problem", tr("Show the Problem"), QMessageBox::ActionRole,
        [this, report] { show_violation(report->violations.front()); });
  offer("bind_anyway", tr("Bind Anyway"), QMessageBox::AcceptRole,
        [this] { session_.bind(Session::Doubts::ignore); });
  QPushButton* cancel = box->addButton(QMessageBox::Cancel);
  box->setDefaultButton(cancel);
  box->open();
}

void MainWindow::show_violation(const Violation& violation) {
  Document& document = session_.document();
  Layers layers = document.layers();
  layers.problems = true;
  document.set_layers(layers);
  if (document.has_cage()) {
    if (const std::optional<Selection> at = selection_at(violation, document.cage_rest())) {
      session_.editor().select(*at);
    }
  }
  viewport_->frame_place(violation.place);
}

void MainWindow::open(const QString& path, const QString& cage) {
  if (may_discard()) {
    session_.open(path.toStdString(), cage.toStdString());
  }
}

void MainWindow::offer_recovery() {
  for (const QString& path : recovery_.abandoned()) {
    QMessageBox box(
        QMessageBox::Question, tr("Recover Work"),
        tr("The program did not end as it should. Work on %1 was kept, as it was at "
           "%2.")
            .arg(Recovery::subject_of(path),
                 QLocale().toString(QFileInfo(path).lastModified(), QLocale::ShortFormat)),
        QMessageBox::NoButton, this);
    const QAbstractButton* recover = box.addButton(tr("Recover It"), QMessageBox::AcceptRole);
    const QAbstractButton* forget = box.addButton(tr("Delete It"), QMessageBox::DestructiveRole);
    QPushButton* later = box.addButton(tr("Ask Again Next Time"), QMessageBox::RejectRole);
    box.setEscapeButton(later);
    box.exec();
    if (box.clickedButton() == recover) {
      recovery_.recover(path);
      return;
    }
    if (box.clickedButton() == forget) {
      Recovery::discard(path);
    }
  }
}

bool MainWindow::may_discard() {
  if (!preferences_.ask_before_closing || !session_.modified()) {
    return true;
  }
  const auto answer = QMessageBox::question(
      this, tr("Unsaved Work"), tr("Save the project before going on?"),
      QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, QMessageBox::Save);
  return answer == QMessageBox::Discard || (answer == QMessageBox::Save && save());
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!may_discard()) {
    event->ignore();
    return;
  }
  session_.cancel();
  QSettings settings;
  settings.setValue("window/geometry", saveGeometry());
  settings.setValue("window/state", saveState());
  settings.setValue("generate", to_json(session_.settings()));
  preferences_.save();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (!file_of(*event).isEmpty()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QString file = file_of(*event);
  event->acceptProposedAction();
  // Not from within the drop: the program that the file comes from waits for its end.
  QMetaObject::invokeMethod(
      this, [this, file] { open(file); }, Qt::QueuedConnection);
}

/// Keys belong to the view wherever a click has left the focus, but for what is typed, and for what
/// moves about in lists.
bool MainWindow::is_for_view(const QWidget* focus, const QKeyEvent& key) const {
  if (focus == viewport_ || focus->window() != this ||
      QApplication::activeModalWidget() != nullptr ||
      QApplication::activePopupWidget() != nullptr || qobject_cast<const QMenuBar*>(focus)) {
    return false;
  }
  const Qt::KeyboardModifiers modifiers = key.modifiers() & ~Qt::ShiftModifier;
  const bool letter = key.key() >= Qt::Key_A && key.key() <= Qt::Key_Z;
  const bool sign = key.key() == Qt::Key_Space || key.key() == Qt::Key_Slash ||
                    key.key() == Qt::Key_BracketLeft || key.key() == Qt::Key_BracketRight;
  if (qobject_cast<const QAbstractSpinBox*>(focus) ||
      qobject_cast<const QAbstractSpinBox*>(focus->parentWidget())) {
    return modifiers == Qt::NoModifier && (letter || sign); // its numbers stay its own
  }
  if (focus->testAttribute(Qt::WA_InputMethodEnabled)) {
    return false; // text
  }
  if (key.key() == Qt::Key_Space && qobject_cast<const QAbstractButton*>(focus)) {
    return false; // reached by Tab: clicks do not give buttons the focus
  }
  const bool digit = key.key() >= Qt::Key_0 && key.key() <= Qt::Key_9;
  return letter || sign || digit || key.key() == Qt::Key_Escape || key.key() == Qt::Key_Delete ||
         key.key() == Qt::Key_Plus || key.key() == Qt::Key_Minus || key.key() == Qt::Key_Equal;
}

bool MainWindow::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
  case QEvent::ShortcutOverride:
  case QEvent::KeyPress:
  case QEvent::KeyRelease: {
    const auto* widget = qobject_cast<QWidget*>(watched);
    // What the view does not want goes on to its parents.
    if (widget != nullptr && !passes_on_key_ &&
        is_for_view(widget, *static_cast<QKeyEvent*>(event))) {
      viewport_->setFocus(Qt::ShortcutFocusReason); // before shortcuts are looked for
      passes_on_key_ = true;
      QCoreApplication::sendEvent(viewport_, event);
      passes_on_key_ = false;
      return true;
    }
    break;
  }
  case QEvent::Enter:
  case QEvent::MouseMove:
    if (watched == viewport_ && isActiveWindow() && !viewport_->hasFocus() &&
        QApplication::activePopupWidget() == nullptr) {
      const QWidget* focus = focusWidget();
      const bool types = focus != nullptr && focus->testAttribute(Qt::WA_InputMethodEnabled) &&
                         qobject_cast<const QAbstractSpinBox*>(focus) == nullptr;
      if (!types || event->type() == QEvent::Enter) {
        viewport_->setFocus(Qt::MouseFocusReason);
      }
    }
    break;
  default:
    break;
  }
  if (watched == viewport_) {
    if (event->type() == QEvent::Resize) {
      welcome_->setGeometry(viewport_->rect());
    } else if (event->type() == QEvent::KeyPress || event->type() == QEvent::KeyRelease) {
      const auto* key = static_cast<QKeyEvent*>(event);
      if (key->key() == Qt::Key_C && key->modifiers() == Qt::NoModifier) {
        if (!key->isAutoRepeat() && session_.document().mode() == Mode::deform) {
          session_.document().set_comparing(event->type() == QEvent::KeyPress);
        }
        return true;
      }
    } else if (event->type() == QEvent::FocusOut) {
      session_.document().set_comparing(false);
    }
  }
  return QMainWindow::eventFilter(watched, event);
}

void MainWindow::reset_panels() {
  restoreState(first_layout_);
}

} // namespace cagewright::app
