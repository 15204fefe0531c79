// Moving, turning and scaling the selection in the viewport.
#include "app/edit/select.h"
#include "app/view/viewport.h"

#include <numeric>

namespace cagewright::app {

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
  if (!document_.has_cage() || drag_.is_active()) {
    return;
  }
  if (document_.selection().empty()) {
    Q_EMIT editor_.message(tr("select something first"));
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
  if (drag_.is_active()) {
    return;
  }
  editor_.begin_step();
  if (!perform(CageAction::extrude, editor_)) {
    editor_.cancel_step();
    return;
  }
  begin_transform(TransformKind::translate);
  if (!drag_.is_active()) {
    editor_.end_step(tr("Extrude"));
    return;
  }
  step_title_ = tr("Extrude");
  // Along z of the local frame, which is the normal.
  drag_.key('z');
  if (document_.tools().axes != AxesKind::local) {
    drag_.key('z');
  }
  update_caption();
}

void Viewport::apply_drag() {
  if (!editor_.moving()) { // something else was done meanwhile
    drag_.cancel();
    end_drag();
    return;
  }
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
  if (!step_title_.isEmpty()) {
    if (drag_.state() == TransformDrag::State::confirmed) {
      editor_.end_step(step_title_);
    } else {
      editor_.cancel_step();
    }
    step_title_.clear();
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

} // namespace cagewright::app
