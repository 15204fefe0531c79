// Painting on the model: where the cage is to be finer, and what it is for.
#include "app/view/viewport.h"

#include "app/edit/density_brush.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cagewright::app {

namespace {

constexpr double whole = 1e6; // of a brush that knows no half

} // namespace

/// What of the model lies under the brush.
std::optional<Dab> Viewport::dab_at(const Pixel& cursor) const {
  if (!document_.has_model()) {
    return std::nullopt;
  }
  const Model& model = *document_.model();
  const Ray sight = camera_.ray(cursor);
  const RayHit hit = model.bvh.first_hit(sight.origin, sight.direction);
  if (!hit) {
    return std::nullopt;
  }
  const auto& [a, b, c] = model.bvh.corners(hit.triangle);
  Dab dab;
  dab.place = sight.at(hit.distance);
  const Vec3 normal = (b - a).cross(c - a);
  // Normals of the model's vertices need not look outward: the side is theirs.
  const Triangle& corners = model.triangles[hit.triangle];
  const Vec3 of_corners =
      model.normals[corners[0]] + model.normals[corners[1]] + model.normals[corners[2]];
  dab.normal = of_corners.norm() > 0 ? Vec3(of_corners.normalized())
               : normal.norm() > 0   ? Vec3(normal.normalized())
                                     : camera_.to_viewer(dab.place);
  dab.radius = document_.tools().brush_radius * camera_.pixel_size(dab.place);
  return dab;
}

bool Viewport::paint_press(const Qt::KeyboardModifiers& modifiers) {
  if (!is_brush(document_.tools().tool) || !document_.has_model()) {
    return false;
  }
  if (document_.mode() == Mode::deform) {
    Q_EMIT editor_.message(tr("go back to refining first: the next cage is made for the model at "
                              "rest"));
    return true;
  }
  if (outlines_region() && modifiers.testFlag(Qt::ControlModifier)) {
    return false; // a lasso
  }
  editor_.begin_step(); // the stroke may come from beside the model
  stroke_.emplace();
  stroke_->chooses = document_.tools().tool == Tool::region;
  stroke_->erases = modifiers.testFlag(Qt::ShiftModifier);
  stroke_->sign = modifiers.testFlag(Qt::ControlModifier) ? -1 : 1;
  stroke_->last = cursor_;
  const SharedDensity& before = document_.state().density;
  if (before && !stroke_->chooses) {
    stroke_->density = *before;
  } else {
    stroke_->density.assign(document_.model_positions().size(), 0.0F);
  }
  if (const auto& region = document_.state().region; region && stroke_->chooses) {
    for (const Index v : region->vertices) {
      stroke_->density[v] = 1;
    }
  }
  gesture_ = Gesture::paint;
  add_dabs(true);
  return true;
}

/// Dabs follow each other closely along the way of the pointer, so that a quick stroke is no row of
/// spots.
void Viewport::add_dabs(bool first) {
  const ToolSettings& tools = document_.tools();
  const double step = std::max(1.0, tools.brush_radius / 4);
  const Pixel way = cursor_ - stroke_->last;
  const int count = first ? 1 : static_cast<int>(way.norm() / step);
  const Model& model = *document_.model();
  std::vector<Dab> dabs;
  for (int i = 1; i <= count; ++i) {
    const Pixel at = first ? cursor_ : Pixel(stroke_->last + way * (i * step / way.norm()));
    if (std::optional<Dab> dab = dab_at(at)) {
      // What is chosen is so wholly, out to the rim.
      dab->amount = stroke_->chooses ? whole : stroke_->sign * tools.brush_strength;
      dab->erases = stroke_->erases;
      dabs.push_back(*dab);
    }
  }
  if (!dabs.empty()) {
    paint_dabs(dabs, model.mesh.positions, model.normals, stroke_->density);
    stroke_->painted = true;
  }
  if (count > 0 && !first) {
    stroke_->last += way * (count * step / way.norm());
  }
  if (!dabs.empty() && stroke_->chooses) {
    dirty_.colors = true;
  } else if (!dabs.empty()) {
    document_.set_density(std::make_shared<const std::vector<float>>(stroke_->density));
  }
  update();
}

void Viewport::end_stroke(bool keep) {
  if (!stroke_) {
    return;
  }
  const Stroke stroke = *std::exchange(stroke_, std::nullopt);
  gesture_ = Gesture::none;
  if (stroke.chooses) {
    editor_.cancel_step();
    dirty_.colors = true;
    if (keep && stroke.painted) {
      std::vector<char> chosen(stroke.density.size());
      std::ranges::transform(stroke.density, chosen.begin(), [](float d) { return d > 0 ? 1 : 0; });
      Q_EMIT regionPainted(faces_within(document_.model()->mesh, chosen));
    }
  } else if (keep && stroke.painted) {
    editor_.end_step(tr("Paint Density"));
  } else {
    editor_.cancel_step();
  }
  update();
}

void Viewport::clear_density() {
  if (document_.state().density && !stroke_) {
    editor_.set_density(nullptr, tr("Clear Painted Density"));
  }
}

} // namespace cagewright::app
