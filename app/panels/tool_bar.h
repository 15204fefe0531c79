/// \file
/// The tools, and how they behave.
#pragma once

#include "app/document/document.h"

#include <QToolBar>

#include <vector>

class QActionGroup;
class QDoubleSpinBox;
class QMenu;
class QToolButton;

namespace cagewright::app {

class ToolBar final : public QToolBar {
  Q_OBJECT

public:
  explicit ToolBar(Document& document, QWidget* parent = nullptr);

  /// Adds all that the tool bar has to a menu: tools, switches, and what there is to choose.
  void add_to(QMenu* menu) const;

private:
  /// One of several, as a button that opens a menu.
  struct Choice {
    QToolButton* button;
    QMenu* menu;
    QActionGroup* entries;
    int (*chosen)(const ToolSettings&);
  };

  void add_tools();
  void add_switch(std::size_t number);
  void add_choice(std::size_t number);
  QDoubleSpinBox* add_number(const char* name, double least, double most, double step, int decimals,
                             const QString& help);
  void update_tools();
  template <class Set> void change(const Set& set);

  Document& document_;
  QActionGroup* tools_ = nullptr;
  QList<QAction*> switches_;
  std::vector<Choice> choices_;
  QDoubleSpinBox* step_ = nullptr; ///< of snapping, for the tool that is chosen
  QDoubleSpinBox* radius_ = nullptr;
};

} // namespace cagewright::app
