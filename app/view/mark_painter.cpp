#include "app/view/mark_painter.h"

#include "app/view/canvas_shaders.h"

#include <cstddef>
#include <string>
#include <utility>

namespace cagewright::app {
namespace {

using Vec3f = Eigen::Vector3f;

struct GlLine {
  Vec3f begin, end;
  Color color;
  float width;
};
struct GlDot {
  Vec3f position;
  Color color;
  float radius;
};
struct GlCorner {
  Vec3f position;
  Color color;
};

} // namespace

Result<MarkPainter> MarkPainter::create() {
  using namespace shaders;
  MarkPainter painter;
  const struct {
    gl::Program& program;
    std::string vertex, fragment;
  } sources[] = {{painter.face_, face_vertex, std::string(light) + face_fragment},
                 {painter.line_, line_vertex, line_fragment},
                 {painter.dot_, dot_vertex, dot_fragment}};
  for (const auto& source : sources) {
    Result<gl::Program> made = gl::make_program(source.vertex, source.fragment);
    if (!made) {
      return made.error();
    }
    source.program = std::move(*made);
  }
  painter.face_array_ = make_array();
  painter.line_array_ = make_array();
  painter.dot_array_ = make_array();
  return painter;
}

/// The elements of the vertex array that is bound, each a strip of four corners.
void MarkPainter::draw_strips(const gl::Program& program, const CanvasView& view,
                              const MarkView& how, double bias, std::size_t count) const {
  const Uniforms uniforms(program);
  uniforms.set("clip", how.clip);
  uniforms.set("frame", view.width, view.height);
  uniforms.set("pixel_ratio", view.pixel_ratio);
  uniforms.set("bias", how.on_top ? 0.0 : bias);
  const auto strips = static_cast<GLsizei>(count);
  if (how.hidden > 0 && !how.on_top) {
    glDepthFunc(GL_GREATER);
    uniforms.set("strength", how.hidden);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, strips);
  }
  glDepthFunc(how.on_top ? GL_ALWAYS : GL_LEQUAL);
  uniforms.set("strength", 1.0);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, strips);
}

void MarkPainter::draw(const std::vector<LineMark>& lines, const CanvasView& view,
                       const MarkView& how) {
  if (lines.empty()) {
    return;
  }
  std::vector<GlLine> list;
  list.reserve(lines.size());
  for (const LineMark& l : lines) {
    list.push_back({how.place(l.begin), how.place(l.end), l.color, l.width});
  }
  glBindVertexArray(line_array_.id());
  lines_.fill(GL_ARRAY_BUFFER, std::span<const GlLine>(list), GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, begin), true);
  attribute(1, 3, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, end), true);
  attribute(2, 4, GL_UNSIGNED_BYTE, sizeof(GlLine), offsetof(GlLine, color), true);
  attribute(3, 1, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, width), true);
  draw_strips(line_, view, how, 1e-4, list.size());
}

void MarkPainter::draw(const std::vector<DotMark>& dots, const CanvasView& view,
                       const MarkView& how) {
  if (dots.empty()) {
    return;
  }
  std::vector<GlDot> list;
  list.reserve(dots.size());
  for (const DotMark& d : dots) {
    list.push_back({how.place(d.position), d.color, d.radius});
  }
  glBindVertexArray(dot_array_.id());
  dots_.fill(GL_ARRAY_BUFFER, std::span<const GlDot>(list), GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlDot), offsetof(GlDot, position), true);
  attribute(1, 4, GL_UNSIGNED_BYTE, sizeof(GlDot), offsetof(GlDot, color), true);
  attribute(2, 1, GL_FLOAT, sizeof(GlDot), offsetof(GlDot, radius), true);
  draw_strips(dot_, view, how, 2e-4, list.size());
}

void MarkPainter::draw(const std::vector<FaceMark>& faces, const CanvasView& view,
                       const MarkView& how, FaceLook look) {
  if (faces.empty()) {
    return;
  }
  std::vector<GlCorner> list;
  list.reserve(3 * faces.size());
  for (const FaceMark& f : faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      list.push_back({how.place(f.corners[k]), f.colors[k]});
    }
  }
  glBindVertexArray(face_array_.id());
  faces_.fill(GL_ARRAY_BUFFER, std::span<const GlCorner>(list), GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlCorner), offsetof(GlCorner, position));
  attribute(1, 4, GL_UNSIGNED_BYTE, sizeof(GlCorner), offsetof(GlCorner, color));
  const Uniforms uniforms(face_);
  uniforms.set("clip", how.clip);
  uniforms.set("axes", view.axes);
  uniforms.set("kind", static_cast<int>(look));
  glDepthFunc(how.on_top ? GL_ALWAYS : GL_LEQUAL);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(list.size()));
}

} // namespace cagewright::app
