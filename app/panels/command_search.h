/// \file
/// Any command, found by a part of its name.
#pragma once

#include <QDialog>
#include <QList>

class QAction;
class QLineEdit;
class QListWidget;

namespace cagewright::app {

/// Lists what can be done now; typing narrows it down, Enter or a click does it.
class CommandSearch final : public QDialog {
  Q_OBJECT

public:
  explicit CommandSearch(const QList<QAction*>& commands, QWidget* parent = nullptr);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  void update_list();
  void run();

  QList<QAction*> commands_;
  QList<QAction*> shown_; // of the rows
  QLineEdit* text_ = nullptr;
  QListWidget* list_ = nullptr;
};

/// What stands in the menu, without the underlined letter and the dots.
QString plain_text(const QAction& action);

/// Of an action: the title of the menu that it stands in.
inline constexpr const char* menu_property = "menu_title";
/// The same with its menu, without which "All" or "Back" says little.
QString full_name(const QAction& action);

} // namespace cagewright::app
