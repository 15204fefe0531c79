// What the mouse does in the viewport: looking, selecting, dragging.
#include "app/edit/select.h"
#include "app/view/viewport.h"

#include <QContextMenuEvent>
#include <QMouseEvent>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

// A press becomes a drag when the mouse has gone so far, in pixels.
constexpr double drag_distance = 4;

Pixel pixel_of(const QPointF& p) {
  return {p.x(), p.y()};
}

} // namespace

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

bool Viewport::outlines_region() const {
  return document_.tools().tool == Tool::region && document_.has_model() &&
         document_.mode() == Mode::refine;
}

void Viewport::finish_outline(Qt::KeyboardModifiers modifiers) {
  if (outlines_region()) {
    Q_EMIT regionOutlined({camera_, outline(), document_.tools().see_through},
                          modifiers.testFlag(Qt::ShiftModifier));
  } else if (document_.has_cage()) {
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

bool Viewport::paints_here() const {
  return is_brush(document_.tools().tool) &&
         (document_.mode() == Mode::refine || document_.tools().tool == Tool::mix);
}

void Viewport::forget_hover() {
  hovered_.reset();
  hovered_handle_ = Handle::none;
}

void Viewport::update_cursor() {
  const Tool tool = document_.tools().tool;
  const bool on_handle = hovered_handle_ != Handle::none && hovered_handle_ != Handle::trackball;
  Qt::CursorShape shape = Qt::ArrowCursor;
  if (drag_.is_active()) {
    shape = Qt::SizeAllCursor;
  } else if (gesture_ == Gesture::orbit || gesture_ == Gesture::pan || gesture_ == Gesture::pull) {
    shape = Qt::ClosedHandCursor;
  } else if (gesture_ == Gesture::zoom) {
    shape = Qt::SizeVerCursor;
  } else if (loop_cut_ || box_armed_ || gesture_ == Gesture::box || gesture_ == Gesture::lasso ||
             gesture_ == Gesture::paint) {
    shape = Qt::CrossCursor;
  } else if (tool == Tool::pull && document_.mode() == Mode::deform) {
    shape = pin_at(cursor_) ? Qt::OpenHandCursor : Qt::CrossCursor;
  } else if (on_handle) {
    shape = Qt::SizeAllCursor;
  } else if (tool == Tool::select_box || tool == Tool::select_lasso || is_brush(tool)) {
    shape = Qt::CrossCursor;
  }
  if (shape != cursor().shape()) {
    setCursor(shape);
  }
}

void Viewport::hover(const Pixel& cursor) {
  const std::optional<Pick> before = hovered_;
  const Handle handle_before = hovered_handle_;
  forget_hover();
  if (is_brush(document_.tools().tool)) {
    update(); // the brush goes along
  }
  const bool paints = paints_here();
  if (document_.has_cage() && !drag_.is_active() && !paints) {
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
  if (document_.tools().tool == Tool::paint && document_.has_model()) {
    Q_EMIT hint(tr("Paint: the cage becomes finer here \u00b7 Ctrl: coarser \u00b7 Shift: erase "
                   "\u00b7 Ctrl+wheel: size of the brush"));
  } else if (document_.tools().tool == Tool::mix && document_.has_model()) {
    Q_EMIT hint(
        tr("Paint where the model follows by the kind \"Where painted\" \u00b7 Shift: erase "
           "\u00b7 Ctrl+wheel: size of the brush"));
  } else if (document_.tools().tool == Tool::region && document_.has_model()) {
    Q_EMIT hint(tr("Paint what the cage is for \u00b7 Shift: erase \u00b7 Ctrl: lasso, B: box "
                   "\u00b7 Ctrl+wheel: size of the brush"));
  } else if (document_.tools().tool == Tool::pull && document_.mode() == Mode::deform) {
    Q_EMIT hint(tr("Drag the model \u00b7 click: a pin that holds it \u00b7 Ctrl+click: away with "
                   "the pin"));
  } else if (document_.has_cage()) {
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
  if (loop_cut_press(event->button())) {
    return;
  }
  const Qt::KeyboardModifiers modifiers = event->modifiers();
  if (event->button() == Qt::RightButton && (pull_ || stroke_)) {
    end_pull(false);
    end_stroke(false);
    return;
  }
  if (event->button() == Qt::RightButton && (box_armed_ || gesture_ != Gesture::none)) {
    forget_outline();
    return;
  }
  if (event->button() == Qt::RightButton) {
    menu_press_ = cursor_;
  }
  if (const std::optional<CameraMove> move = camera_move(key_map_, event->button(), modifiers)) {
    begin_camera_move(*move);
    return;
  }
  if (event->button() == Qt::LeftButton && !box_armed_ && gesture_ == Gesture::none &&
      (pull_press(modifiers) || paint_press(modifiers))) {
    return;
  }
  if (event->button() == Qt::LeftButton && outlines_region()) {
    gesture_ = box_armed_ ? Gesture::box : Gesture::lasso;
    press_ = {cursor_, modifiers, {}};
    lasso_ = {cursor_};
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

void Viewport::begin_camera_move(CameraMove move) {
  switch (move) {
  case CameraMove::orbit:
    gesture_ = Gesture::orbit;
    break;
  case CameraMove::pan:
    gesture_ = Gesture::pan;
    break;
  case CameraMove::zoom:
    gesture_ = Gesture::zoom;
    break;
  }
}

void Viewport::mouseMoveEvent(QMouseEvent* event) {
  const Pixel at = pixel_of(event->position());
  const Pixel moved = at - cursor_;
  cursor_ = at;
  if (menu_press_ && (at - *menu_press_).norm() >= drag_distance) {
    menu_press_.reset();
  }
  if (drag_.is_active()) {
    drag_.set_snapping(document_.tools().snap != event->modifiers().testFlag(Qt::ControlModifier));
    drag_.set_precise(event->modifiers().testFlag(Qt::ShiftModifier));
    drag_.move(at);
    apply_drag();
    return;
  }
  if (loop_cut_ && gesture_ == Gesture::none) {
    if (loop_cut_->slides) {
      slide_loop_cut();
    } else {
      aim_loop_cut();
    }
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
    const bool selects =
        box_armed_ || lasso || !plain || document_.tools().tool == Tool::select_box;
    if (turns_beside_the_cage(key_map_) && !selects) {
      gesture_ = Gesture::orbit;
      camera_.orbit(moved);
      camera_moved();
      break;
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
  case Gesture::pull:
    pull_move();
    break;
  case Gesture::paint:
    add_dabs(false);
    break;
  case Gesture::none:
  case Gesture::transform:
    hover(at);
    break;
  }
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
  cursor_ = pixel_of(event->position());
  const bool asks_for_menu = event->button() == Qt::RightButton && menu_press_;
  if (event->button() == Qt::RightButton) {
    menu_press_.reset();
  }
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
  case Gesture::pull:
    if (event->button() == Qt::LeftButton) {
      end_pull(true);
    }
    break;
  case Gesture::paint:
    if (event->button() == Qt::LeftButton) {
      end_stroke(true);
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
  if (!drag_.is_active() && !loop_cut_) {
    hover(cursor_);
  }
  if (asks_for_menu) {
    Q_EMIT menuRequested(event->position().toPoint());
  }
}

/// The mouse asks for the menu when its button is let go: see mouseReleaseEvent(). This is the
/// keyboard's way.
void Viewport::contextMenuEvent(QContextMenuEvent* event) {
  if (event->reason() == QContextMenuEvent::Keyboard && !drag_.is_active() && !loop_cut_) {
    Q_EMIT menuRequested(rect().center());
  }
  event->accept();
}

void Viewport::mouseDoubleClickEvent(QMouseEvent* event) {
  if (drag_.is_active() || loop_cut_ || event->button() != Qt::LeftButton ||
      !document_.has_cage()) {
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
  const double zoom_steps = wheel_reversed_ ? -steps : steps;
  if (is_brush(document_.tools().tool) && event->modifiers().testFlag(Qt::ControlModifier)) {
    ToolSettings tools = document_.tools();
    tools.brush_radius = std::clamp(tools.brush_radius * std::pow(1.15, steps), 4.0, 500.0);
    document_.set_tools(tools);
  } else if (drag_.is_active()) {
    ToolSettings tools = document_.tools();
    if (tools.proportional && steps != 0) {
      tools.proportional_radius =
          std::clamp(tools.proportional_radius * std::pow(1.15, steps), 1e-3, 10.0);
      document_.set_tools(tools);
      target_.set_radius(tools.proportional_radius * document_.diagonal());
      apply_drag();
    }
  } else if (loop_cut_ && !event->modifiers().testFlag(Qt::ControlModifier)) {
    if (steps != 0) {
      add_loop_cuts(steps > 0 ? 1 : -1);
    }
  } else if (!pixels.isNull() && event->modifiers().testFlag(Qt::ShiftModifier)) {
    camera_.pan(Pixel(pixels.x(), pixels.y())); // two fingers on a track pad
    camera_moved();
  } else if (steps != 0) {
    camera_.zoom(zoom_steps, pixel_of(event->position()));
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

} // namespace cagewright::app
