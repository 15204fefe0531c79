/// \file
/// The tools, and how they behave.
#pragma once

#include "app/document/document.h"

#include <QToolBar>

class QActionGroup;
class QComboBox;
class QDoubleSpinBox;

namespace cagewright::app {

class ToolBar final : public QToolBar {
  Q_OBJECT

public:
  explicit ToolBar(Document& document, QWidget* parent = nullptr);

  /// The actions, for the menu.
  [[nodiscard]] QActionGroup* tools() const { return tools_; }
  [[nodiscard]] const QList<QAction*>& switches() const { return switches_; }

private:
  void update_tools();
  template <class Set> void change(const Set& set);

  Document& document_;
  QActionGroup* tools_ = nullptr;
  QList<QAction*> switches_;
  QComboBox* axes_ = nullptr;
  QComboBox* mirror_ = nullptr;
  QDoubleSpinBox* step_ = nullptr;
  QDoubleSpinBox* radius_ = nullptr;
};

} // namespace cagewright::app
