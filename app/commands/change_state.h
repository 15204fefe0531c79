/// \file
/// The one kind of command: from one state of the document to another.
#pragma once

#include "app/document/document.h"

#include <QUndoCommand>

#include <optional>

namespace cagewright::app {

/// Takes the document from one state to another, and back. States share what they have in common,
/// so that a step of undo holds little more than what it changed.
class ChangeState final : public QUndoCommand {
public:
  ChangeState(Document& document, State before, State after, const QString& text);
  /// \param shown_before  what was shown then, for changes of what is shown: undo shows it again
  ChangeState(Document& document, State before, State after, const QString& text,
              const Shown& shown_before);

  /// What was bound by the one is bound by the other: see Editor::renew_binding().
  void replace_binding(const std::shared_ptr<const Binding>& before,
                       const std::shared_ptr<const Binding>& after);

  void undo() override;
  void redo() override;

private:
  Document& document_;
  State before_;
  State after_;
  std::optional<Shown> shown_before_;
};

} // namespace cagewright::app
