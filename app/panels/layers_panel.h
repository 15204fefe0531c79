/// \file
/// What the viewport shows.
#pragma once

#include "app/session.h"

#include <QWidget>

#include <vector>

class QAction;
class QActionGroup;
class QCheckBox;
class QComboBox;
class QLabel;
class QMenu;
class QSlider;
class QVBoxLayout;

namespace cagewright::app {

class LayersPanel final : public QWidget {
  Q_OBJECT

public:
  explicit LayersPanel(Session& session, QWidget* parent = nullptr);

  /// Shows the boxes one cut deeper, or one less deep.
  void step_depth(int by);
  /// The same switches, by the names of their groups, and the looks.
  void add_to(QMenu* menu);

private:
  struct Switch {
    QCheckBox* box;
    bool Layers::*value;
    QAction* command = nullptr; ///< the same in a menu
  };

  void add_looks(QVBoxLayout* layout);
  void set_layer(bool Layers::*value, bool on);
  void set_look(int look);
  void update_switches();
  void update_depth();
  void ensure_stages();

  Session& session_;
  std::vector<Switch> switches_;
  QComboBox* look_ = nullptr;
  QActionGroup* look_commands_ = nullptr;
  QSlider* depth_ = nullptr;
  QLabel* depth_text_ = nullptr;
};

} // namespace cagewright::app
