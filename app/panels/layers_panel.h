/// \file
/// What the viewport shows.
#pragma once

#include "app/session.h"

#include <QWidget>

#include <vector>

class QCheckBox;
class QComboBox;
class QLabel;
class QSlider;
class QVBoxLayout;

namespace cagewright::app {

class LayersPanel final : public QWidget {
  Q_OBJECT

public:
  explicit LayersPanel(Session& session, QWidget* parent = nullptr);

  /// Shows the boxes one cut deeper, or one less deep.
  void step_depth(int by);

private:
  struct Switch {
    QCheckBox* box;
    bool Layers::*value;
  };

  void add_looks(QVBoxLayout* layout);
  void update_switches();
  void update_depth();
  void ensure_stages();

  Session& session_;
  std::vector<Switch> switches_;
  QComboBox* look_ = nullptr;
  QSlider* depth_ = nullptr;
  QLabel* depth_text_ = nullptr;
};

} // namespace cagewright::app
