// What keys do in the viewport.
#include "app/view/viewport.h"

#include <QKeyEvent>

namespace cagewright::app {

/// While something is being transformed all keys belong to it, whatever shortcuts they are
/// elsewhere.
bool Viewport::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride) {
    const auto* key = static_cast<QKeyEvent*>(event);
    // Digits of the keypad look from the sides; the same digits elsewhere may be shortcuts.
    const bool keypad = key->modifiers().testFlag(Qt::KeypadModifier);
    const bool outlines = gesture_ == Gesture::box || gesture_ == Gesture::lasso;
    const bool ends = key->key() == Qt::Key_Escape || key->matches(QKeySequence::Undo);
    if (drag_.is_active() || loop_cut_ || keypad || ((pull_ || stroke_) && ends) ||
        ((box_armed_ || outlines) && ends)) {
      event->accept();
      return true;
    }
  }
  // Tab would leave the viewport.
  if (event->type() == QEvent::KeyPress && (drag_.is_active() || loop_cut_)) {
    keyPressEvent(static_cast<QKeyEvent*>(event));
    update_cursor();
    return true;
  }
  const bool taken = QOpenGLWidget::event(event);
  switch (event->type()) {
  case QEvent::Enter:
  case QEvent::MouseButtonPress:
  case QEvent::MouseButtonRelease:
  case QEvent::MouseMove:
  case QEvent::KeyPress:
  case QEvent::KeyRelease:
    update_cursor();
    break;
  default:
    break;
  }
  return taken;
}

bool Viewport::drag_key(QKeyEvent* event) {
  if (!drag_.is_active()) {
    return false;
  }
  const bool undoes = event->matches(QKeySequence::Undo);
  const bool with_modifier =
      (event->modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) != 0;
  const bool ends = event->key() == Qt::Key_Escape || event->key() == Qt::Key_Return ||
                    event->key() == Qt::Key_Enter || event->key() == Qt::Key_Control;
  if (with_modifier && !undoes && !ends) {
    return true; // shortcuts of elsewhere wait until it is over
  }
  char key = undoes ? TransformDrag::escape : '\0';
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
    if (key == TransformDrag::escape) {
      break;
    }
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

void Viewport::forget_outline() {
  box_armed_ = false;
  gesture_ = Gesture::none;
  lasso_.clear();
  update();
}

/// Letters that are tools in Maya: menus and tool bar have them as shortcuts, too, but let them go
/// on here while they cannot be used.
bool Viewport::maya_key(QKeyEvent* event) {
  if (key_map_ != KeyMap::maya || (event->modifiers() & ~Qt::ShiftModifier) != 0) {
    return false;
  }
  const auto take = [this](Tool tool) {
    ToolSettings tools = document_.tools();
    tools.tool = tool;
    document_.set_tools(tools);
    return true;
  };
  switch (event->key()) {
  case Qt::Key_Q:
    return take(Tool::select_box);
  case Qt::Key_W:
    return take(Tool::translate);
  case Qt::Key_E:
    return take(Tool::rotate);
  case Qt::Key_R:
    return take(Tool::scale);
  case Qt::Key_A:
    frame_all();
    return true;
  case Qt::Key_S:
    return true;
  default:
    return false;
  }
}

bool Viewport::edit_key(QKeyEvent* event) {
  if (pull_ || stroke_) {
    if (event->key() == Qt::Key_Escape || event->matches(QKeySequence::Undo)) {
      end_pull(false);
      end_stroke(false);
    }
    return true; // other keys wait until it is over
  }
  const bool control = event->modifiers().testFlag(Qt::ControlModifier);
  const bool alt = event->modifiers().testFlag(Qt::AltModifier);
  if (event->matches(QKeySequence::Undo) &&
      (box_armed_ || gesture_ == Gesture::box || gesture_ == Gesture::lasso)) {
    forget_outline();
    return true;
  }
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
      begin_loop_cut();
      return true;
    default:
      return false;
    }
  }
  switch (event->key()) {
  case Qt::Key_A:
    return does(alt ? CageAction::select_none : CageAction::select_all);
  case Qt::Key_Escape:
    if (box_armed_ || gesture_ == Gesture::box || gesture_ == Gesture::lasso) {
      forget_outline();
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
    box_armed_ = document_.has_cage() || outlines_region();
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
  case Qt::Key_H:
    return does(alt ? CageAction::reveal : CageAction::hide);
  case Qt::Key_Slash:
    return does(CageAction::isolate);
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
  if (drag_key(event) || loop_cut_key(event) || maya_key(event) || camera_key(event) ||
      edit_key(event)) {
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
