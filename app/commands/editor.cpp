#include "app/commands/editor.h"

#include "app/commands/change_state.h"
#include "app/document/time_line.h"
#include "app/edit/hidden.h"

#include <algorithm>
#include <utility>

namespace cagewright::app {

namespace {

/// The cage is as the pose is, or, if there is none of that number, as none is.
void take_only(std::size_t pose, std::vector<Pose>& poses) {
  for (std::size_t p = 0; p < poses.size(); ++p) {
    poses[p].share = p == pose ? 1 : 0;
  }
}

constexpr std::size_t no_pose = ~std::size_t{0};

/// The same shape of a cage that is at rest elsewhere: what a pose moves, it moves from there.
SharedPositions moved_along(const SharedPositions& pose, const std::vector<Vec3>& old_rest,
                            const std::vector<Vec3>& new_rest) {
  std::vector<Vec3> positions = *pose;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (old_rest[v] != new_rest[v]) {
      positions[v] += new_rest[v] - old_rest[v];
    }
  }
  return std::make_shared<const std::vector<Vec3>>(std::move(positions));
}

} // namespace

Editor::Editor(Document& document, QObject* parent)
    : QObject(parent), document_(document), live_check_(document) {
  undo_stack_.setUndoLimit(500);
  // What was in the making when something was undone is over.
  connect(&undo_stack_, &QUndoStack::indexChanged, this, [this] {
    if (move_) {
      live_check_.end();
    }
    move_.reset();
    step_.reset();
  });
}

Editor::~Editor() = default;

void Editor::begin_move(std::vector<Index> vertices) {
  cancel_move();
  move_.emplace(Move{std::move(vertices), document_.state(), document_.shown()});
  document_.adopt_shown_cage();
  live_check_.begin();
}

void Editor::move_to(std::span<const Vec3> positions) {
  if (!move_) {
    return; // another change has taken it back
  }
  document_.move_cage(move_->vertices, live_check_.move(move_->vertices, positions));
  if (live_check_.stopped()) {
    Q_EMIT message(tr("Stopped where the cage would become invalid"));
  }
}

void Editor::end_move(const QString& text) {
  if (!move_) {
    return;
  }
  Move move = *std::exchange(move_, std::nullopt);
  live_check_.end();
  if (!step_ && move.before.cage != document_.state().cage) {
    undo_stack_.push(new ChangeState(document_, std::move(move.before), document_.state(), text,
                                     move.shown_before));
  }
}

void Editor::cancel_move() {
  if (move_) {
    live_check_.end();
    const Move move = *std::exchange(move_, std::nullopt);
    document_.set_state(move.before);
    document_.set_shown(move.shown_before);
  }
}

void Editor::begin_step() {
  cancel_move();
  cancel_step();
  step_.emplace(Step{document_.state(), document_.shown()});
}

void Editor::end_step(const QString& text) {
  if (!step_) {
    return;
  }
  Step step = *std::exchange(step_, std::nullopt);
  undo_stack_.push(new ChangeState(document_, std::move(step.before), document_.state(), text,
                                   step.shown_before));
}

void Editor::cancel_step() {
  if (step_) {
    cancel_move();
    const Step step = *std::exchange(step_, std::nullopt);
    document_.set_state(step.before);
    document_.set_shown(step.shown_before);
  }
}

void Editor::move(std::vector<Index> vertices, std::span<const Vec3> positions,
                  const QString& text) {
  begin_move(std::move(vertices));
  move_to(positions);
  end_move(text);
}

void Editor::select(Selection selection) {
  if (!document_.state().hidden_faces.empty()) { // what cannot be seen is not selected
    const CageGraph graph(document_.cage_rest());
    selection = in_sight(selection, graph, InSight(graph, document_.state().hidden_faces));
  }
  if (selection == document_.selection()) {
    return;
  }
  State state = document_.state();
  state.selection = std::move(selection);
  change(std::move(state), tr("Select"));
}

void Editor::hide_faces(std::vector<Index> faces, const QString& text) {
  State state = document_.state();
  if (faces == state.hidden_faces) {
    return;
  }
  state.hidden_faces = std::move(faces);
  if (state.rest) {
    const CageGraph graph(*state.rest);
    state.selection = in_sight(state.selection, graph, InSight(graph, state.hidden_faces));
  }
  change(std::move(state), text);
}

void Editor::replace_cage(std::shared_ptr<const PolygonMesh> cage,
                          std::shared_ptr<const BoxDecomposition> stages, const QString& text) {
  replace_cage(std::move(cage), std::move(stages), document_.state().region, text);
}

void Editor::replace_cage(std::shared_ptr<const PolygonMesh> cage,
                          std::shared_ptr<const BoxDecomposition> stages,
                          std::shared_ptr<const Region> region, const QString& text) {
  const QString lost = lost_poses();
  State state = without_cage();
  state.region = std::move(region);
  state.selection.mode = document_.selection().mode;
  state.stages = stages ? std::move(stages) : document_.stages();
  state.cage = std::make_shared<const std::vector<Vec3>>(cage->positions);
  state.rest = std::move(cage);
  change(std::move(state), text);
  if (!lost.isEmpty()) {
    Q_EMIT message(lost);
  }
}

State Editor::without_cage() const {
  State state;
  state.density = document_.state().density;
  state.mix = document_.state().mix;
  state.region = document_.state().region;
  return state;
}

QString Editor::lost_poses() const {
  const State& state = document_.state();
  const std::size_t lost = state.poses.size() + state.time_line.keys.size();
  return lost == 0 ? QString()
         : lost == 1
             ? tr("What was kept of the cage before does not fit this one: undo brings it back")
             : tr("%1 poses and keyframes of the cage before do not fit this one: undo brings "
                  "them back")
                   .arg(lost);
}

void Editor::edit_topology(PolygonMesh cage, Selection selection, const QString& text) {
  const QString lost = lost_poses();
  State state = without_cage();
  state.selection = std::move(selection);
  state.stages = document_.stages();
  state.cage = std::make_shared<const std::vector<Vec3>>(cage.positions);
  state.rest = std::make_shared<const PolygonMesh>(std::move(cage));
  change(std::move(state), text);
  if (!lost.isEmpty()) {
    Q_EMIT message(lost);
  }
}

void Editor::adjust_cage(std::shared_ptr<const PolygonMesh> cage,
                         const std::function<Vec3(const Vec3&)>& map, const QString& text) {
  State state = document_.state();
  const auto mapped = [&](const SharedPositions& positions) -> SharedPositions {
    std::vector<Vec3> result = *positions;
    std::ranges::transform(result, result.begin(), map);
    return std::make_shared<const std::vector<Vec3>>(std::move(result));
  };
  for (Pose& pose : state.poses) {
    pose.positions = mapped(pose.positions);
  }
  for (Keyframe& key : state.time_line.keys) {
    key.positions = mapped(key.positions);
  }
  state.cage = std::make_shared<const std::vector<Vec3>>(cage->positions);
  state.rest = std::move(cage);
  change(std::move(state), text);
}

void Editor::bind(std::shared_ptr<const Binding> binding, std::shared_ptr<const PolygonMesh> rest) {
  State state = document_.state();
  if (state.rest && state.rest->positions != rest->positions) {
    for (Pose& pose : state.poses) {
      pose.positions = moved_along(pose.positions, state.rest->positions, rest->positions);
    }
    for (Keyframe& key : state.time_line.keys) {
      key.positions = moved_along(key.positions, state.rest->positions, rest->positions);
    }
  }
  state.pins.clear();
  take_only(no_pose, state.poses);
  state.binding = std::move(binding);
  state.cage = std::make_shared<const std::vector<Vec3>>(rest->positions);
  state.rest = std::move(rest);
  change(std::move(state), tr("Bind"));
}

void Editor::bind_anew(std::shared_ptr<const Binding> binding) {
  State state = document_.state();
  const Shown shown = document_.shown();
  state.pins.clear(); // they have weights of the kind before
  state.binding = std::move(binding);
  change(std::move(state), tr("Other Coordinates"));
  document_.set_shown(shown);
}

void Editor::renew_binding(const std::shared_ptr<const Binding>& binding) {
  const std::shared_ptr<const Binding> before = document_.state().binding;
  const auto renew = [&](State& state) {
    if (state.binding == before) {
      state.binding = binding;
    }
  };
  for (int i = 0; i < undo_stack_.count(); ++i) {
    // All are ours; Qt shows them as const so that nobody changes what they do.
    if (auto* step =
            dynamic_cast<ChangeState*>(const_cast<QUndoCommand*>(undo_stack_.command(i)))) {
      step->replace_binding(before, binding);
    }
  }
  if (move_) {
    renew(move_->before);
  }
  if (step_) {
    renew(step_->before);
  }
  State state = document_.state();
  state.binding = binding;
  document_.set_state(state);
}

void Editor::refine() {
  State state = document_.state();
  if (!state.binding) {
    return;
  }
  QString kept;
  if (deformation_is_unkept()) {
    const QString name = free_pose_name(tr("Last pose"));
    state.poses.push_back({name, state.cage, 0});
    kept = tr("The deformation is kept as the pose \"%1\"").arg(name);
  }
  state.binding.reset();
  state.pins.clear();
  take_only(no_pose, state.poses);
  state.cage = std::make_shared<const std::vector<Vec3>>(state.rest->positions);
  change(std::move(state), tr("Refine Cage"));
  if (!kept.isEmpty()) {
    Q_EMIT message(kept);
  }
}

bool Editor::deformation_is_unkept() const {
  const State& state = document_.state();
  const auto same = [&](const std::vector<Vec3>& positions) { return positions == *state.cage; };
  return state.binding && !same(state.rest->positions) &&
         std::ranges::none_of(state.poses, [&](const Pose& p) { return same(*p.positions); }) &&
         std::ranges::none_of(state.time_line.keys,
                              [&](const Keyframe& k) { return same(*k.positions); });
}

QString Editor::free_pose_name(const QString& name) const {
  const auto& poses = document_.state().poses;
  QString free = name;
  for (int n = 2; std::ranges::any_of(poses, [&](const Pose& p) { return p.name == free; }); ++n) {
    free = tr("%1 %2").arg(name).arg(n);
  }
  return free;
}

void Editor::reset_pose() {
  State state = document_.state();
  if (!state.rest) {
    return;
  }
  state.cage = std::make_shared<const std::vector<Vec3>>(state.rest->positions);
  take_only(no_pose, state.poses);
  change(std::move(state), tr("Reset"));
}

void Editor::add_pose(const QString& name) {
  document_.adopt_shown_cage();
  State state = document_.state();
  state.poses.push_back({name, state.cage, 1});
  take_only(state.poses.size() - 1, state.poses);
  change(std::move(state), tr("Add Pose"));
}

void Editor::remove_pose(std::size_t pose) {
  State state = document_.state();
  state.poses.erase(state.poses.begin() + static_cast<std::ptrdiff_t>(pose));
  for (Keyframe& key : state.time_line.keys) {
    if (pose < key.shares.size()) {
      key.shares.erase(key.shares.begin() + static_cast<std::ptrdiff_t>(pose));
    }
  }
  change(std::move(state), tr("Remove Pose"));
}

void Editor::rename_pose(std::size_t pose, const QString& name) {
  State state = document_.state();
  if (state.poses[pose].name != name && !name.trimmed().isEmpty()) {
    state.poses[pose].name = name.trimmed();
    change(std::move(state), tr("Rename Pose"));
  }
}

void Editor::update_pose(std::size_t pose) {
  document_.adopt_shown_cage();
  State state = document_.state();
  state.poses[pose].positions = state.cage;
  take_only(pose, state.poses);
  change(std::move(state), tr("Update Pose"));
}

void Editor::apply_pose(std::size_t pose) {
  document_.set_time(std::nullopt);
  document_.set_blend(1);
  State state = document_.state();
  state.cage = state.poses[pose].positions;
  take_only(pose, state.poses);
  change(std::move(state), tr("Apply Pose"));
}

void Editor::begin_mix() {
  begin_step();
  document_.adopt_shown_cage();
}

void Editor::mix_pose(std::size_t pose, double share) {
  const bool alone = !step_;
  if (alone) {
    begin_mix();
  }
  State state = document_.state();
  if (pose < state.poses.size() && state.rest && share != state.poses[pose].share) {
    const double more = share - state.poses[pose].share;
    const std::vector<Vec3>& of_pose = *state.poses[pose].positions;
    std::vector<Vec3> cage = *state.cage;
    for (std::size_t v = 0; v < cage.size(); ++v) {
      cage[v] += more * (of_pose[v] - state.rest->positions[v]);
    }
    state.poses[pose].share = share;
    state.cage = std::make_shared<const std::vector<Vec3>>(std::move(cage));
    document_.set_state(state);
  }
  if (alone) {
    end_mix();
  }
}

void Editor::end_mix() {
  if (step_ && step_->before.cage == document_.state().cage) {
    cancel_step();
  } else {
    end_step(tr("Mix Poses"));
  }
}

void Editor::set_pins(std::vector<Pin> pins, const QString& text) {
  State state = document_.state();
  state.pins = std::move(pins);
  change(std::move(state), text);
}

void Editor::set_region(std::shared_ptr<const Region> region, const QString& text) {
  State state = document_.state();
  state.region = std::move(region);
  state.stages.reset(); // of another part of the model
  change(std::move(state), text);
}

void Editor::set_density(SharedDensity density, const QString& text) {
  State state = document_.state();
  state.density = std::move(density);
  change(std::move(state), text);
}

void Editor::set_mix(SharedShares mix, const QString& text) {
  State state = document_.state();
  state.mix = std::move(mix);
  state.pins.clear();
  change(std::move(state), text);
}

void Editor::set_keyframe(int frame) {
  // On the time line what is shown is the cage at that time; otherwise it is the edited pose.
  const std::span<const Vec3> shown = document_.shown_cage_positions();
  State state = document_.state();
  state.time_line =
      with_keyframe(std::move(state.time_line),
                    {frame, std::make_shared<const std::vector<Vec3>>(shown.begin(), shown.end()),
                     document_.shown_pose_shares()});
  change(std::move(state), tr("Set Keyframe"));
}

void Editor::remove_keyframe(int frame) {
  State state = document_.state();
  state.time_line = without_keyframe(std::move(state.time_line), frame);
  change(std::move(state), tr("Remove Keyframe"));
}

void Editor::set_time_line(TimeLine time_line, const QString& text) {
  State state = document_.state();
  state.time_line = std::move(time_line);
  change(std::move(state), text);
}

void Editor::change(State state, const QString& text) {
  if (move_ && step_) { // this one is none of its parts
    cancel_step();
  }
  cancel_move();
  if (step_) {
    document_.set_state(state);
    return;
  }
  undo_stack_.push(new ChangeState(document_, document_.state(), std::move(state), text));
}

} // namespace cagewright::app
