/// \file
/// Poses: states of the cage with names.
#pragma once

#include "app/commands/editor.h"

#include <QWidget>

class QListWidget;
class QDoubleSpinBox;
class QPushButton;
class QSlider;

namespace cagewright::app {

class PosesPanel final : public QWidget {
  Q_OBJECT

public:
  explicit PosesPanel(Editor& editor, QWidget* parent = nullptr);

  /// Keeps the cage as it is as a pose with the next free name.
  void add_pose();

private:
  void update_list();
  void update_buttons();
  void update_blend();
  void make_mixer();
  void update_mixer();

  Editor& editor_;
  Document& document_;
  QListWidget* list_ = nullptr;
  QPushButton* add_ = nullptr;
  QPushButton* update_ = nullptr;
  QPushButton* apply_ = nullptr;
  QPushButton* remove_ = nullptr;
  QPushButton* reset_ = nullptr;
  QPushButton* compare_ = nullptr;
  QSlider* blend_ = nullptr;
  struct Share {
    QSlider* slider;
    QDoubleSpinBox* number;
  };
  QWidget* mixer_ = nullptr;
  std::vector<QString> mixed_; // the names that the mixer was made for
  std::vector<Share> shares_;
};

} // namespace cagewright::app
