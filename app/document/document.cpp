#include "app/document/document.h"

#include "app/document/time_line.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <utility>

namespace cagewright::app {
namespace {

bool same_topology(const PolygonMesh& a, const PolygonMesh& b) {
  if (a.positions.size() != b.positions.size() || a.face_count() != b.face_count()) {
    return false;
  }
  for (std::size_t f = 0; f < a.face_count(); ++f) {
    if (!std::ranges::equal(a.face(f), b.face(f))) {
      return false;
    }
  }
  return true;
}

/// A selection may outlive the cage it was made in, for example when a smaller one is generated.
void cut_to(Selection& selection, const PolygonMesh* cage) {
  const std::size_t vertices = cage != nullptr ? cage->positions.size() : 0;
  const std::size_t faces = cage != nullptr ? cage->face_count() : 0;
  std::erase_if(selection.vertices, [&](Index v) { return v >= vertices; });
  std::erase_if(selection.faces, [&](Index f) { return f >= faces; });
  std::erase_if(selection.edges, [&](const EdgeVertices& e) { return e[1] >= vertices; });
}

bool same_poses(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return std::ranges::equal(a, b, [](const Pose& x, const Pose& y) {
    return x.name == y.name && x.positions == y.positions && x.share == y.share;
  });
}

bool same_time_line(const TimeLine& a, const TimeLine& b) {
  return a.first == b.first && a.last == b.last && a.frames_per_second == b.frames_per_second &&
         std::ranges::equal(a.keys, b.keys, [](const Keyframe& x, const Keyframe& y) {
           return x.frame == y.frame && x.positions == y.positions && x.shares == y.shares;
         });
}

} // namespace

Document::Document(QObject* parent) : QObject(parent) {}

Document::~Document() = default;

std::span<const Vec3> Document::model_positions() const {
  if (deformed_) {
    return deformed_->positions;
  }
  return model_ ? std::span<const Vec3>(model_->mesh.positions) : std::span<const Vec3>();
}

std::span<const Vec3> Document::model_normals() const {
  if (deformed_) {
    return deformed_->normals;
  }
  return model_ ? std::span<const Vec3>(model_->normals) : std::span<const Vec3>();
}

std::span<const Triangle> Document::model_triangles() const {
  return model_ ? std::span<const Triangle>(model_->triangles) : std::span<const Triangle>();
}

std::span<const Triangle> Document::coarse_triangles() const {
  return model_ ? std::span<const Triangle>(model_->coarse) : std::span<const Triangle>();
}

double Document::diagonal() const {
  if (model_) {
    return model_->diagonal;
  }
  const double of_cage = has_cage() ? cagewright::diagonal(state_.rest->positions) : 0;
  return of_cage > 0 ? of_cage : 1;
}

Box3 Document::bounds() const {
  Box3 box = deformed_ ? deformed_->box : model_ ? model_->box : Box3();
  box.extend(bounding_box(shown_cage_positions()));
  if (deformed_beside_) {
    box.extend(deformed_beside_->box.translated(way_beside()));
  }
  return box;
}

std::span<const Vec3> Document::cage_positions() const {
  return state_.cage ? std::span<const Vec3>(*state_.cage) : std::span<const Vec3>();
}

std::span<const Vec3> Document::shown_cage_positions() const {
  return shown_ ? std::span<const Vec3>(*shown_) : cage_positions();
}

PolygonMesh Document::cage() const {
  PolygonMesh cage;
  if (has_cage()) {
    cage = *state_.rest;
    cage.positions = *state_.cage;
  }
  return cage;
}

int Document::stage_depth() const {
  int depth = 0;
  if (state_.stages) {
    for (const BoxNode& node : state_.stages->tree.nodes) {
      depth = std::max(depth, node.depth);
    }
  }
  return depth;
}

void Document::set_layers(const Layers& layers) {
  if (layers != layers_) {
    layers_ = layers;
    Q_EMIT layersChanged();
  }
}

void Document::set_tools(const ToolSettings& tools) {
  if (tools != tools_) {
    tools_ = tools;
    Q_EMIT toolsChanged();
  }
}

void Document::set_comparing(bool comparing) {
  if (comparing != comparing_) {
    comparing_ = comparing;
    update_shown();
    Q_EMIT viewStateChanged();
    Q_EMIT cageMoved();
  }
}

void Document::set_blend(double blend) {
  set_shown({blend, time_});
}

void Document::set_time(std::optional<double> frame) {
  set_shown({blend_, frame});
}

void Document::set_shown(const Shown& shown) {
  if (shown == this->shown() && (!shown.time || *shown.time == frame_)) {
    return;
  }
  blend_ = shown.blend;
  time_ = shown.time;
  frame_ = time_.value_or(frame_);
  update_shown();
  Q_EMIT viewStateChanged();
  Q_EMIT cageMoved();
}

void Document::adopt_shown_cage() {
  if (!shown_) {
    time_.reset(); // a time line without keyframes shows the pose
    return;
  }
  const std::vector<double> shares = shown_pose_shares();
  for (std::size_t p = 0; p < shares.size(); ++p) {
    state_.poses[p].share = shares[p];
  }
  state_.cage = shown_;
  comparing_ = false;
  blend_ = 1;
  time_.reset();
  shown_.reset();
  Q_EMIT viewStateChanged();
  Q_EMIT cageMoved();
}

std::vector<double> Document::shown_pose_shares() const {
  std::vector<double> shares;
  if (mode() == Mode::deform && time_ && !state_.time_line.keys.empty()) {
    shares = pose_shares_at(state_.time_line, *time_, state_.poses.size());
  } else {
    for (const Pose& pose : state_.poses) {
      shares.push_back(pose.share);
    }
  }
  for (double& share : shares) {
    share *= comparing_ ? 0 : blend_;
  }
  return shares;
}

Vec3 Document::place_of(const Pin& pin) const {
  const std::span<const Vec3> cage = shown_cage_positions();
  Vec3 place = Vec3::Zero();
  for (std::size_t c = 0; c < std::min(cage.size(), pin.weights->size()); ++c) {
    place += (*pin.weights)[c] * cage[c];
  }
  return place;
}

void Document::update_shown() {
  shown_.reset();
  if (mode() == Mode::refine || !has_cage()) {
    return;
  }
  if (comparing_) {
    shown_ = std::make_shared<const std::vector<Vec3>>(state_.rest->positions);
    return;
  }
  if (time_ && !state_.time_line.keys.empty()) {
    shown_ = std::make_shared<const std::vector<Vec3>>(cage_at(state_.time_line, *time_));
  }
  if (blend_ != 1) {
    std::vector<Vec3> blended(shown_cage_positions().begin(), shown_cage_positions().end());
    for (std::size_t v = 0; v < blended.size(); ++v) {
      blended[v] = state_.rest->positions[v] + blend_ * (blended[v] - state_.rest->positions[v]);
    }
    shown_ = std::make_shared<const std::vector<Vec3>>(std::move(blended));
  }
}

void Document::set_model(std::shared_ptr<const Model> model) {
  set_state({});
  frame_ = state_.time_line.first;
  model_ = std::move(model);
  deformed_.reset();
  painting_.reset();
  set_metrics({});
  Q_EMIT modelChanged();
  Q_EMIT modelMoved();
}

void Document::set_state(const State& state) {
  const State old = std::exchange(state_, state);
  cut_to(state_.selection, state_.rest.get());
  // Bound by other coordinates it is where it was until those have moved it.
  const bool is_bound_anew =
      state_.binding && old.binding && state_.rest == old.rest && state_.region == old.region;
  if (state_.binding != old.binding) {
    if (!is_bound_anew) {
      comparing_ = false;
      blend_ = 1;
      time_.reset();
      deformed_.reset();
    }
    model_weights_.clear();
  }
  update_shown();
  const bool loses_beside =
      !state_.binding || state_.rest != old.rest || state_.region != old.region;
  if (loses_beside) { // it is of another cage, or of another part of the model
    set_beside(nullptr);
  }

  const bool other_cage =
      (old.rest == nullptr) != (state_.rest == nullptr) ||
      (state_.rest && state_.rest != old.rest && !same_topology(*state_.rest, *old.rest));
  if (other_cage) {
    offending_faces_.clear();
    check_ = {};
    cage_distances_.clear();
  }
  if (state_.region != old.region) {
    Q_EMIT regionChanged();
    Q_EMIT colorsChanged();
  }
  if (state_.stages != old.stages) {
    layers_.selected_box = -1;
    Q_EMIT stagesChanged();
  }
  if (other_cage) {
    Q_EMIT cageChanged();
  } else if (state_.cage != old.cage || state_.rest != old.rest) {
    Q_EMIT cageMoved();
  }
  if (state_.binding != old.binding) {
    set_following({});
    Q_EMIT modeChanged();
    Q_EMIT modelMoved();
    Q_EMIT viewStateChanged();
  }
  if (state_.selection != old.selection) {
    Q_EMIT selectionChanged();
  }
  if (state_.hidden_faces != old.hidden_faces) {
    Q_EMIT hiddenChanged();
  }
  if (!same_poses(state_.poses, old.poses)) {
    Q_EMIT posesChanged();
  }
  if (!std::ranges::equal(state_.pins, old.pins, [](const Pin& a, const Pin& b) {
        return a.triangle == b.triangle && a.shares == b.shares && a.weights == b.weights;
      })) {
    Q_EMIT pinsChanged();
  }
  if (state_.density != old.density) {
    Q_EMIT colorsChanged();
    Q_EMIT densityChanged();
  }
  if (state_.mix != old.mix) {
    painting_.reset();
    Q_EMIT colorsChanged();
    Q_EMIT mixChanged();
  }
  if (!same_time_line(state_.time_line, old.time_line)) {
    frame_ = std::clamp<double>(frame_, state_.time_line.first, state_.time_line.last);
    Q_EMIT timeLineChanged();
  }
}

void Document::move_cage(std::span<const Index> vertices, std::span<const Vec3> to) {
  std::vector<Vec3> positions = *state_.cage;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    positions[vertices[i]] = to[i];
  }
  state_.cage = std::make_shared<const std::vector<Vec3>>(std::move(positions));
  update_shown();
  Q_EMIT cageMoved();
}

void Document::set_stages(std::shared_ptr<const BoxDecomposition> stages) {
  state_.stages = std::move(stages);
  layers_.selected_box = -1;
  Q_EMIT stagesChanged();
}

void Document::set_check(CageCheck check) {
  check_ = std::move(check);
  Q_EMIT checkChanged();
}

void Document::set_offending_faces(std::vector<Index> faces) {
  if (faces != offending_faces_) {
    offending_faces_ = std::move(faces);
    Q_EMIT checkChanged();
  }
}

void Document::set_metrics(std::optional<CageMetrics> metrics) {
  metrics_ = std::move(metrics);
  Q_EMIT metricsChanged();
}

void Document::set_following(std::optional<DeformedFigures> figures) {
  if (figures || following_) {
    following_ = figures;
    Q_EMIT followingChanged();
  }
}

Vec3 Document::way_beside() const {
  Box3 box = model_ ? model_->box : Box3();
  if (has_cage()) {
    box.extend(bounding_box(state_.rest->positions));
  }
  constexpr double apart = 1.1;
  return box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(apart * box.sizes().x(), 0, 0);
}

void Document::set_beside(std::shared_ptr<const Binding> binding) {
  if (binding == beside_) {
    return;
  }
  const bool was_shown = deformed_beside_ != nullptr;
  beside_ = std::move(binding);
  deformed_beside_.reset();
  if (was_shown) {
    Q_EMIT modelMoved();
  }
  Q_EMIT besideChanged();
}

void Document::set_deformed(std::shared_ptr<const DeformedModel> deformed,
                            std::shared_ptr<const DeformedModel> beside) {
  deformed_ = std::move(deformed);
  deformed_beside_ = std::move(beside);
  Q_EMIT modelMoved();
}

void Document::set_density(SharedDensity density) {
  state_.density = std::move(density);
  Q_EMIT colorsChanged();
  Q_EMIT densityChanged();
}

void Document::show_mix(SharedShares mix) {
  painting_ = std::move(mix);
  Q_EMIT colorsChanged();
}

void Document::set_cage_distances(std::vector<float> distances) {
  cage_distances_ = std::move(distances);
  Q_EMIT colorsChanged();
}

void Document::set_model_weights(std::vector<float> weights) {
  model_weights_ = std::move(weights);
  Q_EMIT colorsChanged();
}

} // namespace cagewright::app
