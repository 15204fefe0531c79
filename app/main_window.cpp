#include "app/main_window.h"

#include "app/document/selected_vertices.h"
#include "app/edit/select.h"
#include "app/panels/figures_panel.h"
#include "app/panels/generate_panel.h"
#include "app/panels/guide_bar.h"
#include "app/panels/history_panel.h"
#include "app/panels/layers_panel.h"
#include "app/panels/poses_panel.h"
#include "app/panels/sections_panel.h"
#include "app/panels/selection_panel.h"
#include "app/panels/time_line_panel.h"
#include "app/panels/tool_bar.h"
#include "app/panels/welcome_page.h"
#include "app/samples.h"
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
#include <QMenu>
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
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
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
    // Never so narrow that something is cut.
    scroll->setMinimumWidth(content->minimumSizeHint().width() +
                            window->style()->pixelMetric(QStyle::PM_ScrollBarExtent) + 2);
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

// On screens that are lower, in logical pixels, three panels one above the other are too many.
constexpr int low_screen = 800;

QSize pleasant_size() {
  return {1440, 900};
}

/// With a frame round it.
bool fits(const QSize& window, const QSize& available) {
  return window.width() < available.width() && window.height() < available.height();
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
  resize(pleasant_size().boundedTo(screen()->availableSize())); // until the user says otherwise
  make_panels();
  make_status_bar();
  make_menus();
  connect_session();
  first_layout_ = saveState();
  const QSettings settings;
  const bool placed = restoreGeometry(settings.value("window/geometry").toByteArray());
  fills_screen_ = !placed && !fits(pleasant_size(), screen()->availableSize());
  restoreState(settings.value("window/state").toByteArray());
  fold_panels();
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

  welcome_ = new WelcomePage(viewport_);
  connect(welcome_, &WelcomePage::openRequested, this, &MainWindow::choose_model);
  connect(welcome_, &WelcomePage::helpRequested, this, &MainWindow::show_first_steps);
  connect(welcome_, &WelcomePage::fileRequested, this, [this](const QString& path) { open(path); });
  connect(welcome_, &WelcomePage::sampleRequested, this, &MainWindow::open_sample);
  notice_ = new QLabel(viewport_);
  notice_->setObjectName("notice");
  notice_->setAttribute(Qt::WA_TransparentForMouseEvents);
  notice_->setStyleSheet("background: rgba(25, 27, 31, 215); color: white; border-radius: 6px; "
                         "padding: 5px 12px");
  notice_->hide();
  notice_timer_.setSingleShot(true);
  notice_timer_.setInterval(6000);
  connect(&notice_timer_, &QTimer::timeout, notice_, &QWidget::hide);
  connect(&session_.editor(), &Editor::message, this, &MainWindow::show_notice);

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
  QDockWidget* generate_dock =
      dock(this, "dock_generate", tr("Make a Cage"), generate_, Qt::LeftDockWidgetArea, false);
  QDockWidget* figures_dock =
      dock(this, "dock_figures", tr("Figures"), figures, Qt::RightDockWidgetArea, true);
  QDockWidget* select =
      dock(this, "dock_selection", tr("Selection"), selection, Qt::RightDockWidgetArea, true);
  QDockWidget* layers =
      dock(this, "dock_layers", tr("Layers"), layers_, Qt::RightDockWidgetArea, true);
  QDockWidget* poses = dock(this, "dock_poses", tr("Poses"), poses_, Qt::RightDockWidgetArea, true);
  QDockWidget* history =
      dock(this, "dock_history", tr("History"), new HistoryPanel(session_.editor().undo_stack()),
           Qt::RightDockWidgetArea, false);
  // Dock tabs are made when they are needed: their names are read whole.
  setStyleSheet(
      "QMainWindow > QTabBar::tab { padding: 4px 7px; border: none; border-top: 2px solid "
      "transparent; } "
      "QMainWindow > QTabBar::tab:selected { border-top-color: palette(highlight); }");
  tabifyDockWidget(layers, poses);
  tabifyDockWidget(poses, history);
  layers->raise();
  line_dock_ =
      dock(this, "dock_time_line", tr("Time Line"), time_line_, Qt::BottomDockWidgetArea, false);
  sections_dock_ = dock(this, "dock_sections", tr("Boxes and Cross-Sections"), sections_,
                        Qt::BottomDockWidgetArea, false);
  tabifyDockWidget(line_dock_, sections_dock_);
  line_dock_->raise();
  setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
  setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
  resizeDocks({line_dock_}, {110}, Qt::Vertical);
  share_height(line_dock_, 110, sections_dock_, 280);
  fold_panels();
  resizeDocks({figures_dock, select, layers}, {212, 172, 340}, Qt::Vertical);
  resizeDocks({generate_dock, figures_dock}, {240, 260}, Qt::Horizontal);
  if (screen()->availableSize().height() < low_screen) {
    tabifyDockWidget(history, select);
    layers->raise();
  }
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
  connect(viewport_, &Viewport::regionPainted, &session_, [this](const std::vector<Index>& faces) {
    session_.choose_region(tr("the painted part"), faces);
  });
  connect(viewport_, &Viewport::regionOutlined, &session_, &Session::choose_outlined);
  connect(viewport_, &Viewport::menuRequested, this, &MainWindow::show_view_menu);
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
  connect(&document, &Document::selectionChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::posesChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::timeLineChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::pinsChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::densityChanged, this, &MainWindow::update_actions);
  connect(&document, &Document::mixChanged, this, &MainWindow::update_actions);
  // What was refused is past as soon as something else is shown.
  connect(&document, &Document::modelChanged, notice_, &QWidget::hide);
  connect(&document, &Document::cageChanged, notice_, &QWidget::hide);
  connect(&document, &Document::modeChanged, notice_, &QWidget::hide);
  connect(&document, &Document::selectionChanged, notice_, &QWidget::hide);
  connect(&document, &Document::toolsChanged, notice_, &QWidget::hide);
  connect(&document, &Document::posesChanged, this, &MainWindow::unfold_panels);
  connect(&document, &Document::timeLineChanged, this, &MainWindow::unfold_panels);
  connect(&document, &Document::stagesChanged, this, &MainWindow::unfold_panels);
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
  const CageAction mode =
      document.selection().mode == SelectionMode::vertex ? CageAction::vertex_mode
      : document.selection().mode == SelectionMode::edge ? CageAction::edge_mode
                                                         : CageAction::face_mode;
  findChild<QAction*>(command_name(mode))->setChecked(true);
  const bool empty = !document.has_model() && !document.has_cage();
  if (empty && !welcome_->isVisible()) {
    welcome_->set_recent(recent_files());
  }
  welcome_->setVisible(empty);
}

void MainWindow::apply(const Preferences& preferences) {
  preferences_ = preferences;
  const Theme theme = theme_named(preferences.theme);
  apply_theme(*qApp, theme);
  viewport_->set_dark(theme == Theme::dark);
  apply_key_map(key_map_named(preferences.key_map));
  viewport_->set_wheel_reversed(preferences.wheel_reversed);
  viewport_->set_coarse_while_moving(preferences.coarse_while_moving);
  viewport_->set_up_axis(preferences.z_up ? UpAxis::z : UpAxis::y);
  sections_->set_dark(theme == Theme::dark);
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

void MainWindow::ask_about_binding(const BindingDoubts& doubts) {
  const std::shared_ptr<const ValidityReport>& report = doubts.report;
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
              .arg(found.join("</li><li>")) +
          (doubts.fit ? tr("<p>It would fit if it were %1: then %2 % of the model's vertices were "
                           "inside.</p>")
                            .arg(QString::fromStdString(doubts.fit->description).toHtmlEscaped())
                            .arg(std::floor(100 * doubts.fit->inside))
                      : QString()),
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
  if (doubts.fit) {
    offer("fit_cage", tr("Fit Cage to Model"), QMessageBox::ActionRole, [this] {
      session_.fit_cage_to_model(Session::Then::bind);
    })->setToolTip(tr("The cage is %1").arg(QString::fromStdString(doubts.fit->description)));
  }
  if (any({open_edge, coincident_vertices, unused_vertex, degenerate_face})) {
    offer("weld", tr("Weld"), QMessageBox::ActionRole, [this] {
      session_.weld_cage(Session::Then::bind);
    })->setToolTip(tr("Makes vertices in one place one vertex"));
  }
  if (any({inverted_piece, flipped_edge})) {
    offer("turn_outward", tr("Turn Inside Out"), QMessageBox::ActionRole, [this] {
      session_.turn_cage_outward(Session::Then::bind);
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

void MainWindow::open_sample(Sample sample) {
  const Result<SampleFiles> files = sample_files();
  if (!files) {
    show_error(tr("Open Sample"), QString::fromStdString(files.error().message));
    return;
  }
  if (may_discard()) {
    session_.open(files->model, sample == Sample::model ? std::filesystem::path() : files->cage,
                  sample == Sample::bound ? Session::Then::bind : Session::Then::stay);
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

void MainWindow::showEvent(QShowEvent* event) {
  QMainWindow::showEvent(event);
  if (std::exchange(fills_screen_, false)) {
    // Later: of a window that is not there yet, managers of windows forget it.
    QTimer::singleShot(0, this, &QWidget::showMaximized);
  }
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!may_discard()) {
    event->ignore();
    return;
  }
  session_.cancel();
  if (!layout_before_full_view_.isEmpty()) {
    toggle_full_view();
  }
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
  if (key.key() == Qt::Key_Tab) { // walks from field to field for who came there by it
    return clicked_focus_ && modifiers == Qt::NoModifier;
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
  case QEvent::FocusIn:
    if (watched != viewport_ && watched->isWidgetType()) {
      clicked_focus_ = static_cast<QFocusEvent*>(event)->reason() == Qt::MouseFocusReason;
    }
    break;
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
      notice_->move((viewport_->width() - notice_->width()) / 2, 52);
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

void MainWindow::show_notice(const QString& text) {
  if (text.isEmpty()) {
    return;
  }
  notice_->setText(as_sentence(text));
  notice_->setWordWrap(notice_->fontMetrics().horizontalAdvance(text) > viewport_->width() - 80);
  notice_->setMaximumWidth(viewport_->width() - 40);
  notice_->adjustSize();
  notice_->move((viewport_->width() - notice_->width()) / 2, 52);
  notice_->show();
  notice_timer_.start();
}

void MainWindow::toggle_full_view() {
  if (!layout_before_full_view_.isEmpty()) {
    restoreState(layout_before_full_view_);
    guide_->setVisible(guide_before_full_view_);
    layout_before_full_view_.clear();
    return;
  }
  layout_before_full_view_ = saveState();
  guide_before_full_view_ = guide_->isVisible();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) {
    dock->hide();
  }
  tools_->hide();
  guide_->hide();
}

void MainWindow::cycle_shading() {
  Layers layers = session_.document().layers();
  // Smooth, smooth with its edges, flat, and from the start.
  if (layers.wireframe) {
    layers.wireframe = false;
    layers.smooth_normals = false;
  } else if (layers.smooth_normals) {
    layers.wireframe = true;
  } else {
    layers.smooth_normals = true;
  }
  session_.document().set_layers(layers);
}

void MainWindow::show_view_menu(const QPoint& at) {
  Document& document = session_.document();
  const auto action = [this](const QString& name) { return findChild<QAction*>(name); };
  const auto cage_action = [&](CageAction a) { return action(command_name(a)); };
  QList<QAction*> entries;
  if (document.has_cage()) {
    PolygonMesh cage = document.cage();
    const auto shown = document.shown_cage_positions();
    cage.positions.assign(shown.begin(), shown.end());
    const CageGraph graph(cage);
    const SelectionMode mode = document.selection().mode;
    const std::optional<Pick> pick =
        Picker(cage, graph).pick(viewport_->camera(), Pixel(at.x(), at.y()), mode);
    if (pick) {
      Selection found;
      found.mode = mode;
      if (mode == SelectionMode::vertex) {
        found.vertices = {pick->element};
      } else if (mode == SelectionMode::edge) {
        found.edges = {graph.edge(pick->element)};
      } else {
        found.faces = {pick->element};
      }
      if (!(combined(document.selection(), found, Combine::add) == document.selection())) {
        session_.editor().select(found);
      }
    }
    using enum CageAction;
    if (!document.selection().empty()) {
      entries = {cage_action(grow), cage_action(select_linked), cage_action(mirror_selection),
                 action("frame_selection"), nullptr};
      if (document.mode() == Mode::refine) {
        if (mode == SelectionMode::edge) {
          entries += {action("loop_cut"), cage_action(split), cage_action(flip),
                      cage_action(select_loop), cage_action(select_ring)};
        } else if (mode == SelectionMode::face) {
          entries += {cage_action(extrude), cage_action(subdivide)};
        }
        entries += {cage_action(collapse), cage_action(CageAction::remove), nullptr};
      }
    }
    entries += {cage_action(select_all), cage_action(invert), nullptr};
  }
  if (document.mode() == Mode::deform) {
    entries +=
        {action("keyframe"), action("keep_pose"), action("reset"), action("refine_cage"), nullptr};
  } else {
    entries += {action("generate_cage"), action("bind_model"), nullptr};
  }
  entries += {action("frame_all"), action("search")};
  auto* menu = new QMenu(this);
  menu->setObjectName("view_menu");
  menu->setAttribute(Qt::WA_DeleteOnClose);
  for (QAction* entry : entries) {
    if (entry == nullptr) {
      menu->addSeparator();
    } else {
      menu->addAction(entry);
    }
  }
  menu->popup(viewport_->mapToGlobal(at));
}

void MainWindow::fold_panels() {
  line_dock_->hide();
  sections_dock_->hide();
  unfolded_.clear();
  unfold_panels();
}

/// What is empty takes no room. What the user closes stays closed.
void MainWindow::unfold_panels() {
  const auto unfold = [this](QDockWidget* dock) {
    if (unfolded_.insert(dock).second) {
      dock->show();
      dock->raise();
    }
  };
  const State& state = session_.document().state();
  if (state.stages) {
    unfold(sections_dock_);
  }
  if (!state.poses.empty() || !state.time_line.keys.empty()) {
    unfold(line_dock_);
  }
}

void MainWindow::reset_panels() {
  restoreState(first_layout_);
  fold_panels();
}

} // namespace cagewright::app
