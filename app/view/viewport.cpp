#include "app/view/viewport.h"

#include "app/edit/select.h"
#include "core/parallel.h"

#include <QJsonArray>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QPainter>
#include <QSurfaceFormat>

#include <cmath>
#include <utility>

namespace cagewright::app {
namespace {

// How much is seen round what is brought into view, a fraction of the diagonal.
constexpr double around_a_place = 0.05;
// So long after the last movement the picture is made with all triangles, in milliseconds.
constexpr int rest_after = 250;
// Between the pieces of better pictures, so that whatever else there is to do comes first.
constexpr int improve_after = 5;
// Of a picture for a file.
constexpr int samples_of_picture = 6;

std::vector<Vec3> gathered(std::span<const Vec3> of_vertices, std::span<const Index> vertices) {
  std::vector<Vec3> found(vertices.size(), Vec3::Zero());
  parallel_for(0, vertices.size(), 8192, [&](std::size_t i) {
    if (vertices[i] < of_vertices.size()) {
      found[i] = of_vertices[vertices[i]];
    }
  });
  return found;
}

template <class T> std::vector<T> repeated(const std::vector<T>& values) {
  std::vector<T> two = values;
  two.insert(two.end(), values.begin(), values.end());
  return two;
}

/// The corners, and again those of as many vertices beyond.
template <class Corners>
std::vector<typename Corners::value_type> twice(const Corners& corners, Index vertices) {
  std::vector<typename Corners::value_type> two(corners.begin(), corners.end());
  two.reserve(2 * corners.size());
  for (auto of_second : corners) {
    for (Index& v : of_second) {
      v += vertices;
    }
    two.push_back(of_second);
  }
  return two;
}

} // namespace

Viewport::Viewport(Editor& editor, QWidget* parent)
    : QOpenGLWidget(parent), editor_(editor), document_(editor.document()) {
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  setFormat(format);
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setMinimumSize(160, 120);
  setObjectName("viewport");
  setAccessibleName(tr("3D view"));

  const auto repaint = [this] { update(); };
  layers_before_ = document_.layers();
  rest_.setSingleShot(true);
  rest_.setInterval(rest_after);
  connect(&rest_, &QTimer::timeout, this, repaint);
  improve_.setSingleShot(true);
  improve_.setInterval(improve_after);
  connect(&improve_, &QTimer::timeout, this, &Viewport::improve_picture);
  connect(&document_, &Document::modelChanged, this, &Viewport::model_changed);
  connect(&document_, &Document::modelMoved, this, [this] {
    dirty_.positions = true;
    const bool has_beside = document_.deformed_beside() != nullptr;
    if (has_beside && !std::exchange(beside_framed_, has_beside)) {
      frame_all(); // or it might stand outside the view
    }
    beside_framed_ = has_beside;
    something_moves();
    update();
  });
  connect(&document_, &Document::cageChanged, this, [this] {
    graph_is_stale_ = true;
    forget_hover();
    end_loop_cut();
    if (!framed_ && document_.has_cage()) {
      model_changed();
    }
    update();
  });
  connect(&document_, &Document::cageMoved, this, [this] {
    picker_.reset();
    if (loop_cut_) {
      preview_loop_cut();
    }
    update();
  });
  connect(&document_, &Document::colorsChanged, this, [this] {
    dirty_.colors = true;
    update();
  });
  connect(&document_, &Document::stagesChanged, this, [this] {
    dirty_.voxels = true;
    update();
  });
  connect(&document_, &Document::layersChanged, this, [this] {
    const Layers& layers = document_.layers();
    dirty_.voxels = dirty_.voxels || layers.feature_voxels != layers_before_.feature_voxels ||
                    layers.inner_voxels != layers_before_.inner_voxels;
    dirty_.colors = dirty_.colors || layers.weights != layers_before_.weights ||
                    layers.look != layers_before_.look;
    layers_before_ = layers;
    update();
  });
  connect(&document_, &Document::selectionChanged, this, [this] {
    forget_hover();
    update();
  });
  connect(&document_, &Document::hiddenChanged, this, [this] {
    picker_.reset();
    forget_hover();
    end_loop_cut();
    update();
  });
  connect(&document_, &Document::checkChanged, this, repaint);
  connect(&document_, &Document::modeChanged, this, [this] {
    end_loop_cut();
    update();
  });
  connect(&document_, &Document::toolsChanged, this, [this] {
    const Tool tool = document_.tools().tool;
    dirty_.colors =
        dirty_.colors || (tool != tool_before_ && (is_brush(tool) || is_brush(tool_before_)));
    tool_before_ = tool;
    update_cursor();
    update();
  });
  connect(&document_, &Document::pinsChanged, this, repaint);
  connect(&document_, &Document::viewStateChanged, this, repaint);
  model_changed();
}

Viewport::~Viewport() {
  if (canvas_) {
    disconnect(context(), nullptr, this, nullptr); // its end comes after ours
    makeCurrent();
    canvas_.reset();
    doneCurrent();
  }
}

// ---------------------------------------------------------------- the camera

void Viewport::something_moves() {
  rest_.start();
}

bool Viewport::draws_coarsely() const {
  return coarse_while_moving_ && rest_.isActive() && canvas_->is_slow();
}

void Viewport::set_coarse_while_moving(bool on) {
  coarse_while_moving_ = on;
  update();
}

void Viewport::camera_moved() {
  forget_hover();
  something_moves();
  Q_EMIT cameraChanged();
  update();
}

void Viewport::set_standard_view(const QString& name) {
  const std::optional<View> view = view_named(name.toStdString());
  if (view) {
    camera_.restore(camera_.target(), camera_.distance(), *view, camera_.is_perspective());
    camera_moved();
  }
}

void Viewport::set_orthographic(bool orthographic) {
  camera_.set_perspective(!orthographic);
  camera_moved();
}

void Viewport::set_up_axis(UpAxis up) {
  if (up != camera_.up()) {
    camera_.set_up(up);
    camera_moved();
  }
}

Box3 Viewport::scene_box() const {
  return document_.bounds();
}

void Viewport::frame_all() {
  const Box3 box = scene_box();
  if (box.isEmpty()) {
    return;
  }
  camera_.set_scene(box);
  camera_.frame(box);
  camera_moved();
}

void Viewport::frame_selection() {
  if (!document_.has_cage() || document_.selection().empty()) {
    frame_all();
    return;
  }
  refresh_graph();
  Box3 box;
  const std::span<const Vec3> positions = document_.shown_cage_positions();
  for (const Index v : vertices_of(document_.selection(), graph_)) {
    box.extend(positions[v]);
  }
  // Some of what is around a single vertex is seen, too.
  const double least = around_a_place * document_.diagonal();
  box.extend(Vec3(box.center().array() - least));
  box.extend(Vec3(box.center().array() + least));
  camera_.frame(box);
  camera_moved();
}

void Viewport::frame_place(const Vec3& place) {
  if (!place.allFinite()) {
    return;
  }
  Box3 box;
  const Vec3 around = Vec3::Constant(around_a_place * document_.diagonal());
  box.extend(Vec3(place - around));
  box.extend(Vec3(place + around));
  camera_.frame(box);
  camera_moved();
}

QJsonObject Viewport::camera_state() const {
  const Vec3& t = camera_.target();
  return {
      {"target", QJsonArray{t.x(), t.y(), t.z()}}, {"distance", camera_.distance()},
      {"yaw_degrees", camera_.view().yaw_degrees}, {"pitch_degrees", camera_.view().pitch_degrees},
      {"perspective", camera_.is_perspective()},   {"up", camera_.up() == UpAxis::z ? "z" : "y"}};
}

void Viewport::set_camera_state(const QJsonObject& state) {
  const QJsonArray target = state["target"].toArray();
  if (target.size() != 3) {
    return;
  }
  const double nothing = std::nan("");
  if (state["up"].isString()) {
    camera_.set_up(state["up"].toString() == "z" ? UpAxis::z : UpAxis::y);
  }
  camera_.restore(
      {target[0].toDouble(nothing), target[1].toDouble(nothing), target[2].toDouble(nothing)},
      state["distance"].toDouble(),
      {state["yaw_degrees"].toDouble(nothing), state["pitch_degrees"].toDouble(nothing)},
      state["perspective"].toBool(true));
  framed_ = true;
  camera_moved();
}

void Viewport::set_dark(bool dark) {
  colors_ = dark ? ViewColors::dark() : ViewColors::light();
  dirty_.colors = true;
  update();
}

// ---------------------------------------------------------------- what is drawn

void Viewport::model_changed() {
  dirty_ = {};
  graph_is_stale_ = true;
  const Box3 box = scene_box();
  framed_ = !box.isEmpty();
  if (framed_) {
    camera_.set_scene(box);
    camera_.frame(box);
  }
  camera_moved();
}

void Viewport::refresh_graph() {
  if (!graph_is_stale_) {
    return;
  }
  graph_is_stale_ = false;
  picker_.reset();
  graph_ = document_.has_cage() ? CageGraph(document_.cage_rest()) : CageGraph();
}

PolygonMesh Viewport::shown_cage() const {
  PolygonMesh cage = document_.cage_rest();
  const std::span<const Vec3> shown = document_.shown_cage_positions();
  cage.positions.assign(shown.begin(), shown.end());
  return cage;
}

const Picker& Viewport::picker() {
  refresh_graph();
  if (!picker_) {
    picker_.emplace(document_.has_cage() ? shown_cage() : PolygonMesh(), graph_,
                    InSight(graph_, document_.state().hidden_faces));
  }
  return *picker_;
}

void Viewport::initializeGL() {
  Result<std::unique_ptr<Canvas>> made = Canvas::create();
  if (!made) {
    failure_ = QString::fromStdString(made.error().message);
    return;
  }
  canvas_ = std::move(*made);
  dirty_ = {};
  // The context goes when the widget moves to another window.
  connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, [this] {
    makeCurrent();
    canvas_.reset();
    doneCurrent();
  });
}

void Viewport::resizeGL(int width, int height) {
  camera_.resize(width, height);
}

/// In its own colors, with materials and textures, unless other colors say something.
bool Viewport::wears_dress() const {
  return document_.layers().look == SurfaceLook::own && document_.has_model() &&
         document_.model()->dress && !is_brush(document_.tools().tool) &&
         !document_.state().region &&
         !(document_.layers().weights && !document_.model_weights().empty());
}

/// One for each vertex of the mesh that is drawn, or none: then all have the same.
std::vector<Color> Viewport::model_colors() const {
  const Document& document = document_;
  if (dressed_) {
    return document.model()->dress->colors;
  }
  const auto of = [](std::size_t count, const auto& color) {
    std::vector<Color> colors(count);
    parallel_for(0, count, 4096, [&](std::size_t i) { colors[i] = color(i); });
    return colors;
  };
  const std::size_t vertices = document.model_positions().size();
  const SharedDensity& density = document.state().density;
  if (document.tools().tool == Tool::paint && density && density->size() == vertices) {
    return of(vertices, [&](std::size_t i) { return density_color((*density)[i], colors_.model); });
  }
  if (document.tools().tool == Tool::mix) {
    const SharedShares& mix = document.shown_mix();
    const bool has_mix = mix && mix->size() == vertices;
    return of(vertices,
              [&](std::size_t i) { return share_color(has_mix ? (*mix)[i] : 0, colors_.model); });
  }
  const std::span<const float> weights = document.model_weights();
  const bool shows_weights = document.layers().weights && weights.size() == vertices;
  if (shows_weights && vertices > 0) {
    return of(vertices, [&](std::size_t i) { return weight_color(weights[i]); });
  }
  if ((stroke_ && stroke_->chooses) || document.state().region) {
    return region_colors();
  }
  if (document.layers().look == SurfaceLook::own && document.has_model()) {
    const auto& own = document.model()->mesh.colors;
    return of(own.size(), [&](std::size_t i) {
      return color_of(Rgb{own[i][0], own[i][1], own[i][2]});
    });
  }
  return {};
}

/// What the cage is for, as it is while it is painted, stands out.
std::vector<Color> Viewport::region_colors() const {
  const auto towards = [this](const Rgb& other, float share) {
    Rgb mixed = colors_.model;
    for (std::size_t c = 0; c < 3; ++c) {
      mixed[c] += share * (other[c] - mixed[c]);
    }
    return color_of(mixed);
  };
  static constexpr Rgb accent = {0.16F, 0.52F, 0.86F};
  const Color chosen = towards(accent, 0.45F);
  const Color rest = towards(colors_.bottom, 0.5F);
  std::vector<Color> colors(document_.model_positions().size(), rest);
  if (stroke_ && stroke_->chooses) {
    for (std::size_t v = 0; v < colors.size(); ++v) {
      colors[v] = stroke_->density[v] > 0 ? chosen : colors[v];
    }
  } else {
    for (const Index v : document_.state().region->vertices) {
      colors[v] = chosen;
    }
  }
  return colors;
}

/// Of the model itself: as many again are those of what is shown beside it.
Index Viewport::drawn_vertices() const {
  return static_cast<Index>(dressed_ ? document_.model()->dress->vertex_of.size()
                                     : document_.model_positions().size());
}

void Viewport::upload_surface() {
  std::span<const Vec3> positions = document_.model_positions();
  std::span<const Vec3> normals = document_.model_normals();
  std::vector<Vec3> made_positions; // where they are not the document's own
  std::vector<Vec3> made_normals;
  const Dress* dress = dressed_ ? document_.model()->dress.get() : nullptr;
  if (dress != nullptr) {
    made_positions = gathered(positions, dress->vertex_of);
    made_normals = gathered(normals, dress->vertex_of);
  }
  if (shows_beside_) {
    const DeformedModel& other = *document_.deformed_beside();
    if (dress == nullptr) {
      made_positions.assign(positions.begin(), positions.end());
      made_normals.assign(normals.begin(), normals.end());
    }
    const Vec3 way = document_.way_beside();
    const std::size_t count = made_positions.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t v = dress != nullptr ? dress->vertex_of[i] : i;
      made_positions.push_back(other.positions[v] + way);
      made_normals.push_back(other.normals[v]);
    }
  }
  if (!made_positions.empty()) {
    positions = made_positions;
    normals = made_normals;
  }
  if (!dirty_.model) {
    canvas_->move_model(positions, normals);
    return;
  }
  dirty_.colors = true;
  const std::span<const Triangle> triangles =
      dress != nullptr ? std::span<const Triangle>(dress->triangles) : document_.model_triangles();
  const std::span<const Triangle> coarse =
      dress != nullptr ? std::span<const Triangle>(dress->coarse) : document_.coarse_triangles();
  if (shows_beside_) {
    canvas_->set_model(positions, normals, twice(triangles, drawn_vertices()),
                       twice(coarse, drawn_vertices()));
  } else {
    canvas_->set_model(positions, normals, triangles, coarse);
  }
  if (dress == nullptr) {
    canvas_->set_model_texture({}, {}, {});
    return;
  }
  const QImage& atlas = dress->atlas;
  const Picture picture{atlas.width(),
                        atlas.height(),
                        {atlas.constBits(), static_cast<std::size_t>(atlas.sizeInBytes())}};
  if (shows_beside_) {
    canvas_->set_model_texture(repeated(dress->texture_points), repeated(dress->places), picture);
  } else {
    canvas_->set_model_texture(dress->texture_points, dress->places, picture);
  }
}

void Viewport::upload() {
  if (dirty_.frame) {
    const Box3 box = scene_box();
    const double radius = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
    canvas_->set_frame(box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center()),
                       radius > 0 ? 1 / radius : 1);
    dirty_.frame = false;
  }
  const auto& beside = document_.deformed_beside();
  if (wears_dress() != dressed_ || (beside != nullptr) != shows_beside_) {
    dressed_ = wears_dress();
    shows_beside_ = beside != nullptr;
    dirty_.model = true;
  }
  if (dirty_.model || dirty_.positions) {
    upload_surface();
  }
  dirty_.edges = dirty_.edges || dirty_.model;
  if (dirty_.edges && document_.layers().wireframe && document_.has_model()) {
    const auto& edges = dressed_ ? document_.model()->dress->edges : document_.model()->edges;
    if (shows_beside_) {
      canvas_->set_model_edges(twice(edges, drawn_vertices()));
    } else {
      canvas_->set_model_edges(edges);
    }
    dirty_.edges = false;
  }
  dirty_.model = dirty_.positions = false;
  if (dirty_.colors) {
    const std::vector<Color> colors = model_colors();
    canvas_->set_model_colors(shows_beside_ ? repeated(colors) : colors);
    dirty_.colors = false;
  }
  if (dirty_.voxels) {
    const Layers& layers = document_.layers();
    std::vector<FaceMark> voxels;
    if (document_.stages() && (layers.feature_voxels || layers.inner_voxels)) {
      voxels = voxel_faces(*document_.stages(), layers.feature_voxels, layers.inner_voxels);
    }
    canvas_->set_solids(std::move(voxels));
    dirty_.voxels = false;
  }
}

CanvasView Viewport::canvas_view(int width, int height, double ratio) const {
  CanvasView view;
  view.clip = camera_.clip_matrix(canvas_->center(), canvas_->scale());
  view.axes = camera_.axes();
  view.width = width;
  view.height = height;
  view.pixel_ratio = ratio;
  const Layers& layers = document_.layers();
  view.model = layers.model;
  view.smooth = layers.smooth_normals;
  view.wireframe = layers.wireframe;
  view.look = layers.look;
  view.occlusion = layers.occlusion;
  view.background_top = colors_.top;
  view.background_bottom = colors_.bottom;
  view.model_color = colors_.model;
  view.wire_color = colors_.wire;
  return view;
}

bool Viewport::is_still() const {
  return !rest_.isActive() && !drag_.is_active() &&
         (gesture_ == Gesture::none || gesture_ == Gesture::press);
}

/// While nothing moves, a piece at a time.
void Viewport::improve_picture() {
  if (!canvas_ || !is_still() || !canvas_->can_improve()) {
    return;
  }
  makeCurrent();
  const bool is_better = canvas_->improve();
  doneCurrent();
  if (is_better) {
    update();
  } else {
    improve_.start();
  }
}

void Viewport::finish_picture() {
  rest_.stop();
  grabFramebuffer();
  if (canvas_) {
    makeCurrent();
    while (canvas_->can_improve(true)) {
      canvas_->improve(true);
    }
    doneCurrent();
  }
  update();
}

void Viewport::paintGL() {
  if (canvas_) {
    // What is dragged may leave the box of the scene.
    if (const Box3 box = scene_box(); !box.isEmpty()) {
      camera_.set_scene(box);
    }
    upload();
    const double ratio = devicePixelRatioF();
    const auto device = [&](int length) { return static_cast<int>(std::lround(length * ratio)); };
    const Marks marks = make_marks();
    CanvasView view = canvas_view(device(width()), device(height()), ratio);
    view.coarse = draws_coarsely();
    view.keep = true;
    view.patient = !coarse_while_moving_;
    canvas_->draw(view, marks, make_overlay());
    if (is_still() && canvas_->can_improve() && !improve_.isActive()) {
      improve_.start(); // once all else is done
    }
  }
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setRenderHint(QPainter::TextAntialiasing);
  paint_texts(painter);
}

QImage Viewport::picture(const QSize& size) {
  if (!canvas_) {
    return {};
  }
  makeCurrent();
  const OrbitCamera before = camera_;
  camera_.resize(size.width(), size.height());
  if (const Box3 box = scene_box(); !box.isEmpty()) {
    camera_.set_scene(box);
  }
  with_texts_ = false;
  upload();
  QOpenGLFramebufferObject target(size, QOpenGLFramebufferObject::CombinedDepthStencil);
  target.bind();
  const Marks marks = make_marks();
  CanvasView view = canvas_view(size.width(), size.height(), 1);
  view.keep = view.patient = true;
  canvas_->draw(view, marks, {});
  for (int i = 0; i < samples_of_picture && canvas_->can_improve(true); ++i) {
    canvas_->improve(true);
  }
  target.bind();
  canvas_->draw(view, marks, {});
  target.release();
  const QImage image = target.toImage();
  with_texts_ = true;
  camera_ = before;
  doneCurrent();
  return image.convertToFormat(QImage::Format_RGB32);
}

} // namespace cagewright::app
