/// \file
/// The window: only wiring.
#pragma once

#include "app/commands/cage_actions.h"
#include "app/preferences.h"
#include "app/recovery.h"
#include "app/session.h"
#include "app/view/key_map.h"

#include <QDir>
#include <QMainWindow>
#include <QTimer>

#include <functional>
#include <map>
#include <memory>
#include <set>

class QDockWidget;
class QKeyEvent;
class QLabel;
class QMenu;
class QProgressBar;
class QToolButton;

namespace cagewright::app {

class GeneratePanel;
class GuideBar;
class LayersPanel;
class PosesPanel;
class SectionsPanel;
class TimeLinePanel;
enum class Sample;
class ToolBar;
class Viewport;
class WelcomePage;

class MainWindow final : public QMainWindow {
  Q_OBJECT

public:
  /// \param recovery_folder  where work is kept aside
  explicit MainWindow(const QDir& recovery_folder, QWidget* parent = nullptr);
  ~MainWindow() override;

  [[nodiscard]] Session& session() { return session_; }
  [[nodiscard]] Viewport& viewport() { return *viewport_; }

  /// Opens a project, or a model and perhaps a cage.
  void open(const QString& path, const QString& cage = {});
  /// Asks whether to go on with work that a crash left, if there is any.
  void offer_recovery();

protected:
  void closeEvent(QCloseEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void make_panels();
  void make_menus();
  void make_status_bar();
  void connect_session();

  QAction* add(QMenu* menu, const char* name, const QString& text, const QKeySequence& keys,
               const QString& tip, const std::function<void()>& act);
  /// The same with a key of one letter, that only counts while the view has the keyboard.
  QAction* add_in_view(QMenu* menu, const char* name, const QString& text, const QKeySequence& keys,
                       const QString& tip, const std::function<void()>& act);
  void make_file_menu();
  void add_action(QMenu* menu, CageAction action, const QString& text, const QKeySequence& keys,
                  const QString& tip);
  void make_edit_menu();
  void make_select_menu(QMenu* menu);
  void make_view_menu();
  void make_cage_menu();
  void make_pose_menu();
  void make_help_menu();

  void choose_model();
  void open_sample(Sample sample);
  void choose_cage();
  QString ask_for_model(const QString& title);
  bool save();
  bool save_as();
  void choose_export(const QString& title, const QString& name, const QString& filter,
                     const std::function<void(const std::filesystem::path&)>& write);
  [[nodiscard]] QString model_filter(bool all) const;
  [[nodiscard]] QString suggested(const QString& suffix, const QString& extension) const;
  /// For the file dialogs that models are written by.
  [[nodiscard]] QString export_filter() const;
  void export_model();
  void export_image();
  /// Whether what is open may be replaced: saved, or not worth it.
  bool may_discard();
  void show_error(const QString& title, const QString& text);
  /// The cage that is to be bound is no valid one: says what is wrong, and offers what helps.
  void ask_about_binding(const BindingDoubts& doubts);
  /// Selects what is wrong, and brings it into view.
  void show_violation(const Violation& violation);
  void show_recent();
  void update_title();
  void update_actions();
  void apply(const Preferences& preferences);
  void show_first_steps();
  void show_keys();
  /// Finds a command by its name.
  void search_command();
  /// Everything that stands in a menu, with its key.
  [[nodiscard]] QList<QAction*> commands() const;
  /// What can be done with what is under the pointer.
  void show_view_menu(const QPoint& at);
  void cycle_shading();
  void apply_key_map(KeyMap map);
  /// The view alone, without panels, and back.
  void toggle_full_view();
  /// Says in the view why something was refused there.
  void show_notice(const QString& text);
  void reset_panels();
  /// Hides the panels that have nothing to show yet.
  void fold_panels();
  void unfold_panels();
  [[nodiscard]] bool is_for_view(const QWidget* focus, const QKeyEvent& key) const;

  Session session_;
  Preferences preferences_;
  Recovery recovery_;
  Viewport* viewport_ = nullptr;
  WelcomePage* welcome_ = nullptr;
  GuideBar* guide_ = nullptr;
  ToolBar* tools_ = nullptr;
  GeneratePanel* generate_ = nullptr;
  LayersPanel* layers_ = nullptr;
  PosesPanel* poses_ = nullptr;
  TimeLinePanel* time_line_ = nullptr;
  SectionsPanel* sections_ = nullptr;
  QDockWidget* line_dock_ = nullptr;
  QDockWidget* sections_dock_ = nullptr;
  std::set<QDockWidget*> unfolded_;
  QMenu* panels_menu_ = nullptr;
  QMenu* recent_ = nullptr;
  QLabel* mode_ = nullptr;
  QLabel* step_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QToolButton* cancel_ = nullptr;
  QByteArray first_layout_;
  bool passes_on_key_ = false;                        ///< to the view
  bool fills_screen_ = false;                         ///< as soon as it is shown
  bool clicked_focus_ = false;                        ///< it came by a click, not by keys
  std::map<QString, QList<QKeySequence>> usual_keys_; ///< of commands, in the usual key map
  QByteArray layout_before_full_view_;
  bool guide_before_full_view_ = false;
  QLabel* notice_ = nullptr;
  QTimer notice_timer_;
  struct Need {
    QAction* action;
    std::function<bool()> met;
  };
  std::vector<Need> needs_;
};

} // namespace cagewright::app
