#include "app/panels/history_panel.h"

#include "app/commands/editor.h"

#include <QListWidget>
#include <QSignalBlocker>
#include <QVBoxLayout>

namespace cagewright::app {

HistoryPanel::HistoryPanel(QUndoStack& stack, QWidget* parent) : QWidget(parent), stack_(stack) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  list_ = new QListWidget;
  list_->setObjectName("history");
  list_->setToolTip(tr("A click goes back to how it was after that step, or forward again"));
  layout->addWidget(list_);
  connect(list_, &QListWidget::itemClicked, this, [this](QListWidgetItem* item) {
    stack_.setIndex(index_of_row_[static_cast<std::size_t>(list_->row(item))]);
  });
  connect(&stack, &QUndoStack::indexChanged, this, &HistoryPanel::update_list);
  update_list();
}

void HistoryPanel::update_list() {
  const QSignalBlocker blocker(list_);
  list_->clear();
  index_of_row_.clear();
  const auto add = [this](const QString& text, int index) {
    list_->addItem(text);
    index_of_row_.push_back(index);
  };
  add(tr("As it was opened"), 0);
  const QString select = Editor::tr("Select");
  for (int i = 0; i < stack_.count();) {
    const QString text = stack_.text(i);
    int end = i + 1;
    while (text == select && end < stack_.count() && stack_.text(end) == select) {
      ++end;
    }
    add(end - i > 1 ? tr("%1 (%2)").arg(text).arg(end - i) : text, end);
    i = end;
  }
  for (int row = 0; row < list_->count(); ++row) {
    const int index = index_of_row_[static_cast<std::size_t>(row)];
    if (index > stack_.index()) { // undone
      list_->item(row)->setForeground(palette().brush(QPalette::Disabled, QPalette::Text));
    } else {
      list_->setCurrentRow(row);
    }
  }
  if (list_->currentItem() != nullptr) {
    list_->scrollToItem(list_->currentItem());
  }
}

} // namespace cagewright::app
