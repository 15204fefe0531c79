/// \file
/// The options of generating a cage, and the buttons that do it.
#pragma once

#include "app/session.h"

#include <QWidget>

#include <functional>
#include <vector>

class QCheckBox;
class QFormLayout;
class QPushButton;

namespace cagewright::app {

/// Everything from model to bound cage: options, Generate, Bind.
class GeneratePanel final : public QWidget {
  Q_OBJECT

public:
  explicit GeneratePanel(Session& session, QWidget* parent = nullptr);

Q_SIGNALS:
  void loadCageRequested();

private:
  void add_option(const GenerateOption& option, QFormLayout* form);
  void update_options(); ///< values, and which of them the method looks at
  void update_buttons();
  template <class Set> void change(const Set& set);

  struct Row {
    const GenerateOption* option;
    QFormLayout* form;
    QWidget* field;
    std::function<void()> show_value;
  };

  Session& session_;
  std::vector<Row> rows_;
  QPushButton* generate_ = nullptr;
  QPushButton* load_ = nullptr;
  QPushButton* bind_ = nullptr;
  QPushButton* refine_ = nullptr;
};

} // namespace cagewright::app
