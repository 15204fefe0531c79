/// \file
/// What is selected, and its position in numbers.
#pragma once

#include "app/commands/editor.h"

#include <QWidget>

#include <array>

class QDoubleSpinBox;
class QLabel;
class QToolButton;

namespace cagewright::app {

class SelectionPanel final : public QWidget {
  Q_OBJECT

public:
  explicit SelectionPanel(Editor& editor, QWidget* parent = nullptr);

private:
  void update_selection();
  void move_to_typed();
  [[nodiscard]] Vec3 middle() const;

  Editor& editor_;
  Document& document_;
  QLabel* summary_ = nullptr;
  std::array<QToolButton*, 3> modes_ = {};
  std::array<QDoubleSpinBox*, 3> position_ = {};
  Vec3 shown_ = Vec3::Zero(); // what the fields say
};

} // namespace cagewright::app
