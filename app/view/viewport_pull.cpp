// Dragging the model itself: the cage is solved for.
#include "app/view/viewport.h"

#include "app/document/binding.h"
#include "app/edit/surface_pick.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace cagewright::app {
namespace {

constexpr double pin_radius = 10; // so near to a pin the pointer takes it, in pixels

/// The weights of a point on a triangle of the model, as the triangle's corners have them.
std::shared_ptr<const std::vector<double>>
weights_at(const Coordinates& coordinates, const std::array<Vec3, 3>& corners, const Vec3& shares) {
  constexpr std::size_t stride = 16;
  std::vector<double> of_corners(stride * coordinates.columns());
  coordinates.solve(corners, std::span<double>(of_corners), stride);
  std::vector<double> weights(coordinates.columns());
  for (std::size_t c = 0; c < weights.size(); ++c) {
    for (int k = 0; k < 3; ++k) {
      weights[c] += shares[k] * of_corners[c * stride + static_cast<std::size_t>(k)];
    }
  }
  return std::make_shared<const std::vector<double>>(std::move(weights));
}

} // namespace

std::optional<std::size_t> Viewport::pin_at(const Pixel& cursor) const {
  std::optional<std::size_t> nearest;
  double distance = pin_radius;
  const std::vector<Pin>& pins = document_.state().pins;
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const std::optional<Projected> at = camera_.project(document_.place_of(pins[i]));
    if (at && (at->pixel - cursor).norm() <= distance) {
      distance = (at->pixel - cursor).norm();
      nearest = i;
    }
  }
  return nearest;
}

std::optional<Pin> Viewport::new_pin(const Pixel& cursor) const {
  const TriangleView shown{document_.model_positions(), document_.model_triangles()};
  const std::optional<SurfacePoint> hit = first_surface_point(shown, camera_.ray(cursor));
  if (!hit) {
    return std::nullopt;
  }
  const Model& model = *document_.model();
  if (const auto& region = document_.state().region) {
    for (const Index v : model.triangles[hit->triangle]) {
      if (!std::ranges::binary_search(region->vertices, v)) {
        return std::nullopt; // it stays where it is
      }
    }
  }
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = model.mesh.positions[model.triangles[hit->triangle][k]];
  }
  return Pin{hit->triangle, hit->shares,
             weights_at(document_.state().binding->coordinates(), corners, hit->shares)};
}

/// With the tool: a press on a pin drags it, one on the model makes a pin there.
bool Viewport::pull_press(const Qt::KeyboardModifiers& modifiers) {
  if (document_.tools().tool != Tool::pull || !document_.has_model()) {
    return false;
  }
  if (document_.mode() != Mode::deform) {
    Q_EMIT editor_.message(tr("bind the model to its cage first: then it can be dragged"));
    return true;
  }
  const Coordinates& coordinates = document_.state().binding->coordinates();
  if (coordinates.columns() != document_.cage_rest().positions.size()) {
    Q_EMIT editor_.message(tr("these coordinates follow the cage's faces, too: drag the cage, or "
                              "choose mean value to drag the model"));
    return true;
  }
  std::vector<Pin> pins = document_.state().pins;
  std::optional<std::size_t> pin = pin_at(cursor_);
  if (pin && modifiers.testFlag(Qt::ControlModifier)) {
    pins.erase(pins.begin() + static_cast<std::ptrdiff_t>(*pin));
    editor_.set_pins(std::move(pins), tr("Remove Pin"));
    return true;
  }
  const bool is_new = !pin;
  if (is_new) {
    std::optional<Pin> made = new_pin(cursor_);
    if (!made) {
      return false; // beside the model
    }
    pins.push_back(*std::move(made));
    pin = pins.size() - 1;
  }
  editor_.begin_step();
  document_.adopt_shown_cage();
  if (is_new) {
    editor_.set_pins(pins, {});
  }
  refresh_graph();
  Pull pull;
  pull.pin = *pin;
  pull.is_new = is_new;
  pull.pressed = cursor_;
  const std::span<const Vec3> cage = document_.shown_cage_positions();
  pull.cage.assign(cage.begin(), cage.end());
  std::vector<std::vector<double>> weights;
  for (const Pin& p : pins) {
    weights.push_back(*p.weights);
    pull.targets.push_back(document_.place_of(p));
  }
  pull.from = pull.targets[*pin];
  const std::optional<Projected> at = camera_.project(pull.from);
  pull.offset = at ? Pixel(at->pixel - cursor_) : Pixel(Pixel::Zero());
  pull.solver = CagePull(graph_, weights);
  pull_ = std::move(pull);
  gesture_ = Gesture::pull;
  Q_EMIT hint(
      tr("Drag: the cage is bent so that this point of the model comes along, and the other "
         "pins stay \u00b7 Esc: take it back"));
  update();
  return true;
}

void Viewport::pull_move() {
  constexpr double begins_after = 3; // pixels: a click does not move
  if (!pull_ || (!pull_->moves && (cursor_ - pull_->pressed).norm() < begins_after)) {
    return;
  }
  if (!pull_->moves) {
    std::vector<Index> all(pull_->cage.size());
    std::iota(all.begin(), all.end(), Index{0});
    editor_.begin_move(std::move(all));
    pull_->moves = true;
  }
  if (!editor_.moving()) { // something else was done meanwhile
    end_pull(false);
    return;
  }
  pull_->targets[pull_->pin] = camera_.at_depth_of(pull_->from, cursor_ + pull_->offset);
  editor_.move_to(pull_->solver.pulled(pull_->cage, pull_->targets));
  update();
}

void Viewport::end_pull(bool keep) {
  if (!pull_) {
    return;
  }
  const Pull pull = std::move(*pull_);
  pull_.reset();
  gesture_ = Gesture::none;
  if (!keep) {
    editor_.cancel_step();
  } else if (pull.moves) {
    editor_.end_move(tr("Drag Model"));
    editor_.end_step(tr("Drag Model"));
  } else if (pull.is_new) {
    editor_.end_step(tr("Add Pin"));
  } else {
    editor_.cancel_step();
  }
  picker_.reset();
  Q_EMIT hint(QString());
  update();
}

void Viewport::remove_pins() {
  if (document_.state().pins.empty() || pull_) {
    return;
  }
  editor_.set_pins({}, tr("Remove Pins"));
}

} // namespace cagewright::app
