#include "app/view/viewport.h"

#include "app/edit/select.h"
#include "core/parallel.h"

#include <QJsonArray>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QPainter>
#include <QPainterPath>
#include <QSurfaceFormat>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cagewright::app {
namespace {

// A press becomes a drag when the mouse has gone so far, in pixels.
constexpr double drag_distance = 4;
// Pictures that take longer are drawn coarsely while something moves, in seconds.
constexpr double slow_picture = 0.04;
// So long after the last movement the picture is drawn with all triangles, in milliseconds.
constexpr int rest_after = 250;

Pixel pixel_of(const QPointF& p) {
  return {p.x(), p.y()};
}

QColor qt(const Rgb& c, double alpha = 1) {
  return QColor::fromRgbF(c[0], c[1], c[2], static_cast<float>(alpha));
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
  connect(&document_, &Document::modelChanged, this, &Viewport::model_changed);
  connect(&document_, &Document::modelMoved, this, [this] {
    dirty_.positions = true;
    something_moves();
    update();
  });
  connect(&document_, &Document::cageChanged, this, [this] {
    graph_is_stale_ = true;
    forget_hover();
    if (!framed_ && document_.has_cage()) {
      model_changed();
    }
    update();
  });
  connect(&document_, &Document::cageMoved, this, [this] {
    picker_.reset();
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
    dirty_.colors = dirty_.colors || layers.weights != layers_before_.weights;
    layers_before_ = layers;
    update();
  });
  connect(&document_, &Document::selectionChanged, this, [this] {
    forget_hover();
    update();
  });
  connect(&document_, &Document::checkChanged, this, repaint);
  connect(&document_, &Document::modeChanged, this, repaint);
  connect(&document_, &Document::toolsChanged, this, repaint);
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
  return coarse_while_moving_ && rest_.isActive() && canvas_->model_seconds() > slow_picture;
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
  const double least = 0.05 * document_.diagonal();
  box.extend(Vec3(box.center().array() - least));
  box.extend(Vec3(box.center().array() + least));
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
    picker_.emplace(document_.has_cage() ? shown_cage() : PolygonMesh(), graph_);
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

void Viewport::upload() {
  if (dirty_.frame) {
    const Box3 box = scene_box();
    const double radius = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
    canvas_->set_frame(box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center()),
                       radius > 0 ? 1 / radius : 1);
    dirty_.frame = false;
  }
  if (dirty_.model) {
    canvas_->set_model(document_.model_positions(), document_.model_normals(),
                       document_.model_triangles(), document_.coarse_triangles());
    dirty_.colors = true;
  } else if (dirty_.positions) {
    canvas_->move_model(document_.model_positions(), document_.model_normals());
  }
  dirty_.model = dirty_.positions = false;
  if (dirty_.colors) {
    const std::span<const float> weights = document_.model_weights();
    std::vector<Color> colors;
    if (document_.layers().weights && weights.size() == document_.model_positions().size()) {
      colors.resize(weights.size());
      parallel_for(0, colors.size(), 4096,
                   [&](std::size_t i) { colors[i] = weight_color(weights[i]); });
    }
    canvas_->set_model_colors(colors);
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

Marks Viewport::make_marks() {
  Marks marks;
  const Layers& layers = document_.layers();
  if (layers.grid) {
    // Not of what is being dragged: the ground stays where it is.
    const Box3 box = document_.has_model() ? document_.model()->box : scene_box();
    add_grid(box, camera_, colors_, marks);
  }
  if (document_.stages()) {
    add_boxes(document_, marks);
  }
  if (document_.has_cage()) {
    refresh_graph();
    if (layers.rest_cage && document_.mode() == Mode::deform) {
      add_rest(document_, graph_, colors_, marks);
    }
    const bool hovers = with_texts_ && gesture_ == Gesture::none && !drag_.is_active();
    add_cage(document_, shown_cage(), graph_, camera_, colors_, hovers ? hovered_ : std::nullopt,
             marks);
    if (layers.problems) {
      add_problems(document_, colors_, marks);
    }
  }
  return marks;
}

std::optional<GizmoFrame> Viewport::gizmo() const {
  if (!document_.has_cage() || document_.selection().empty() || !has_gizmo_tool() ||
      graph_is_stale_ || document_.comparing() || document_.time()) {
    return std::nullopt;
  }
  const std::vector<Index> vertices = vertices_of(document_.selection(), graph_);
  const std::span<const Vec3> positions = document_.shown_cage_positions();
  GizmoFrame frame;
  frame.origin = pivot_of(positions, vertices, document_.tools().pivot);
  switch (document_.tools().axes) {
  case AxesKind::world:
    break;
  case AxesKind::local:
    frame.axes = local_axes(shown_cage(), graph_, vertices);
    break;
  case AxesKind::view:
    frame.axes = camera_.axes().transpose();
    break;
  }
  return frame;
}

Overlay Viewport::make_overlay() const {
  Overlay overlay;
  if (!with_texts_) {
    return overlay;
  }
  add_tripod(camera_, overlay);
  const auto on_screen = [](const Pixel& p) { return Vec3(p.x(), p.y(), 0); };
  if (drag_.is_active()) {
    // The axis or the plane to which the drag is confined.
    const Vec3 pivot = drag_.transform().pivot;
    const auto draw_axis = [&](int axis) {
      const Vec3 direction = drag_.frame().col(axis) * 3 * document_.diagonal();
      Vec3 from = pivot - direction;
      Vec3 to = pivot + direction;
      const auto shorten = [&](Vec3& end) { // to where it is before the eye
        for (int i = 0; i < 12 && !camera_.project(end); ++i) {
          end = pivot + 0.5 * (end - pivot);
        }
      };
      shorten(from);
      shorten(to);
      if (camera_.project(from) && camera_.project(to)) {
        overlay.lines.push_back({on_screen(camera_.project(from)->pixel),
                                 on_screen(camera_.project(to)->pixel),
                                 color_of(axis_color(axis), 0.7), 1.4F});
      }
    };
    for (int axis = 0; axis < 3; ++axis) {
      const bool along = axis == drag_.axis();
      if ((drag_.freedom() == TransformDrag::Freedom::axis && along) ||
          (drag_.freedom() == TransformDrag::Freedom::plane && !along)) {
        draw_axis(axis);
      }
    }
    const auto middle = camera_.project(pivot);
    const ToolSettings& tools = document_.tools();
    if (tools.proportional && middle) {
      const double radius = target_.options().proportional.radius / camera_.pixel_size(pivot);
      constexpr int parts = 96;
      for (int i = 0; i < parts; ++i) {
        const auto at = [&](int k) {
          const double angle = 2 * M_PI * k / parts;
          return on_screen(middle->pixel + radius * Pixel(std::cos(angle), std::sin(angle)));
        };
        overlay.lines.push_back({at(i), at(i + 1), color_of(colors_.text, 0.6), 1.3F});
      }
    }
  } else if (const std::optional<GizmoFrame> frame = gizmo();
             frame && gesture_ != Gesture::box && gesture_ != Gesture::lasso) {
    add_gizmo(camera_, tool_kind(), *frame, hovered_handle_, overlay);
  }
  if (gesture_ == Gesture::box || gesture_ == Gesture::lasso) {
    const std::vector<Pixel> line = outline();
    if (gesture_ == Gesture::box) {
      const Color fill = color_of(colors_.cage_face, 0.12);
      const std::array<Vec3, 4> c = {on_screen(line[0]), on_screen(line[1]), on_screen(line[2]),
                                     on_screen(line[3])};
      overlay.faces.push_back({{c[0], c[1], c[2]}, {fill, fill, fill}});
      overlay.faces.push_back({{c[0], c[2], c[3]}, {fill, fill, fill}});
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
      overlay.lines.push_back({on_screen(line[i]), on_screen(line[(i + 1) % line.size()]),
                               color_of(colors_.cage, 0.9), 1.2F});
    }
  }
  if (box_armed_ && gesture_ == Gesture::none) {
    const Color color = color_of(colors_.text, 0.4);
    overlay.lines.push_back({{cursor_.x(), 0, 0}, {cursor_.x(), camera_.height(), 0}, color, 1});
    overlay.lines.push_back({{0, cursor_.y(), 0}, {camera_.width(), cursor_.y(), 0}, color, 1});
  }
  return overlay;
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
  view.background_top = colors_.top;
  view.background_bottom = colors_.bottom;
  view.model_color = colors_.model;
  view.wire_color = colors_.wire;
  return view;
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
    canvas_->draw(view, marks, make_overlay());
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
  // Twice as fine, then halved: smooth outlines without multisampling.
  QOpenGLFramebufferObject target(size * 2, QOpenGLFramebufferObject::Depth);
  target.bind();
  const Marks marks = make_marks();
  canvas_->draw(canvas_view(2 * size.width(), 2 * size.height(), 2), marks, {});
  target.release();
  const QImage image =
      target.toImage().scaled(size, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  with_texts_ = true;
  camera_ = before;
  doneCurrent();
  return image.convertToFormat(QImage::Format_RGB32);
}

void Viewport::paint_texts(QPainter& painter) const {
  QFont small = font();
  small.setPointSizeF(std::max(7.0, small.pointSizeF() * 0.9));
  if (!failure_.isEmpty()) {
    painter.fillRect(rect(), palette().window());
    painter.setPen(palette().windowText().color());
    painter.drawText(rect().adjusted(20, 20, -20, -20), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("The 3D view cannot be drawn: %1").arg(failure_));
    return;
  }
  QFont letters = small;
  letters.setBold(true);
  painter.setFont(letters);
  painter.setPen(Qt::white);
  const std::array<Pixel, 3> tips = tripod_tips(camera_);
  for (std::size_t i = 0; i < 3; ++i) {
    const QRectF box(tips[i].x() - 10, tips[i].y() - 10, 20, 20);
    painter.drawText(box, Qt::AlignCenter, QString(QChar('X' + static_cast<int>(i))));
  }
  painter.setFont(small);
  painter.setPen(qt(colors_.text, 0.85));
  if (!document_.has_model() && !document_.has_cage()) {
    return;
  }
  QString where = orthographic() ? tr("Orthographic") : tr("Perspective");
  const View& view = camera_.view();
  for (const char* name : {"front", "back", "left", "right", "top", "bottom"}) {
    const View standard = *view_named(name);
    const bool poles = std::abs(standard.pitch_degrees) == 90;
    if (std::abs(standard.pitch_degrees - view.pitch_degrees) < 1e-6 &&
        (poles ? std::abs(view.yaw_degrees) < 1e-6
               : std::abs(std::remainder(standard.yaw_degrees - view.yaw_degrees, 360)) < 1e-6)) {
      where = QString(name).replace(0, 1, QChar(name[0]).toUpper()) + " \u00b7 " + where;
    }
  }
  painter.drawText(QRectF(12, 8, width() - 24, 20), Qt::AlignLeft | Qt::AlignVCenter, where);
  if (document_.has_cage()) {
    const bool deforms = document_.mode() == Mode::deform;
    QString mode =
        deforms ? tr("Deforming: dragging the cage moves the model") : tr("Refining the cage");
    if (document_.comparing()) {
      mode = tr("At rest, for comparison");
    }
    painter.drawText(QRectF(12, 26, width() - 24, 20), Qt::AlignLeft | Qt::AlignVCenter, mode);
  }
  paint_legend(painter);
  if (!caption_.isEmpty()) {
    painter.setFont(font());
    const QRectF space(0, height() - 44, width(), 30);
    const QRectF box =
        painter.fontMetrics().boundingRect(caption_).toRectF().adjusted(-12, -5, 12, 5);
    QRectF plate(0, 0, box.width(), box.height());
    plate.moveCenter(space.center());
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(25, 27, 31, 205));
    painter.drawRoundedRect(plate, 6, 6);
    painter.setPen(Qt::white);
    painter.drawText(plate, Qt::AlignCenter, caption_);
  }
}

void Viewport::paint_legend(QPainter& painter) const {
  const Layers& layers = document_.layers();
  const bool weights = layers.weights && !document_.model_weights().empty();
  const bool distance = layers.distance && !document_.cage_distances().empty();
  if (!weights && !distance) {
    return;
  }
  const QRectF bar(width() - 172, height() - 30, 150, 10);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (int i = 0; i <= 10; ++i) {
    gradient.setColorAt(i / 10.0, qt(scale_color(i / 10.0)));
  }
  painter.save();
  painter.setPen(QPen(qt(colors_.text, 0.5), 1));
  painter.setBrush(gradient);
  painter.drawRect(bar);
  painter.setPen(qt(colors_.text, 0.85));
  const QRectF above = bar.adjusted(-40, -20, 0, -12);
  painter.drawText(above, Qt::AlignRight | Qt::AlignVCenter,
                   weights ? tr("weight of the selection") : tr("distance to the model"));
  const QRectF below = bar.adjusted(0, 10, 0, 16);
  painter.drawText(below, Qt::AlignLeft | Qt::AlignVCenter, "0");
  painter.drawText(below, Qt::AlignRight | Qt::AlignVCenter,
                   weights ? "1" : tr("8 % of the diagonal"));
  painter.restore();
}

// ---------------------------------------------------------------- selecting

PickOptions Viewport::pick_options() const {
  return {.radius = 10, .see_through = document_.tools().see_through};
}

Selection Viewport::selection_of(const Pick& pick) const {
  Selection found;
  found.mode = pick.mode;
  switch (pick.mode) {
  case SelectionMode::vertex:
    found.vertices = {pick.element};
    break;
  case SelectionMode::edge:
    found.edges = {graph_.edge(pick.element)};
    break;
  case SelectionMode::face:
    found.faces = {pick.element};
    break;
  }
  return found;
}

void Viewport::click(const Press& press) {
  const bool adds = press.modifiers.testFlag(Qt::ShiftModifier);
  const Selection& now = document_.selection();
  Selection found;
  found.mode = now.mode;
  if (press.pick) {
    found = selection_of(*press.pick);
  }
  editor_.select(combined(now, found, adds ? Combine::toggle : Combine::replace));
}

std::vector<Pixel> Viewport::outline() const {
  return gesture_ == Gesture::box ? rectangle(press_.at, cursor_) : lasso_;
}

void Viewport::finish_outline(Qt::KeyboardModifiers modifiers) {
  if (document_.has_cage()) {
    const Selection& now = document_.selection();
    const Selection found = picker().within(camera_, outline(), now.mode, pick_options());
    const bool shift = modifiers.testFlag(Qt::ShiftModifier);
    const bool subtracts = shift && modifiers.testFlag(Qt::ControlModifier);
    editor_.select(combined(now, found,
                            subtracts ? Combine::subtract
                            : shift   ? Combine::add
                                      : Combine::replace));
  }
  box_armed_ = false;
  gesture_ = Gesture::none;
  lasso_.clear();
  update();
}

void Viewport::forget_hover() {
  hovered_.reset();
  hovered_handle_ = Handle::none;
}

void Viewport::hover(const Pixel& cursor) {
  const std::optional<Pick> before = hovered_;
  const Handle handle_before = hovered_handle_;
  forget_hover();
  if (document_.has_cage() && !drag_.is_active()) {
    refresh_graph();
    if (const std::optional<GizmoFrame> frame = gizmo()) {
      hovered_handle_ = handle_at(camera_, tool_kind(), *frame, cursor);
    }
    if (hovered_handle_ == Handle::none || hovered_handle_ == Handle::trackball) {
      hovered_ = picker().pick(camera_, cursor, document_.selection().mode, pick_options());
    }
  }
  const bool same = before.has_value() == hovered_.has_value() &&
                    (!before || before->element == hovered_->element);
  if (!same || handle_before != hovered_handle_ || box_armed_) {
    update();
  }
  if (document_.has_cage()) {
    Q_EMIT hint(hovered_handle_ != Handle::none && hovered_handle_ != Handle::trackball
                    ? tr("Drag to transform \u00b7 Ctrl: snap \u00b7 Shift: precise")
                : hovered_ ? tr("Click to select \u00b7 Shift: add \u00b7 double click: loop")
                           : tr("Drag to select by a box \u00b7 Ctrl: lasso \u00b7 middle button: "
                                "orbit \u00b7 wheel: zoom"));
  }
}

// ---------------------------------------------------------------- the mouse

void Viewport::mousePressEvent(QMouseEvent* event) {
  setFocus();
  cursor_ = pixel_of(event->position());
  if (drag_.is_active()) {
    if (event->button() == Qt::LeftButton) {
      drag_.confirm();
      end_drag();
    } else if (event->button() == Qt::RightButton) {
      drag_.cancel();
      end_drag();
    }
    return;
  }
  const Qt::KeyboardModifiers modifiers = event->modifiers();
  const bool alt_left = event->button() == Qt::LeftButton && modifiers.testFlag(Qt::AltModifier);
  if (event->button() == Qt::MiddleButton || alt_left) {
    gesture_ = modifiers.testFlag(Qt::ShiftModifier)     ? Gesture::pan
               : modifiers.testFlag(Qt::ControlModifier) ? Gesture::zoom
                                                         : Gesture::orbit;
    return;
  }
  if (event->button() == Qt::RightButton && (box_armed_ || gesture_ != Gesture::none)) {
    box_armed_ = false;
    gesture_ = Gesture::none;
    update();
    return;
  }
  if (event->button() != Qt::LeftButton || !document_.has_cage()) {
    return;
  }
  refresh_graph();
  if (!box_armed_) {
    if (const std::optional<GizmoFrame> frame = gizmo()) {
      const Handle handle = handle_at(camera_, tool_kind(), *frame, cursor_);
      // The ball of the rotation gizmo lies over what one may want to click.
      const bool grabs =
          handle != Handle::none && (handle != Handle::trackball ||
                                     !picker().pick(camera_, cursor_, document_.selection().mode,
                                                    {.radius = 6, .see_through = false}) ||
                                     document_.selection().mode == SelectionMode::face);
      if (grabs) {
        begin_transform(tool_kind(), handle);
        gesture_ = Gesture::transform;
        return;
      }
    }
  }
  gesture_ = Gesture::press;
  press_ = {cursor_, modifiers, {}};
  if (!box_armed_) {
    press_.pick = picker().pick(camera_, cursor_, document_.selection().mode, pick_options());
  }
}

void Viewport::mouseMoveEvent(QMouseEvent* event) {
  const Pixel at = pixel_of(event->position());
  const Pixel moved = at - cursor_;
  cursor_ = at;
  if (drag_.is_active()) {
    drag_.set_snapping(document_.tools().snap != event->modifiers().testFlag(Qt::ControlModifier));
    drag_.set_precise(event->modifiers().testFlag(Qt::ShiftModifier));
    drag_.move(at);
    apply_drag();
    return;
  }
  switch (gesture_) {
  case Gesture::orbit:
    camera_.orbit(moved);
    camera_moved();
    break;
  case Gesture::pan:
    camera_.pan(moved);
    camera_moved();
    break;
  case Gesture::zoom:
    camera_.zoom(-moved.y() / 20, Pixel(camera_.width() / 2, camera_.height() / 2));
    camera_moved();
    break;
  case Gesture::press: {
    if ((at - press_.at).norm() < drag_distance) {
      break;
    }
    // A vertex or an edge that is dragged moves; everything else starts an outline.
    const bool plain = press_.modifiers == Qt::NoModifier;
    const bool lasso = press_.modifiers.testFlag(Qt::ControlModifier) ||
                       document_.tools().tool == Tool::select_lasso;
    if (press_.pick && press_.pick->mode != SelectionMode::face && plain && has_gizmo_tool()) {
      const Selection found = selection_of(*press_.pick);
      const Selection& now = document_.selection();
      if (!(combined(now, found, Combine::add) == now)) {
        editor_.select(found);
      }
      cursor_ = press_.at;
      begin_transform(TransformKind::translate);
      cursor_ = at;
      if (drag_.is_active()) {
        gesture_ = Gesture::transform;
        drag_.move(at);
        apply_drag();
        break;
      }
    }
    gesture_ = lasso && !box_armed_ ? Gesture::lasso : Gesture::box;
    lasso_ = {press_.at, at};
    update();
    break;
  }
  case Gesture::lasso:
    if ((lasso_.back() - at).norm() > 2) {
      lasso_.push_back(at);
    }
    update();
    break;
  case Gesture::box:
    update();
    break;
  case Gesture::none:
  case Gesture::transform:
    hover(at);
    break;
  }
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
  cursor_ = pixel_of(event->position());
  const Gesture gesture = gesture_;
  switch (gesture) {
  case Gesture::transform:
    if (event->button() == Qt::LeftButton) {
      drag_.confirm();
      end_drag();
    }
    break;
  case Gesture::press:
    gesture_ = Gesture::none;
    if (event->button() == Qt::LeftButton) {
      box_armed_ = false;
      click(press_);
    }
    break;
  case Gesture::box:
  case Gesture::lasso:
    finish_outline(event->modifiers() | press_.modifiers);
    break;
  case Gesture::none:
  case Gesture::orbit:
  case Gesture::pan:
  case Gesture::zoom:
    gesture_ = Gesture::none;
    break;
  }
  if (!drag_.is_active()) {
    hover(cursor_);
  }
}

void Viewport::mouseDoubleClickEvent(QMouseEvent* event) {
  if (drag_.is_active() || event->button() != Qt::LeftButton || !document_.has_cage()) {
    mousePressEvent(event);
    return;
  }
  refresh_graph();
  // The loop of the edge under the cursor, in any mode.
  const Pixel at = pixel_of(event->position());
  const std::optional<Pick> edge = picker().pick(camera_, at, SelectionMode::edge, pick_options());
  if (!edge) {
    mousePressEvent(event);
    return;
  }
  const Selection& now = document_.selection();
  Selection loop;
  loop.mode = SelectionMode::edge;
  std::vector<Index> numbers = edge_loop(edge->element, graph_);
  std::sort(numbers.begin(), numbers.end());
  if (now.mode == SelectionMode::face) {
    loop = {};
    loop.mode = SelectionMode::face;
    loop.faces = face_ring(edge->element, graph_);
  } else {
    for (const Index e : numbers) {
      loop.edges.push_back(graph_.edge(e));
    }
    loop = converted(loop, now.mode, graph_);
  }
  const bool adds = event->modifiers().testFlag(Qt::ShiftModifier);
  editor_.select(combined(now, loop, adds ? Combine::add : Combine::replace));
}

void Viewport::wheelEvent(QWheelEvent* event) {
  const QPoint pixels = event->pixelDelta();
  const double steps = event->angleDelta().y() / 120.0;
  if (drag_.is_active()) {
    ToolSettings tools = document_.tools();
    if (tools.proportional && steps != 0) {
      tools.proportional_radius =
          std::clamp(tools.proportional_radius * std::pow(1.15, steps), 1e-3, 10.0);
      document_.set_tools(tools);
      target_.set_radius(tools.proportional_radius * document_.diagonal());
      apply_drag();
    }
  } else if (!pixels.isNull() && event->modifiers().testFlag(Qt::ShiftModifier)) {
    camera_.pan(Pixel(pixels.x(), pixels.y())); // two fingers on a track pad
    camera_moved();
  } else if (steps != 0) {
    camera_.zoom(steps, pixel_of(event->position()));
    camera_moved();
  }
  event->accept();
}

void Viewport::leaveEvent(QEvent* /*event*/) {
  forget_hover();
  Q_EMIT hint(QString());
  update();
}

void Viewport::focusOutEvent(QFocusEvent* event) {
  if (event->reason() != Qt::PopupFocusReason && box_armed_) {
    box_armed_ = false;
    update();
  }
  QOpenGLWidget::focusOutEvent(event);
}

// ---------------------------------------------------------------- transformations

bool Viewport::has_gizmo_tool() const {
  const Tool tool = document_.tools().tool;
  return tool == Tool::translate || tool == Tool::rotate || tool == Tool::scale;
}

TransformKind Viewport::tool_kind() const {
  switch (document_.tools().tool) {
  case Tool::rotate:
    return TransformKind::rotate;
  case Tool::scale:
    return TransformKind::scale;
  default:
    return TransformKind::translate;
  }
}

void Viewport::begin_transform(TransformKind kind, Handle handle) {
  if (!document_.has_cage() || document_.selection().empty() || drag_.is_active()) {
    return;
  }
  document_.adopt_shown_cage();
  refresh_graph();
  const ToolSettings& tools = document_.tools();
  const PolygonMesh cage = shown_cage();
  const std::vector<Index> vertices = vertices_of(document_.selection(), graph_);
  if (vertices.empty()) {
    return;
  }
  TransformOptions options;
  options.proportional = {.enabled = tools.proportional,
                          .radius = tools.proportional_radius * document_.diagonal(),
                          .falloff = tools.falloff,
                          .connected_only = tools.connected_only};
  options.pivot = tools.pivot;
  moving_ = vertices;
  if (tools.symmetric) {
    options.symmetry = cage_symmetry(document_);
    if (!options.symmetry) {
      Q_EMIT editor_.message(tr("the cage is not symmetric about that plane"));
    }
  }
  if (tools.proportional || options.symmetry) {
    moving_.resize(cage.positions.size());
    std::iota(moving_.begin(), moving_.end(), Index{0});
  }
  target_ = TransformTarget(cage.positions, vertices, graph_, options);

  DragScene scene;
  scene.camera = camera_;
  scene.pivot = pivot_of(cage.positions, vertices, tools.pivot);
  scene.local = local_axes(cage, graph_, vertices);
  scene.axes = tools.axes;
  scene.unit = document_.diagonal();
  scene.snap_step = tools.snap_step;
  scene.snap_angle_degrees = tools.snap_angle_degrees;
  scene.snap_scale = tools.snap_scale;
  forget_hover();
  editor_.begin_move(moving_);
  drag_.begin(kind, scene, cursor_, handle);
  drag_.set_snapping(tools.snap);
  update_caption();
  update();
}

void Viewport::extrude() {
  if (!perform(CageAction::extrude, editor_)) {
    return;
  }
  begin_transform(TransformKind::translate);
  if (drag_.is_active()) { // along z of the local frame, which is the normal
    drag_.key('z');
    if (document_.tools().axes != AxesKind::local) {
      drag_.key('z');
    }
    update_caption();
  }
}

void Viewport::apply_drag() {
  const std::vector<Vec3> all = target_.moved(drag_.transform());
  std::vector<Vec3> positions;
  positions.reserve(moving_.size());
  for (const Index v : moving_) {
    positions.push_back(all[v]);
  }
  editor_.move_to(positions);
  update_caption();
  update();
}

void Viewport::end_drag() {
  gesture_ = Gesture::none;
  if (drag_.state() == TransformDrag::State::confirmed) {
    switch (drag_.kind()) {
    case TransformKind::translate:
      editor_.end_move(tr("Move"));
      break;
    case TransformKind::rotate:
      editor_.end_move(tr("Rotate"));
      break;
    case TransformKind::scale:
      editor_.end_move(tr("Scale"));
      break;
    }
  } else {
    editor_.cancel_move();
  }
  caption_.clear();
  picker_.reset();
  Q_EMIT hint(QString());
  update();
}

void Viewport::update_caption() {
  caption_ = QString::fromStdString(drag_.caption());
  Q_EMIT hint(tr("X, Y, Z: axis (Shift: plane) \u00b7 digits: exact value \u00b7 Enter or click: "
                 "done \u00b7 Esc: cancel"));
}

// ---------------------------------------------------------------- keys

/// While something is being transformed all keys belong to it, whatever shortcuts they are
/// elsewhere.
bool Viewport::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    // Digits of the keypad look from the sides; the same digits elsewhere may be shortcuts.
    const bool keypad = key->modifiers().testFlag(Qt::KeypadModifier);
    if (drag_.is_active() || keypad || (box_armed_ && key->key() == Qt::Key_Escape)) {
      event->accept();
      return true;
    }
  }
  // Tab would leave the viewport.
  if (event->type() == QEvent::KeyPress && drag_.is_active()) {
    keyPressEvent(static_cast<QKeyEvent*>(event));
    return true;
  }
  return QOpenGLWidget::event(event);
}

bool Viewport::drag_key(QKeyEvent* event) {
  if (!drag_.is_active()) {
    return false;
  }
  char key = 0;
  switch (event->key()) {
  case Qt::Key_Return:
  case Qt::Key_Enter:
  case Qt::Key_Space:
    key = TransformDrag::enter;
    break;
  case Qt::Key_Escape:
    key = TransformDrag::escape;
    break;
  case Qt::Key_Backspace:
    key = TransformDrag::backspace;
    break;
  case Qt::Key_Tab:
    key = TransformDrag::tab;
    break;
  case Qt::Key_Control:
    drag_.set_snapping(!document_.tools().snap);
    apply_drag();
    return true;
  case Qt::Key_Shift:
    drag_.set_precise(true);
    return true;
  default:
    if (event->key() >= Qt::Key_A && event->key() <= Qt::Key_Z) {
      key = static_cast<char>('a' + event->key() - Qt::Key_A);
    } else if (event->key() >= Qt::Key_Space && event->key() < Qt::Key_A) {
      key = static_cast<char>(event->key());
    }
    break;
  }
  const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
  if (key == 0 || !drag_.key(key, shift)) {
    return true; // other keys wait until it is over
  }
  if (drag_.is_active() || drag_.state() == TransformDrag::State::confirmed) {
    apply_drag();
  }
  if (!drag_.is_active()) {
    end_drag();
  }
  return true;
}

bool Viewport::camera_key(QKeyEvent* event) {
  const bool keypad = event->modifiers().testFlag(Qt::KeypadModifier);
  const bool opposite = event->modifiers().testFlag(Qt::ControlModifier);
  if (keypad) {
    switch (event->key()) {
    case Qt::Key_1:
    case Qt::Key_End:
      set_standard_view(opposite ? "back" : "front");
      return true;
    case Qt::Key_3:
    case Qt::Key_PageDown:
      set_standard_view(opposite ? "left" : "right");
      return true;
    case Qt::Key_7:
    case Qt::Key_Home:
      set_standard_view(opposite ? "bottom" : "top");
      return true;
    case Qt::Key_9:
      camera_.look_opposite();
      camera_moved();
      return true;
    case Qt::Key_5:
    case Qt::Key_Clear:
      set_orthographic(!orthographic());
      return true;
    case Qt::Key_4:
    case Qt::Key_Left:
      camera_.orbit({camera_.height() / 12, 0});
      camera_moved();
      return true;
    case Qt::Key_6:
    case Qt::Key_Right:
      camera_.orbit({-camera_.height() / 12, 0});
      camera_moved();
      return true;
    case Qt::Key_8:
    case Qt::Key_Up:
      camera_.orbit({0, camera_.height() / 12});
      camera_moved();
      return true;
    case Qt::Key_2:
    case Qt::Key_Down:
      camera_.orbit({0, -camera_.height() / 12});
      camera_moved();
      return true;
    default:
      return false;
    }
  }
  switch (event->key()) {
  case Qt::Key_F:
    frame_selection();
    return true;
  case Qt::Key_Home:
    frame_all();
    return true;
  case Qt::Key_Left:
    camera_.orbit({40, 0});
    break;
  case Qt::Key_Right:
    camera_.orbit({-40, 0});
    break;
  case Qt::Key_Up:
    camera_.orbit({0, 40});
    break;
  case Qt::Key_Down:
    camera_.orbit({0, -40});
    break;
  default:
    return false;
  }
  camera_moved();
  return true;
}

bool Viewport::edit_key(QKeyEvent* event) {
  const bool control = event->modifiers().testFlag(Qt::ControlModifier);
  const bool alt = event->modifiers().testFlag(Qt::AltModifier);
  const auto does = [&](CageAction action) {
    perform(action, editor_);
    return true;
  };
  if (control) {
    switch (event->key()) {
    case Qt::Key_I:
      return does(CageAction::invert);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      return does(CageAction::grow);
    case Qt::Key_Minus:
      return does(CageAction::shrink);
    case Qt::Key_L:
      return does(CageAction::select_linked);
    case Qt::Key_R:
      return does(CageAction::split_ring);
    default:
      return false;
    }
  }
  switch (event->key()) {
  case Qt::Key_A:
    return does(alt ? CageAction::select_none : CageAction::select_all);
  case Qt::Key_Escape:
    if (box_armed_ || gesture_ == Gesture::box || gesture_ == Gesture::lasso) {
      box_armed_ = false;
      gesture_ = Gesture::none;
      update();
      return true;
    }
    return does(CageAction::select_none);
  case Qt::Key_1:
    return does(CageAction::vertex_mode);
  case Qt::Key_2:
    return does(CageAction::edge_mode);
  case Qt::Key_3:
    return does(CageAction::face_mode);
  case Qt::Key_L:
    return does(CageAction::select_linked);
  case Qt::Key_M:
    return does(CageAction::mirror_selection);
  case Qt::Key_Delete:
  case Qt::Key_X:
    return does(CageAction::remove);
  case Qt::Key_E:
    extrude();
    return true;
  case Qt::Key_B:
    box_armed_ = document_.has_cage();
    update();
    return true;
  case Qt::Key_G:
    begin_transform(TransformKind::translate);
    return true;
  case Qt::Key_R:
    begin_transform(TransformKind::rotate);
    return true;
  case Qt::Key_S:
    begin_transform(TransformKind::scale);
    return true;
  case Qt::Key_O: {
    ToolSettings tools = document_.tools();
    tools.proportional = !tools.proportional;
    document_.set_tools(tools);
    return true;
  }
  default:
    return false;
  }
}

void Viewport::keyPressEvent(QKeyEvent* event) {
  if (drag_key(event) || camera_key(event) || edit_key(event)) {
    event->accept();
    return;
  }
  QOpenGLWidget::keyPressEvent(event);
}

void Viewport::keyReleaseEvent(QKeyEvent* event) {
  if (drag_.is_active() && event->key() == Qt::Key_Shift) {
    drag_.set_precise(false);
    event->accept();
    return;
  }
  if (drag_.is_active() && event->key() == Qt::Key_Control) {
    drag_.set_snapping(document_.tools().snap);
    apply_drag();
    event->accept();
    return;
  }
  QOpenGLWidget::keyReleaseEvent(event);
}

} // namespace cagewright::app
