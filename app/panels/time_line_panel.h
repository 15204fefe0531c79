/// \file
/// Keyframes, and playing what lies between them.
#pragma once

#include "app/commands/editor.h"

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>

class QDoubleSpinBox;
class QSpinBox;
class QToolButton;

namespace cagewright::app {

/// The frames from first to last, the keyframes on them, and where it is now: click or drag to go
/// there, arrow keys go frame by frame.
class TimeRuler final : public QWidget {
  Q_OBJECT

public:
  explicit TimeRuler(Document& document, QWidget* parent = nullptr);
  [[nodiscard]] QSize sizeHint() const override { return {320, 44}; }
  [[nodiscard]] QSize minimumSizeHint() const override { return {120, 40}; }

  /// The frame it stands at, whole.
  [[nodiscard]] int frame() const;
  [[nodiscard]] double x_of(double frame) const;

Q_SIGNALS:
  void frameChosen(int frame);

protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

private:
  void choose(double x);

  Document& document_;
};

class TimeLinePanel final : public QWidget {
  Q_OBJECT

public:
  explicit TimeLinePanel(Editor& editor, QWidget* parent = nullptr);

  void set_keyframe();
  void toggle_playing();
  [[nodiscard]] bool playing() const { return timer_.isActive(); }

private:
  void update_line();
  void go_to(int frame);
  void next_frame();

  Editor& editor_;
  Document& document_;
  TimeRuler* ruler_ = nullptr;
  QToolButton* play_ = nullptr;
  QToolButton* set_ = nullptr;
  QToolButton* remove_ = nullptr;
  QSpinBox* frame_ = nullptr;
  QSpinBox* first_ = nullptr;
  QSpinBox* last_ = nullptr;
  QDoubleSpinBox* rate_ = nullptr;
  QTimer timer_;
  QElapsedTimer clock_;
  double start_ = 1;
};

} // namespace cagewright::app
