/// \file
/// The boxes of the splitting, and the cross-section function of the one that is selected.
#pragma once

#include "app/document/document.h"

#include <QWidget>

class QChart;
class QComboBox;
class QLabel;
class QTreeWidget;

namespace cagewright::app {

class SectionsPanel final : public QWidget {
  Q_OBJECT

public:
  explicit SectionsPanel(Document& document, QWidget* parent = nullptr);

  void set_dark(bool dark);

private:
  void fill_tree();
  void show_box();

  Document& document_;
  QTreeWidget* tree_ = nullptr;
  QComboBox* axis_ = nullptr;
  QLabel* text_ = nullptr;
  QChart* chart_ = nullptr;
};

} // namespace cagewright::app
