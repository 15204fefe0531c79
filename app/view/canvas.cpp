#include "app/view/canvas.h"

#include "app/view/canvas_shaders.h"
#include "core/parallel.h"
#include "render/gl.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
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
struct GlVertex {
  Vec3f position;
  Color color;
};

std::uint32_t packed_normal(const Vec3& n) { // 10 bits each, signed
  const auto bits = [](double c) {
    return static_cast<std::uint32_t>(std::lround(511 * std::clamp(c, -1.0, 1.0))) & 1023U;
  };
  return n.allFinite() ? bits(n.x()) | bits(n.y()) << 10U | bits(n.z()) << 20U : 0;
}

/// A buffer that is filled anew as often as needed.
class StreamBuffer {
public:
  template <class T> void fill(GLenum target, std::span<const T> data, GLenum usage) {
    if (buffer_.id() == 0) {
      GLuint id = 0;
      glGenBuffers(1, &id);
      buffer_ = gl::Buffer(id);
    }
    glBindBuffer(target, buffer_.id());
    glBufferData(target, static_cast<GLsizeiptr>(data.size_bytes()), data.data(), usage);
  }
  [[nodiscard]] GLuint id() const { return buffer_.id(); }

private:
  gl::Buffer buffer_;
};

gl::VertexArray make_array() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return gl::VertexArray(id);
}

void attribute(GLuint location, GLint size, GLenum type, std::size_t stride, std::size_t offset,
               bool per_instance = false) {
  glEnableVertexAttribArray(location);
  const bool normalized = type != GL_FLOAT;
  glVertexAttribPointer(location, size, type, normalized ? GL_TRUE : GL_FALSE,
                        static_cast<GLsizei>(stride), reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(location, per_instance ? 1 : 0);
}

class Uniforms {
public:
  explicit Uniforms(const gl::Program& program) : id_(program.id()) { glUseProgram(id_); }
  void set(const char* name, int value) const { glUniform1i(at(name), value); }
  void set(const char* name, double value) const {
    glUniform1f(at(name), static_cast<float>(value));
  }
  void set(const char* name, double x, double y) const {
    glUniform2f(at(name), static_cast<float>(x), static_cast<float>(y));
  }
  void set(const char* name, const Rgb& c) const { glUniform3f(at(name), c[0], c[1], c[2]); }
  void set(const char* name, const Rgb& c, float alpha) const {
    glUniform4f(at(name), c[0], c[1], c[2], alpha);
  }
  void set(const char* name, const Mat3& m) const {
    const Eigen::Matrix3f f = m.cast<float>();
    glUniformMatrix3fv(at(name), 1, GL_FALSE, f.data());
  }
  void set(const char* name, const Eigen::Matrix4d& m) const {
    const Eigen::Matrix4f f = m.cast<float>();
    glUniformMatrix4fv(at(name), 1, GL_FALSE, f.data());
  }

private:
  [[nodiscard]] GLint at(const char* name) const { return glGetUniformLocation(id_, name); }
  GLuint id_;
};

/// From logical pixels to clip coordinates.
Eigen::Matrix4d pixel_matrix(const CanvasView& view) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2 * view.pixel_ratio / view.width;
  m(0, 3) = -1;
  m(1, 1) = -2 * view.pixel_ratio / view.height;
  m(1, 3) = 1;
  m(3, 3) = 1;
  return m;
}

} // namespace

Color color_of(const Rgb& rgb, double opacity) {
  const auto byte = [](double c) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0, 1.0)));
  };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2]), byte(opacity)};
}

Color faded(Color color, double opacity) {
  color[3] = static_cast<std::uint8_t>(std::lround(color[3] * std::clamp(opacity, 0.0, 1.0)));
  return color;
}

struct Canvas::Gl {
  gl::Program background, model, wire, face, line, dot;

  gl::VertexArray empty = make_array();
  gl::VertexArray model_array = make_array();
  gl::VertexArray wire_array = make_array();
  StreamBuffer positions, normals, colors, triangles, edges;
  GLsizei triangle_corners = 0;
  GLsizei edge_ends = 0;
  bool has_edges = false;
  bool has_colors = false;
  std::vector<Triangle> kept_triangles; // for the edges, when they are asked for
  std::vector<Vec3f> position_floats;
  std::vector<std::uint32_t> normal_bits;

  gl::VertexArray line_array = make_array();
  gl::VertexArray dot_array = make_array();
  gl::VertexArray face_array = make_array();
  StreamBuffer lines, dots, faces;

  void make_edges();
  void draw_lines(std::span<const GlLine> list, const CanvasView& view, const Eigen::Matrix4d& clip,
                  double hidden, bool on_top);
  void draw_dots(std::span<const GlDot> list, const CanvasView& view, const Eigen::Matrix4d& clip,
                 double hidden, bool on_top);
  void draw_faces(std::span<const GlVertex> list, const CanvasView& view,
                  const Eigen::Matrix4d& clip, int kind);
};

Canvas::Canvas(std::unique_ptr<Gl> gl) : gl_(std::move(gl)) {}
Canvas::~Canvas() = default;

Result<std::unique_ptr<Canvas>> Canvas::create() {
  auto gl = std::make_unique<Gl>();
  using namespace shaders;
  const std::string lighting = light;
  const struct {
    gl::Program& program;
    std::string vertex, fragment;
  } sources[] = {
      {gl->background, background_vertex, background_fragment},
      {gl->model, model_vertex, lighting + model_fragment},
      {gl->wire, wire_vertex, wire_fragment},
      {gl->face, face_vertex, lighting + face_fragment},
      {gl->line, line_vertex, line_fragment},
      {gl->dot, dot_vertex, dot_fragment},
  };
  for (const auto& source : sources) {
    Result<gl::Program> made = gl::make_program(source.vertex, source.fragment);
    if (!made) {
      return made.error();
    }
    source.program = std::move(*made);
  }
  return std::unique_ptr<Canvas>(new Canvas(std::move(gl)));
}

void Canvas::set_frame(const Vec3& center, double scale) {
  center_ = center;
  scale_ = scale;
}

// ---------------------------------------------------------------- the model

void Canvas::set_model(std::span<const Vec3> positions, std::span<const Vec3> normals,
                       std::span<const Triangle> triangles) {
  Gl& gl = *gl_;
  gl.kept_triangles.assign(triangles.begin(), triangles.end());
  gl.triangle_corners = static_cast<GLsizei>(3 * triangles.size());
  gl.has_edges = false;
  gl.has_colors = false;
  glBindVertexArray(gl.model_array.id());
  gl.triangles.fill(GL_ELEMENT_ARRAY_BUFFER, triangles, GL_STATIC_DRAW);
  move_model(positions, normals);
  glBindVertexArray(0);
}

void Canvas::move_model(std::span<const Vec3> positions, std::span<const Vec3> normals) {
  Gl& gl = *gl_;
  gl.position_floats.resize(positions.size());
  gl.normal_bits.resize(positions.size());
  parallel_for(0, positions.size(), 8192, [&](std::size_t i) {
    gl.position_floats[i] = ((positions[i] - center_) * scale_).cast<float>();
    gl.normal_bits[i] = i < normals.size() ? packed_normal(normals[i]) : 0;
  });
  glBindVertexArray(gl.model_array.id());
  gl.positions.fill(GL_ARRAY_BUFFER, std::span<const Vec3f>(gl.position_floats), GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(Vec3f), 0);
  gl.normals.fill(GL_ARRAY_BUFFER, std::span<const std::uint32_t>(gl.normal_bits), GL_STREAM_DRAW);
  attribute(1, 4, GL_INT_2_10_10_10_REV, 4, 0);
  glBindVertexArray(0);
}

void Canvas::set_model_colors(std::span<const Color> colors) {
  Gl& gl = *gl_;
  gl.has_colors = !colors.empty() && colors.size() == gl.position_floats.size();
  glBindVertexArray(gl.model_array.id());
  if (gl.has_colors) {
    gl.colors.fill(GL_ARRAY_BUFFER, colors, GL_STREAM_DRAW);
    attribute(2, 4, GL_UNSIGNED_BYTE, sizeof(Color), 0);
  } else {
    glDisableVertexAttribArray(2);
  }
  glBindVertexArray(0);
}

void Canvas::Gl::make_edges() {
  std::vector<std::uint64_t> keys;
  keys.reserve(3 * kept_triangles.size());
  for (const Triangle& t : kept_triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index a = t[k];
      const Index b = t[(k + 1) % 3];
      keys.push_back(std::uint64_t{std::min(a, b)} << 32U | std::max(a, b));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  std::vector<Index> ends;
  ends.reserve(2 * keys.size());
  for (const std::uint64_t key : keys) {
    ends.push_back(static_cast<Index>(key >> 32U));
    ends.push_back(static_cast<Index>(key));
  }
  glBindVertexArray(wire_array.id());
  edges.fill(GL_ELEMENT_ARRAY_BUFFER, std::span<const Index>(ends), GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, positions.id());
  attribute(0, 3, GL_FLOAT, sizeof(Vec3f), 0);
  glBindVertexArray(0);
  edge_ends = static_cast<GLsizei>(ends.size());
  has_edges = true;
}

// ---------------------------------------------------------------- marks

void Canvas::Gl::draw_lines(std::span<const GlLine> list, const CanvasView& view,
                            const Eigen::Matrix4d& clip, double hidden, bool on_top) {
  if (list.empty()) {
    return;
  }
  glBindVertexArray(line_array.id());
  lines.fill(GL_ARRAY_BUFFER, list, GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, begin), true);
  attribute(1, 3, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, end), true);
  attribute(2, 4, GL_UNSIGNED_BYTE, sizeof(GlLine), offsetof(GlLine, color), true);
  attribute(3, 1, GL_FLOAT, sizeof(GlLine), offsetof(GlLine, width), true);
  const Uniforms uniforms(line);
  uniforms.set("clip", clip);
  uniforms.set("frame", view.width, view.height);
  uniforms.set("pixel_ratio", view.pixel_ratio);
  uniforms.set("bias", on_top ? 0.0 : 1e-4);
  const auto count = static_cast<GLsizei>(list.size());
  if (hidden > 0 && !on_top) {
    glDepthFunc(GL_GREATER);
    uniforms.set("strength", hidden);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
  }
  glDepthFunc(on_top ? GL_ALWAYS : GL_LEQUAL);
  uniforms.set("strength", 1.0);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

void Canvas::Gl::draw_dots(std::span<const GlDot> list, const CanvasView& view,
                           const Eigen::Matrix4d& clip, double hidden, bool on_top) {
  if (list.empty()) {
    return;
  }
  glBindVertexArray(dot_array.id());
  dots.fill(GL_ARRAY_BUFFER, list, GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlDot), offsetof(GlDot, position), true);
  attribute(1, 4, GL_UNSIGNED_BYTE, sizeof(GlDot), offsetof(GlDot, color), true);
  attribute(2, 1, GL_FLOAT, sizeof(GlDot), offsetof(GlDot, radius), true);
  const Uniforms uniforms(dot);
  uniforms.set("clip", clip);
  uniforms.set("frame", view.width, view.height);
  uniforms.set("pixel_ratio", view.pixel_ratio);
  uniforms.set("bias", on_top ? 0.0 : 2e-4);
  const auto count = static_cast<GLsizei>(list.size());
  if (hidden > 0 && !on_top) {
    glDepthFunc(GL_GREATER);
    uniforms.set("strength", hidden);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
  }
  glDepthFunc(on_top ? GL_ALWAYS : GL_LEQUAL);
  uniforms.set("strength", 1.0);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, count);
}

void Canvas::Gl::draw_faces(std::span<const GlVertex> list, const CanvasView& view,
                            const Eigen::Matrix4d& clip, int kind) {
  if (list.empty()) {
    return;
  }
  glBindVertexArray(face_array.id());
  faces.fill(GL_ARRAY_BUFFER, list, GL_STREAM_DRAW);
  attribute(0, 3, GL_FLOAT, sizeof(GlVertex), offsetof(GlVertex, position));
  attribute(1, 4, GL_UNSIGNED_BYTE, sizeof(GlVertex), offsetof(GlVertex, color));
  const Uniforms uniforms(face);
  uniforms.set("clip", clip);
  uniforms.set("axes", view.axes);
  uniforms.set("kind", kind);
  glDepthFunc(kind == 2 ? GL_ALWAYS : GL_LEQUAL);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(list.size()));
}

// ---------------------------------------------------------------- a picture

void Canvas::draw(const CanvasView& view, const Marks& marks, const Overlay& overlay) {
  Gl& gl = *gl_;
  const auto in_space = [&](const Vec3& p) -> Vec3f {
    return ((p - center_) * scale_).cast<float>();
  };
  const auto on_screen = [](const Vec3& p) -> Vec3f { return p.cast<float>(); };
  const auto to_lines = [](const std::vector<LineMark>& list, const auto& place) {
    std::vector<GlLine> result;
    result.reserve(list.size());
    for (const LineMark& l : list) {
      result.push_back({place(l.begin), place(l.end), l.color, l.width});
    }
    return result;
  };
  const auto to_dots = [](const std::vector<DotMark>& list, const auto& place) {
    std::vector<GlDot> result;
    result.reserve(list.size());
    for (const DotMark& d : list) {
      result.push_back({place(d.position), d.color, d.radius});
    }
    return result;
  };
  const auto to_faces = [](const std::vector<FaceMark>& list, const auto& place) {
    std::vector<GlVertex> result;
    result.reserve(3 * list.size());
    for (const FaceMark& f : list) {
      for (int k = 0; k < 3; ++k) {
        result.push_back({place(f.corners[k]), f.colors[k]});
      }
    }
    return result;
  };

  glViewport(0, 0, view.width, view.height);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearDepth(1);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_DEPTH_TEST);
  {
    const Uniforms uniforms(gl.background);
    uniforms.set("top", view.background_top);
    uniforms.set("bottom", view.background_bottom);
    glBindVertexArray(gl.empty.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  if (view.model && gl.triangle_corners > 0) {
    const Uniforms uniforms(gl.model);
    uniforms.set("clip", view.clip);
    uniforms.set("axes", view.axes);
    uniforms.set("one_color", view.model_color, gl.has_colors ? 0.0F : 1.0F);
    uniforms.set("smooth_normals", view.smooth ? 1 : 0);
    glBindVertexArray(gl.model_array.id());
    glDrawElements(GL_TRIANGLES, gl.triangle_corners, GL_UNSIGNED_INT, nullptr);
  }
  gl.draw_faces(to_faces(marks.solids, in_space), view, view.clip, 0);

  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  if (view.wireframe && view.model && gl.triangle_corners > 0) {
    if (!gl.has_edges) {
      gl.make_edges();
    }
    const Uniforms uniforms(gl.wire);
    uniforms.set("clip", view.clip);
    const float alpha = 0.45F;
    const Rgb& c = view.wire_color;
    uniforms.set("one_color", Rgb{c[0] * alpha, c[1] * alpha, c[2] * alpha}, alpha);
    glBindVertexArray(gl.wire_array.id());
    glDrawElements(GL_LINES, gl.edge_ends, GL_UNSIGNED_INT, nullptr);
  }
  gl.draw_lines(to_lines(marks.ground, in_space), view, view.clip, 0, false);

  // From the farthest to the nearest.
  std::vector<std::pair<double, const FaceMark*>> order;
  const Vec3 backward = view.axes.row(2);
  for (const FaceMark& f : marks.faces) {
    order.emplace_back(backward.dot((f.corners[0] - center_) + (f.corners[1] - center_) +
                                    (f.corners[2] - center_)),
                       &f);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FaceMark> sorted;
  sorted.reserve(order.size());
  for (const auto& [depth, f] : order) {
    sorted.push_back(*f);
  }
  gl.draw_faces(to_faces(sorted, in_space), view, view.clip, 1);
  const double hidden = view.model ? view.model_opacity_behind : 0;
  gl.draw_lines(to_lines(marks.lines, in_space), view, view.clip, hidden, false);
  gl.draw_dots(to_dots(marks.dots, in_space), view, view.clip, hidden, false);

  const Eigen::Matrix4d pixels = pixel_matrix(view);
  gl.draw_faces(to_faces(overlay.faces, on_screen), view, pixels, 2);
  gl.draw_lines(to_lines(overlay.lines, on_screen), view, pixels, 0, true);
  gl.draw_dots(to_dots(overlay.dots, on_screen), view, pixels, 0, true);

  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glUseProgram(0);
}

} // namespace cagewright::app
