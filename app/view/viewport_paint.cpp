// Painting on the model: where the cage is to be finer, and what it is for.
#include "app/view/viewport.h"

#include "app/edit/density_brush.h"
#include "app/edit/surface_pick.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cagewright::app {

namespace {

constexpr double whole = 1e6; // of a brush that knows no half

} // namespace

/// What of the model lies under the brush, as it is shown.
std::optional<Dab> Viewport::dab_at(const Pixel& cursor) const {
  if (!document_.has_model()) {
    return std::nullopt;
  }
  const Model& model = *document_.model();
  const std::span<const Vec3> positions = document_.model_positions();
  const std::span<const Vec3> normals = document_.model_normals();
  const Ray sight = camera_.ray(cursor);
  Triangle corners;
  Dab dab;
  if (document_.deformed()) {
    // A stroke has many dabs: of large models the fewer triangles are near enough.
    const bool quick = !model.coarse.empty();
    const std::span<const Triangle> triangles =
        quick ? document_.coarse_triangles() : document_.model_triangles();
    const auto hit = first_surface_point({positions, triangles}, sight);
    if (!hit) {
      return std::nullopt;
    }
    corners = triangles[hit->triangle];
    dab.place = sight.at(hit->distance);
  } else {
    const RayHit hit = model.bvh.first_hit(sight.origin, sight.direction);
    if (!hit) {
      return std::nullopt;
    }
    corners = model.triangles[hit.triangle];
    dab.place = sight.at(hit.distance);
  }
  const Vec3& a = positions[corners[0]];
  const Vec3 normal = (positions[corners[1]] - a).cross(positions[corners[2]] - a);
  // Normals of the model's vertices need not look outward: the side is theirs.
  const Vec3 of_corners = normals[corners[0]] + normals[corners[1]] + normals[corners[2]];
  dab.normal = of_corners.norm() > 0 ? Vec3(of_corners.normalized())
               : normal.norm() > 0   ? Vec3(normal.normalized())
                                     : camera_.to_viewer(dab.place);
  dab.radius = document_.tools().brush_radius * camera_.pixel_size(dab.place);
  return dab;
}

bool Viewport::paint_press(const Qt::KeyboardModifiers& modifiers) {
  const Tool tool = document_.tools().tool;
  if (!is_brush(tool) || !document_.has_model()) {
    return false;
  }
  if (document_.mode() == Mode::deform && tool != Tool::mix) {
    Q_EMIT editor_.message(tr("go back to refining first: the next cage is made for the model at "
                              "rest"));
    return true;
  }
  if (outlines_region() && modifiers.testFlag(Qt::ControlModifier)) {
    return false; // a lasso
  }
  editor_.begin_step(); // the stroke may come from beside the model
  stroke_.emplace();
  stroke_->tool = tool;
  stroke_->chooses = tool == Tool::region;
  stroke_->erases = modifiers.testFlag(Qt::ShiftModifier);
  stroke_->sign = modifiers.testFlag(Qt::ControlModifier) ? -1 : 1;
  stroke_->last = cursor_;
  const State& state = document_.state();
  const auto& before = tool == Tool::mix ? state.mix : state.density;
  if (before && !stroke_->chooses) {
    stroke_->density = *before;
  } else {
    stroke_->density.assign(document_.model_positions().size(), 0.0F);
  }
  if (state.region && stroke_->chooses) {
    for (const Index v : state.region->vertices) {
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
  if (count > 0 && !first) {
    stroke_->last += way * (count * step / way.norm());
  }
  if (!dabs.empty()) {
    paint_dabs(dabs, document_.model_positions(), document_.model_normals(), stroke_->density,
               stroke_->tool == Tool::mix ? 0.0F : -1.0F);
    stroke_->painted = true;
    show_stroke();
  }
  update();
}

void Viewport::show_stroke() {
  switch (stroke_->tool) {
  case Tool::region:
    dirty_.colors = true;
    break;
  case Tool::mix:
    document_.show_mix(std::make_shared<const std::vector<float>>(stroke_->density));
    break;
  default:
    document_.set_density(std::make_shared<const std::vector<float>>(stroke_->density));
  }
}

void Viewport::end_stroke(bool keep) {
  if (!stroke_) {
    return;
  }
  Stroke stroke = *std::exchange(stroke_, std::nullopt);
  gesture_ = Gesture::none;
  if (stroke.tool == Tool::paint && keep && stroke.painted) {
    editor_.end_step(tr("Paint Density"));
    update();
    return;
  }
  editor_.cancel_step();
  if (stroke.tool == Tool::mix) {
    document_.show_mix(nullptr);
  }
  const bool fits =
      document_.has_model() && stroke.density.size() == document_.model()->mesh.positions.size();
  if (keep && stroke.painted && fits && stroke.tool == Tool::mix) {
    // As files of projects keep it, so that the model follows alike when one is opened again.
    bool any = false;
    for (float& share : stroke.density) {
      share = std::round(100 * share) / 100;
      any = any || share > 0;
    }
    editor_.set_mix(any ? std::make_shared<const std::vector<float>>(std::move(stroke.density))
                        : nullptr,
                    tr("Paint Mix"));
  } else if (keep && stroke.painted && fits && stroke.chooses) {
    std::vector<char> chosen(stroke.density.size());
    std::ranges::transform(stroke.density, chosen.begin(), [](float d) { return d > 0 ? 1 : 0; });
    Q_EMIT regionPainted(faces_within(document_.model()->mesh, chosen));
  }
  dirty_.colors = true;
  update();
}

void Viewport::clear_mix() {
  if (document_.state().mix && !stroke_) {
    editor_.set_mix(nullptr, tr("Clear Painted Mix"));
  }
}

void Viewport::clear_density() {
  if (document_.state().density && !stroke_) {
    editor_.set_density(nullptr, tr("Clear Painted Density"));
  }
}

} // namespace cagewright::app
