/// \file
/// What was done, step by step.
#pragma once

#include <QUndoStack>
#include <QWidget>

#include <vector>

class QListWidget;

namespace cagewright::app {

/// The steps of undo, the newest last; a click goes back or forward to one. Selections one after
/// the other are one line.
class HistoryPanel final : public QWidget {
  Q_OBJECT

public:
  explicit HistoryPanel(QUndoStack& stack, QWidget* parent = nullptr);

private:
  void update_list();

  QUndoStack& stack_;
  QListWidget* list_ = nullptr;
  std::vector<int> index_of_row_; // of the stack, after the row's last step
};

} // namespace cagewright::app
