/// \file
/// Draws lines, dots and faces. Private to canvas.cpp.
#pragma once

#include "app/view/canvas.h"
#include "app/view/gl_stream.h"

#include <functional>
#include <vector>

namespace cagewright::app {

/// How marks come to the screen.
struct MarkView {
  Eigen::Matrix4d clip; ///< from what `place` returns to clip coordinates
  std::function<Eigen::Vector3f(const Vec3&)> place;
  double hidden = 0;   ///< strength of what lies behind the depth that is drawn
  bool on_top = false; ///< whatever the depth
};

/// What faces look like; the numbers are those of the shader.
enum class FaceLook { lit = 0, glass = 1, plain = 2 };

class MarkPainter {
public:
  /// Errors: not_available, when the driver refuses a shader.
  static Result<MarkPainter> create();

  void draw(const std::vector<LineMark>& lines, const CanvasView& view, const MarkView& how);
  void draw(const std::vector<DotMark>& dots, const CanvasView& view, const MarkView& how);
  void draw(const std::vector<FaceMark>& faces, const CanvasView& view, const MarkView& how,
            FaceLook look);

private:
  void draw_strips(const gl::Program& program, const CanvasView& view, const MarkView& how,
                   double bias, std::size_t count) const;

  gl::Program face_, line_, dot_;
  gl::VertexArray face_array_, line_array_, dot_array_;
  StreamBuffer faces_, lines_, dots_;
};

} // namespace cagewright::app
