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
#include <limits>
#include <optional>
#include <utility>

namespace cagewright::app {
namespace {

// Smaller models are drawn at once, whoever draws them.
constexpr std::size_t large_model = 100000;
// A picture that takes longer is drawn in pieces. Seconds.
constexpr double slow_picture = 0.04;
// What a piece may take, and how many triangles the first one has.
constexpr double piece_seconds = 0.02;
constexpr std::size_t first_piece = 40000;
// A picture that takes longer is not made finer: a processor would be busy for long. Seconds.
constexpr double slowest_sample = 0.3;
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

/// A picture of the model that is drawn piece by piece: what is done of it.
struct Canvas::Pieces {
  bool begun = false;
  bool solids = false;
  std::size_t triangles = 0;
  std::size_t edges = 0;
  double seconds = 0;
};

struct Canvas::Gl {
  gl::Program background;
  gl::VertexArray empty = make_array();
  ModelPainter model;
  MarkPainter marks;
  std::vector<FaceMark> solids;

  KeptPicture kept;
  std::optional<CanvasView> kept_view; // of which it is the picture
  bool can_keep = true;
  KeptPicture whole; // in the making, with all triangles
  std::optional<CanvasView> whole_view;
  Pieces whole_pieces;
  FinePicture fine;                  // of kept_view
  std::optional<Pieces> fine_pieces; // of the sample in the making
  bool can_refine = true;

  std::optional<double> picture_seconds; // of the last one with all triangles
  double piece_size = first_piece;       // triangles, as many as take piece_seconds

  void forget_pictures() {
    kept_view.reset();
    whole_view.reset();
    fine_pieces.reset();
  }
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
  gl_->forget_pictures();
}

void Canvas::set_model(std::span<const Vec3> positions, std::span<const Vec3> normals,
                       std::span<const Triangle> triangles, std::span<const Triangle> coarse) {
  gl_->model.set_triangles(triangles, coarse);
  gl_->picture_seconds.reset();
  move_model(positions, normals);
}

void Canvas::set_model_edges(std::span<const std::array<Index, 2>> edges) {
  gl_->model.set_edges(edges);
  gl_->forget_pictures();
}

void Canvas::move_model(std::span<const Vec3> positions, std::span<const Vec3> normals) {
  std::vector<Eigen::Vector3f> placed(positions.size());
  parallel_for(0, positions.size(), 8192, [&](std::size_t i) {
    placed[i] = ((positions[i] - center_) * scale_).cast<float>();
  });
  gl_->model.move(std::move(placed), normals);
  gl_->forget_pictures();
}

void Canvas::set_model_colors(std::span<const Color> colors) {
  gl_->model.set_colors(colors);
  gl_->forget_pictures();
}

void Canvas::set_model_texture(std::span<const std::array<float, 2>> points,
                               std::span<const std::array<float, 4>> places,
                               const Picture& picture) {
  gl_->model.set_texture(points, places, picture);
  gl_->forget_pictures();
}

void Canvas::set_solids(std::vector<FaceMark> solids) {
  gl_->solids = std::move(solids);
  gl_->forget_pictures();
}

// ---------------------------------------------------------------- a picture

bool Canvas::is_slow() const {
  const Gl& gl = *gl_;
  return gl.model.has_coarse() && gl.model.triangle_count({}) >= large_model &&
         (!gl.picture_seconds || *gl.picture_seconds > slow_picture);
}

bool Canvas::shows_all() const {
  return gl_->kept_view && !gl_->kept_view->coarse;
}

/// Draws on to the framebuffer that is bound. \returns whether the picture is complete
bool Canvas::draw_piece(const CanvasView& view, Pieces& pieces, std::size_t most) {
  Gl& gl = *gl_;
  glViewport(0, 0, view.width, view.height);
  glDisable(GL_CULL_FACE);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  if (!std::exchange(pieces.begun, true)) {
    glClearDepth(1);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    const Uniforms uniforms(gl.background);
    uniforms.set("top", view.background_top);
    uniforms.set("bottom", view.background_bottom);
    glBindVertexArray(gl.empty.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  const std::size_t triangles = view.model ? gl.model.triangle_count(view) : 0;
  const std::size_t edges =
      view.model && view.wireframe && !view.coarse ? gl.model.edge_count() : 0;
  const std::size_t before = pieces.triangles + pieces.edges;
  if (pieces.triangles < triangles) {
    const std::size_t now = std::min(most, triangles - pieces.triangles);
    gl.model.draw(view, pieces.triangles, now);
    pieces.triangles += now;
    most -= now;
  }
  if (pieces.triangles == triangles && !std::exchange(pieces.solids, true)) {
    gl.marks.draw(gl.solids, view, in_space(view), FaceLook::lit);
  }
  if (pieces.solids && pieces.edges < edges && most > 0) {
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const std::size_t now = std::min(most, edges - pieces.edges);
    gl.model.draw_wireframe(view, pieces.edges, now);
    pieces.edges += now;
  }
  most_at_once_ = std::max(most_at_once_, pieces.triangles + pieces.edges - before);
  return pieces.triangles == triangles && pieces.edges == edges;
}

void Canvas::draw_model(const CanvasView& view) {
  Pieces all;
  draw_piece(view, all, std::numeric_limits<std::size_t>::max());
}

/// As much as may be drawn at once.
bool Canvas::draw_timed_piece(const CanvasView& view, Pieces& pieces, bool patient) {
  Gl& gl = *gl_;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t before = pieces.triangles + pieces.edges;
  const auto most = patient || !is_slow() ? std::numeric_limits<std::size_t>::max()
                                          : static_cast<std::size_t>(gl.piece_size);
  const bool complete = draw_piece(view, pieces, most);
  glFinish(); // to know how long it takes
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  pieces.seconds += time.count();
  // The next piece is as large as takes the wanted time, though not much larger than this one.
  const auto drawn = static_cast<double>(pieces.triangles + pieces.edges - before);
  if (drawn >= 0.9 * gl.piece_size || time.count() > piece_seconds) {
    const double fits = drawn * piece_seconds / std::max(time.count(), 1e-6);
    gl.piece_size = std::clamp(fits, first_piece / 8.0, 2 * std::max(drawn, gl.piece_size));
  }
  return complete;
}

/// Draws the kept picture. \returns false if the driver cannot keep any: nothing is bound then
bool Canvas::keep_picture(const CanvasView& view) {
  Gl& gl = *gl_;
  gl.forget_pictures();
  if (!gl.kept.bind(view.width, view.height)) {
    return false;
  }
  Pieces all;
  draw_timed_piece(view, all, true);
  if (!view.coarse && view.model) {
    gl.picture_seconds = all.seconds;
  }
  gl.kept_view = view;
  gl.fine.restart();
  return true;
}

/// Whether the kept picture is what is asked for, or better.
bool Canvas::is_kept(const CanvasView& view) const {
  const Gl& gl = *gl_;
  if (!gl.kept_view) {
    return false;
  }
  CanvasView with_all = view;
  with_all.coarse = false;
  return same_picture(*gl.kept_view, view) || same_picture(*gl.kept_view, with_all);
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
  if (!is_kept(view)) {
    CanvasView quick = view;
    quick.coarse = view.coarse || (is_slow() && view.model && !view.patient);
    if (!is_kept(quick) && !keep_picture(quick)) {
      gl.can_keep = false;
      glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
      draw_model(view);
      return;
    }
    if (quick.coarse == view.coarse) {
      gl.whole_view.reset();
    } else if (!gl.whole_view || !same_picture(*gl.whole_view, view)) {
      gl.whole_view = view;
      gl.whole_pieces = {};
    }
  }
  if (!gl.kept.copy_to(framebuffer)) {
    gl.can_keep = false;
    draw_model(view);
  } else if (gl.fine.samples() >= FinePicture::least_samples && !gl.fine.copy_to(framebuffer)) {
    gl.can_refine = false;
    gl.fine.restart();
  }
}

bool Canvas::can_improve(bool patient) const {
  const Gl& gl = *gl_;
  if (!gl.can_keep || !gl.kept_view) {
    return false;
  }
  return gl.whole_view || (gl.can_refine && !gl.kept_view->coarse &&
                           (patient || gl.picture_seconds.value_or(0) < slowest_sample) &&
                           gl.fine.samples() < FinePicture::most_samples);
}

bool Canvas::improve(bool patient) {
  if (!can_improve(patient)) {
    return false;
  }
  return gl_->whole_view ? complete(patient) : refine(patient);
}

/// All triangles in place of the coarse ones.
bool Canvas::complete(bool patient) {
  Gl& gl = *gl_;
  const CanvasView view = *gl.whole_view;
  if (!gl.whole.bind(view.width, view.height)) {
    gl.can_keep = false; // the next picture is drawn as it is
    return true;
  }
  if (!draw_timed_piece(view, gl.whole_pieces, patient)) {
    return false;
  }
  gl.picture_seconds = gl.whole_pieces.seconds;
  std::swap(gl.kept, gl.whole);
  gl.forget_pictures();
  gl.kept_view = view;
  gl.fine.restart();
  return true;
}

/// One more sample of the finer picture.
bool Canvas::refine(bool patient) {
  Gl& gl = *gl_;
  const CanvasView& view = *gl.kept_view;
  CanvasView shifted = view;
  const Eigen::Vector2d shift = gl.fine.shift();
  shifted.clip.row(0) += 2 * shift.x() / view.width * view.clip.row(3);
  shifted.clip.row(1) += 2 * shift.y() / view.height * view.clip.row(3);
  if (!gl.fine.begin_sample(view.width, view.height)) {
    gl.can_refine = false;
    return false;
  }
  if (!gl.fine_pieces) {
    gl.fine_pieces.emplace();
  }
  if (!draw_timed_piece(shifted, *gl.fine_pieces, patient)) {
    return false;
  }
  if (view.model) {
    gl.picture_seconds = gl.fine_pieces->seconds;
  }
  gl.fine_pieces.reset();
  gl.fine.add_sample(shifted.clip, view.axes, view.occlusion && view.model ? shade_strength : 0,
                     shade_radius);
  return gl.fine.samples() >= FinePicture::least_samples;
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
