#include "app/view/viewport.h"

namespace cagewright::app {

Viewport::Viewport(Editor& /*editor*/, QWidget* parent) : QOpenGLWidget(parent) {}

void Viewport::set_standard_view(const QString& /*name*/) {}
void Viewport::set_orthographic(bool /*orthographic*/) {}
bool Viewport::orthographic() const {
  return false;
}
void Viewport::frame_all() {}
void Viewport::frame_selection() {}
QJsonObject Viewport::camera_state() const {
  return {};
}
void Viewport::set_camera_state(const QJsonObject& /*state*/) {}
QImage Viewport::picture(const QSize& size) {
  return QImage(size, QImage::Format_RGB32);
}
void Viewport::set_dark(bool /*dark*/) {}

} // namespace cagewright::app
