#include "app/panels/command_search.h"

#include <QAction>
#include <QCoreApplication>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListWidget>
#include <QPointer>
#include <QVBoxLayout>

#include <algorithm>

namespace cagewright::app {
namespace {

/// Whether all words that were typed are in a text.
bool matches(const QString& text, const QStringList& words) {
  return std::ranges::all_of(
      words, [&](const QString& word) { return text.contains(word, Qt::CaseInsensitive); });
}

/// Smaller where a command's own name has the words: what only its help has comes after.
int rank(const QAction& command, const QStringList& words) {
  return matches(plain_text(command), words) ? 0 : matches(full_name(command), words) ? 1 : 2;
}

} // namespace

QString plain_text(const QAction& action) {
  QString text = action.text();
  return text.remove('&').remove("...");
}

QString full_name(const QAction& action) {
  const QString menu = action.property(menu_property).toString();
  return menu.isEmpty() ? plain_text(action) : menu + " \u203a " + plain_text(action);
}

CommandSearch::CommandSearch(const QList<QAction*>& commands, QWidget* parent)
    : QDialog(parent, Qt::Popup | Qt::FramelessWindowHint), commands_(commands) {
  setObjectName("command_search");
  setAttribute(Qt::WA_DeleteOnClose);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  text_ = new QLineEdit;
  text_->setObjectName("command_text");
  text_->setPlaceholderText(tr("Search a command"));
  text_->installEventFilter(this);
  list_ = new QListWidget;
  list_->setObjectName("command_list");
  list_->setFocusPolicy(Qt::NoFocus);
  layout->addWidget(text_);
  layout->addWidget(list_);
  resize(420, 320);
  connect(text_, &QLineEdit::textChanged, this, &CommandSearch::update_list);
  connect(list_, &QListWidget::itemClicked, this, &CommandSearch::run);
  std::ranges::sort(commands_, [](const QAction* a, const QAction* b) {
    return full_name(*a).localeAwareCompare(full_name(*b)) < 0;
  });
  update_list();
  text_->setFocus();
}

void CommandSearch::update_list() {
  const QStringList words = text_->text().split(' ', Qt::SkipEmptyParts);
  list_->clear();
  shown_.clear();
  QList<QAction*> best = commands_;
  std::ranges::stable_sort(best, {}, [&](const QAction* a) { return rank(*a, words); });
  for (QAction* command : best) {
    const QString name = full_name(*command);
    if (!matches(name + " " + command->statusTip(), words)) {
      continue;
    }
    const QString keys = command->shortcut().toString(QKeySequence::NativeText);
    auto* item = new QListWidgetItem(keys.isEmpty() ? name : name + "   " + keys, list_);
    item->setToolTip(command->toolTip());
    if (!command->isEnabled()) { // seen, so that one knows it exists
      item->setFlags(item->flags() & ~Qt::ItemIsEnabled);
    }
    shown_.append(command);
  }
  for (int row = 0; row < list_->count(); ++row) {
    if (shown_[row]->isEnabled()) {
      list_->setCurrentRow(row);
      break;
    }
  }
}

void CommandSearch::run() {
  const int row = list_->currentRow();
  if (row < 0 || row >= shown_.size() || !shown_[row]->isEnabled()) {
    return;
  }
  const QPointer<QAction> command = shown_[row];
  close();
  if (command) {
    command->trigger();
  }
}

bool CommandSearch::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    const auto* key = static_cast<QKeyEvent*>(event);
    switch (key->key()) {
    case Qt::Key_Down:
    case Qt::Key_Up:
    case Qt::Key_PageDown:
    case Qt::Key_PageUp:
      QCoreApplication::sendEvent(list_, event);
      return true;
    case Qt::Key_Return:
    case Qt::Key_Enter:
      run();
      return true;
    default:
      break;
    }
  }
  return QDialog::eventFilter(watched, event);
}

} // namespace cagewright::app
