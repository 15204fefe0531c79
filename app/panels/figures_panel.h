/// \file
/// The figures of the cage, and whether it is valid.
#pragma once

#include "app/document/document.h"

#include <QWidget>

#include <map>

class QLabel;
class QListWidget;

namespace cagewright::app {

/// A sentence for people: "3 faces cross or touch".
QString describe(ViolationKind kind, std::size_t count);

class FiguresPanel final : public QWidget {
  Q_OBJECT

public:
  explicit FiguresPanel(Document& document, QWidget* parent = nullptr);

private:
  void update_figures();
  void update_check();

  Document& document_;
  std::map<QString, QLabel*> values_;
  QLabel* verdict_ = nullptr;
  QListWidget* problems_ = nullptr;
};

} // namespace cagewright::app
