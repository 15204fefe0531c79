// What the viewport draws over the model: the cage, the gizmo, words.
#include "app/document/binding.h"
#include "app/document/generate_settings.h"
#include "app/edit/select.h"
#include "app/view/viewport.h"

#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>

namespace cagewright::app {
namespace {

QColor qt(const Rgb& c, double alpha = 1) {
  return QColor::fromRgbF(c[0], c[1], c[2], static_cast<float>(alpha));
}

void add_circle(const Pixel& middle, double radius, const Color& color, Overlay& overlay) {
  constexpr int parts = 96;
  const auto at = [&](int k) {
    const double angle = 2 * M_PI * k / parts;
    return Vec3(middle.x() + radius * std::cos(angle), middle.y() + radius * std::sin(angle), 0);
  };
  for (int i = 0; i < parts; ++i) {
    overlay.lines.push_back({at(i), at(i + 1), color, 1.3F});
  }
}

} // namespace

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
    if (loop_cut_) {
      for (const auto& [a, b] : loop_cut_->lines) {
        marks.lines.push_back({a, b, color_of(colors_.selected), 2.5F});
      }
    }
    if (document_.tools().tool == Tool::pull) {
      for (std::size_t i = 0; i < document_.state().pins.size(); ++i) {
        const bool is_held = pull_ && pull_->pin == i;
        marks.dots.push_back({document_.place_of(document_.state().pins[i]),
                              color_of(is_held ? colors_.hovered : colors_.selected),
                              is_held ? 7.0F : 5.5F});
      }
    }
    if (layers.problems) {
      add_problems(document_, colors_, marks);
    }
  }
  return marks;
}

std::optional<GizmoFrame> Viewport::gizmo() const {
  if (!document_.has_cage() || document_.selection().empty() || !has_gizmo_tool() ||
      graph_is_stale_ || document_.comparing()) {
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
      add_circle(middle->pixel, target_.options().proportional.radius / camera_.pixel_size(pivot),
                 color_of(colors_.text, 0.6), overlay);
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
  if (is_brush(document_.tools().tool) && document_.has_model() &&
      (gesture_ == Gesture::none || gesture_ == Gesture::paint) && underMouse()) {
    add_circle(cursor_, document_.tools().brush_radius, color_of(colors_.text, 0.7), overlay);
  }
  if (box_armed_ && gesture_ == Gesture::none) {
    const Color color = color_of(colors_.text, 0.4);
    overlay.lines.push_back({{cursor_.x(), 0, 0}, {cursor_.x(), camera_.height(), 0}, color, 1});
    overlay.lines.push_back({{0, cursor_.y(), 0}, {camera_.width(), cursor_.y(), 0}, color, 1});
  }
  return overlay;
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
    if (const std::size_t hidden = document_.state().hidden_faces.size(); hidden > 0) {
      painter.drawText(QRectF(12, 44, width() - 24, 20), Qt::AlignLeft | Qt::AlignVCenter,
                       tr("%1 of %2 faces hidden; Alt+H shows them")
                           .arg(hidden)
                           .arg(document_.cage_rest().face_count()));
    }
  }
  paint_legend(painter);
  paint_names_beside(painter);
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

/// By which coordinates each of the two follows.
void Viewport::paint_names_beside(QPainter& painter) const {
  const State& state = document_.state();
  if (!document_.deformed_beside() || !state.binding || !document_.beside()) {
    return;
  }
  const Vec3 middle = document_.model()->box.center();
  const auto name = [&](const Binding& binding, const Vec3& at) {
    if (const std::optional<Projected> seen = camera_.project(at)) {
      const CoordinateChoice& choice = binding.choice();
      QString label = label_of_coordinates(choice.first);
      if (choice.mixes()) {
        label = tr("%1 and %2").arg(label, label_of_coordinates(*choice.second).toLower());
      }
      painter.drawText(QRectF(seen->pixel.x() - 120, height() - 34, 240, 20), Qt::AlignCenter,
                       label);
    }
  };
  painter.setPen(qt(colors_.text, 0.95));
  name(*state.binding, middle);
  name(*document_.beside(), middle + document_.way_beside());
}

void Viewport::paint_legend(QPainter& painter) const {
  const Layers& layers = document_.layers();
  const bool mix = document_.tools().tool == Tool::mix && document_.has_model();
  const bool weights = !mix && layers.weights && !document_.model_weights().empty();
  const bool distance = layers.distance && !document_.cage_distances().empty();
  if (!mix && !weights && !distance) {
    return;
  }
  const QRectF bar(width() - 192, height() - 34, 170, 10);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  constexpr int steps = 60;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const auto weight = static_cast<float>(least_weight + t * (1 - least_weight));
    gradient.setColorAt(t, qt(mix       ? share_rgb(static_cast<float>(t), colors_.model)
                              : weights ? weight_rgb(weight)
                                        : scale_color(t)));
  }
  painter.save();
  painter.setPen(QPen(qt(colors_.text, 0.5), 1));
  painter.setBrush(gradient);
  painter.drawRect(bar);
  painter.setPen(qt(colors_.text, 0.85));
  const auto say = [&](const QString& what, const QString& least, const QString& most) {
    painter.drawText(bar.adjusted(-120, -20, 0, -12), Qt::AlignRight | Qt::AlignVCenter, what);
    const QRectF below = bar.adjusted(-60, 11, 0, 19);
    painter.drawText(below.adjusted(60, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, least);
    painter.drawText(below, Qt::AlignRight | Qt::AlignVCenter, most);
  };
  if (mix) {
    say(tr("share of what is painted"), "0", "1");
  } else if (weights) {
    say(tr("weight of the selection"), locale().toString(least_weight, 'g', 2), "1");
    const double zero = bar.left() - least_weight / (1 - least_weight) * bar.width();
    painter.drawLine(QPointF(zero, bar.top()), QPointF(zero, bar.bottom()));
    painter.drawText(QRectF(zero - 20, bar.top() + 11, 40, bar.height() + 8), Qt::AlignCenter, "0");
  } else {
    say(tr("distance to the model"), "0", tr("8 % of the diagonal"));
  }
  painter.restore();
}

} // namespace cagewright::app
