#include "app/commands/change_state.h"

#include <utility>

namespace cagewright::app {

ChangeState::ChangeState(Document& document, State before, State after, const QString& text)
    : QUndoCommand(text), document_(document), before_(std::move(before)),
      after_(std::move(after)) {}

ChangeState::ChangeState(Document& document, State before, State after, const QString& text,
                         const Shown& shown_before)
    : ChangeState(document, std::move(before), std::move(after), text) {
  shown_before_ = shown_before;
}

void ChangeState::replace_binding(const std::shared_ptr<const Binding>& before,
                                  const std::shared_ptr<const Binding>& after) {
  for (State* state : {&before_, &after_}) {
    if (state->binding == before) {
      state->binding = after;
    }
  }
}

void ChangeState::undo() {
  document_.set_state(before_);
  if (shown_before_) {
    document_.set_shown(*shown_before_);
  }
}

void ChangeState::redo() {
  document_.set_state(after_);
  if (shown_before_) {
    document_.set_shown({});
  }
}

} // namespace cagewright::app
