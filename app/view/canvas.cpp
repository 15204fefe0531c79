#include "app/view/canvas.h"

#include "app/view/canvas_shaders.h"
#include "app/view/fine_picture.h"
#include "app/view/kept_picture.h"
#include "app/view/mark_painter.h"
#include "app/view/model_painter.h"
#include "core/parallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace cagewright::app {
namespace {

// The time that pictures of smaller models take is of no interest.
constexpr std::size_t large_model = 100000;
// A picture that takes longer is not made finer: the window would not answer meanwhile. Seconds.
constexpr double slow_sample = 0.06;
// Shade in corners: how dark, and from how far, in radii of the scene.
constexpr double shade_strength = 1.5;
constexpr double shade_radius = 0.14;

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

/// From the farthest to the nearest.
std::vector<FaceMark> sorted_by_depth(const std::vector<FaceMark>& faces, const Vec3& center,
                                      const Vec3& backward) {
  std::vector<std::pair<double, const FaceMark*>> order;
  order.reserve(faces.size());
  for (const FaceMark& f : faces) {
    const Vec3 sum = (f.corners[0] - center) + (f.corners[1] - center) + (f.corners[2] - center);
    order.emplace_back(backward.dot(sum), &f);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FaceMark> sorted;
  sorted.reserve(order.size());
  for (const auto& [depth, f] : order) {
    sorted.push_back(*f);
  }
  return sorted;
}

/// Whether the model looks the same in both.
bool same_picture(const CanvasView& a, const CanvasView& b) {
  return a.clip == b.clip && a.axes == b.axes && a.width == b.width && a.height == b.height &&
         a.model == b.model && a.smooth == b.smooth && a.wireframe == b.wireframe &&
         a.look == b.look && a.occlusion == b.occlusion && a.coarse == b.coarse &&
         a.background_top == b.background_top && a.background_bottom == b.background_bottom &&
         a.model_color == b.model_color && a.wire_color == b.wire_color;
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
  gl::Program background;
  gl::VertexArray empty = make_array();
  ModelPainter model;
  MarkPainter marks;
  std::vector<FaceMark> solids;

  KeptPicture kept;
  std::optional<CanvasView> kept_view; // of which it is the picture
  bool can_keep = true;
  FinePicture fine; // of kept_view
  bool can_refine = true;
  double sample_seconds = 0;
};

Canvas::Canvas(std::unique_ptr<Gl> gl) : gl_(std::move(gl)) {}
Canvas::~Canvas() = default;

Result<std::unique_ptr<Canvas>> Canvas::create() {
  Result<gl::Program> background =
      gl::make_program(shaders::background_vertex, shaders::background_fragment);
  if (!background) {
    return background.error();
  }
  Result<ModelPainter> model = ModelPainter::create();
  if (!model) {
    return model.error();
  }
  Result<MarkPainter> marks = MarkPainter::create();
  if (!marks) {
    return marks.error();
  }
  Result<FinePicture> fine = FinePicture::create();
  if (!fine) {
    return fine.error();
  }
  auto gl = std::make_unique<Gl>();
  gl->fine = std::move(*fine);
  gl->background = std::move(*background);
  gl->model = std::move(*model);
  gl->marks = std::move(*marks);
  return std::unique_ptr<Canvas>(new Canvas(std::move(gl)));
}

void Canvas::set_frame(const Vec3& center, double scale) {
  center_ = center;
  scale_ = scale;
  gl_->kept_view.reset();
}

void Canvas::set_model(std::span<const Vec3> positions, std::span<const Vec3> normals,
                       std::span<const Triangle> triangles, std::span<const Triangle> coarse) {
  gl_->model.set_triangles(triangles, coarse);
  move_model(positions, normals);
}

void Canvas::move_model(std::span<const Vec3> positions, std::span<const Vec3> normals) {
  std::vector<Eigen::Vector3f> placed(positions.size());
  parallel_for(0, positions.size(), 8192, [&](std::size_t i) {
    placed[i] = ((positions[i] - center_) * scale_).cast<float>();
  });
  gl_->model.move(std::move(placed), normals);
  gl_->kept_view.reset();
}

void Canvas::set_model_colors(std::span<const Color> colors) {
  gl_->model.set_colors(colors);
  gl_->kept_view.reset();
}

void Canvas::set_model_texture(std::span<const std::array<float, 2>> points,
                               std::span<const std::array<float, 4>> places,
                               const Picture& picture) {
  gl_->model.set_texture(points, places, picture);
  gl_->kept_view.reset();
}

void Canvas::set_solids(std::vector<FaceMark> solids) {
  gl_->solids = std::move(solids);
  gl_->kept_view.reset();
}

// ---------------------------------------------------------------- a picture

void Canvas::draw_model(const CanvasView& view) {
  Gl& gl = *gl_;
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
  const bool shows_model = view.model && !gl.model.empty();
  if (shows_model) {
    gl.model.draw(view);
  }
  gl.marks.draw(gl.solids, view, in_space(view), FaceLook::lit);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  if (shows_model && view.wireframe && !view.coarse) {
    gl.model.draw_wireframe(view);
  }
}

/// Draws the model, or copies its last picture.
void Canvas::draw_or_copy_model(const CanvasView& view) {
  Gl& gl = *gl_;
  if (!gl.can_keep || !view.keep) {
    draw_model(view);
    return;
  }
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  const auto framebuffer = static_cast<GLuint>(target);
  if (!gl.kept_view || !same_picture(*gl.kept_view, view)) {
    const auto start = std::chrono::steady_clock::now();
    if (!gl.kept.bind(view.width, view.height)) {
      gl.can_keep = false;
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
      draw_model(view);
      return;
    }
    draw_model(view);
    glFinish(); // to know how long it takes
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (!view.coarse && view.model) {
      model_seconds_ = gl.model.triangle_count() < large_model ? 0 : time.count();
    }
    gl.sample_seconds = time.count();
    gl.kept_view = view;
    gl.fine.restart();
  } else if (view.refine && can_refine(view.patient)) {
    refine(view);
  }
  if (!gl.kept.copy_to(framebuffer)) {
    gl.can_keep = false;
    draw_model(view);
  } else if (gl.fine.samples() >= FinePicture::least_samples && !gl.fine.copy_to(framebuffer)) {
    gl.can_refine = false;
    gl.fine.restart();
  }
}

bool Canvas::can_refine(bool patient) const {
  const Gl& gl = *gl_;
  return gl.can_keep && gl.can_refine && gl.kept_view && !gl.kept_view->coarse &&
         (patient || gl.sample_seconds < slow_sample) &&
         gl.fine.samples() < FinePicture::most_samples;
}

void Canvas::refine(const CanvasView& view) {
  Gl& gl = *gl_;
  const auto start = std::chrono::steady_clock::now();
  CanvasView shifted = view;
  const Eigen::Vector2d shift = gl.fine.shift();
  shifted.clip.row(0) += 2 * shift.x() / view.width * view.clip.row(3);
  shifted.clip.row(1) += 2 * shift.y() / view.height * view.clip.row(3);
  if (!gl.fine.begin_sample(view.width, view.height)) {
    gl.can_refine = false;
    return;
  }
  draw_model(shifted);
  gl.fine.add_sample(shifted.clip, view.axes, view.occlusion && view.model ? shade_strength : 0,
                     shade_radius);
  glFinish();
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  gl.sample_seconds = time.count();
}

MarkView Canvas::in_space(const CanvasView& view) const {
  return {view.clip,
          [center = center_, scale = scale_](const Vec3& p) -> Eigen::Vector3f {
            return ((p - center) * scale).cast<float>();
          },
          0, false};
}

void Canvas::draw(const CanvasView& view, const Marks& marks, const Overlay& overlay) {
  Gl& gl = *gl_;
  draw_or_copy_model(view);
  glViewport(0, 0, view.width, view.height);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  MarkView how = in_space(view);
  gl.marks.draw(marks.ground, view, how);
  gl.marks.draw(sorted_by_depth(marks.faces, center_, view.axes.row(2)), view, how,
                FaceLook::glass);
  how.hidden = view.model ? view.model_opacity_behind : 0;
  gl.marks.draw(marks.lines, view, how);
  gl.marks.draw(marks.dots, view, how);

  const MarkView on_screen = {pixel_matrix(view),
                              [](const Vec3& p) -> Eigen::Vector3f { return p.cast<float>(); }, 0,
                              true};
  gl.marks.draw(overlay.faces, view, on_screen, FaceLook::plain);
  gl.marks.draw(overlay.lines, view, on_screen);
  gl.marks.draw(overlay.dots, view, on_screen);

  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  glUseProgram(0);
}

} // namespace cagewright::app
