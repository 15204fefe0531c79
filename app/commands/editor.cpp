#include "app/commands/editor.h"

#include "app/commands/change_state.h"

#include <utility>

namespace cagewright::app {

Editor::Editor(Document& document, QObject* parent) : QObject(parent), document_(document) {}

void Editor::begin_move(std::vector<Index> vertices) {
  move_.emplace(Move{std::move(vertices), document_.state()});
  document_.adopt_shown_cage();
}

void Editor::move_to(std::span<const Vec3> positions) {
  document_.move_cage(move_->vertices, positions);
}

void Editor::end_move(const QString& text) {
  if (!move_) {
    return;
  }
  State before = std::exchange(move_, std::nullopt)->before;
  if (before.cage == document_.state().cage) {
    return;
  }
  undo_stack_.push(new ChangeState(document_, std::move(before), document_.state(), text));
}

void Editor::cancel_move() {
  if (move_) {
    document_.set_state(std::exchange(move_, std::nullopt)->before);
  }
}

void Editor::select(Selection selection) {
  if (selection == document_.selection()) {
    return;
  }
  State state = document_.state();
  state.selection = std::move(selection);
  change(std::move(state), tr("Select"));
}

void Editor::edit_topology(PolygonMesh cage, Selection selection, const QString& text) {
  State state = document_.state();
  state.cage = std::make_shared<const std::vector<Vec3>>(cage.positions);
  state.rest = std::make_shared<const PolygonMesh>(std::move(cage));
  state.binding.reset();
  state.selection = std::move(selection);
  state.poses.clear();
  state.time_line.keys.clear();
  change(std::move(state), text);
}

void Editor::change(State state, const QString& text) {
  undo_stack_.push(new ChangeState(document_, document_.state(), std::move(state), text));
}

} // namespace cagewright::app
