/// \file
/// The window onto model and cage.
#pragma once

#include "app/commands/editor.h"

#include <QImage>
#include <QJsonObject>
#include <QOpenGLWidget>

namespace cagewright::app {

/// Draws the document and lets the mouse edit it.
class Viewport : public QOpenGLWidget {
  Q_OBJECT

public:
  explicit Viewport(Editor& editor, QWidget* parent = nullptr);

  /// front, back, left, right, top, bottom, three-quarter.
  void set_standard_view(const QString& name);
  void set_orthographic(bool orthographic);
  [[nodiscard]] bool orthographic() const;
  /// Brings everything, or only the selection, into view.
  void frame_all();
  void frame_selection();

  /// The camera, for the project file.
  [[nodiscard]] QJsonObject camera_state() const;
  void set_camera_state(const QJsonObject& state);

  /// The picture at any size, without gizmo and hints.
  [[nodiscard]] QImage picture(const QSize& size);

  void set_dark(bool dark);

Q_SIGNALS:
  void cameraChanged();
  void hint(const QString& text); ///< what the mouse would do here: for the status bar
};

} // namespace cagewright::app
