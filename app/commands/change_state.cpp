#include "app/commands/change_state.h"

#include <utility>

namespace cagewright::app {

ChangeState::ChangeState(Document& document, State before, State after, const QString& text)
    : QUndoCommand(text), document_(document), before_(std::move(before)),
      after_(std::move(after)) {}

void ChangeState::undo() {
  document_.set_state(before_);
}

void ChangeState::redo() {
  document_.set_state(after_);
}

} // namespace cagewright::app
