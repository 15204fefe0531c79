/// \file
/// The figures of the cage, and whether it is valid.
#pragma once

#include "app/document/document.h"

#include <QWidget>

#include <map>
#include <vector>

class QLabel;
class QListWidget;

namespace cagewright::app {

/// A sentence for people: "3 faces cross or touch".
QString describe(ViolationKind kind, std::size_t count);

class FiguresPanel final : public QWidget {
  Q_OBJECT

public:
  explicit FiguresPanel(Document& document, QWidget* parent = nullptr);

Q_SIGNALS:
  /// One of the problems was clicked; clicked again, it is the next of the kind.
  void violationChosen(const cagewright::Violation& violation);

protected:
  void changeEvent(QEvent* event) override;

private:
  void choose(int row);
  void show_row(const char* key, bool on);
  void update_figures();
  void update_check();

  Document& document_;
  std::map<QString, QLabel*> values_;
  std::map<QString, QWidget*> labels_;
  QLabel* verdict_ = nullptr;
  QListWidget* problems_ = nullptr;
  std::vector<ViolationKind> kinds_; // of the rows
  std::size_t next_ = 0;             // of the kind chosen last
  int chosen_ = -1;                  // row
};

} // namespace cagewright::app
