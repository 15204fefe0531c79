/// \file
/// The options of generating a cage, and the buttons that do it.
#pragma once

#include "app/session.h"

#include <QWidget>

#include <array>
#include <functional>
#include <map>
#include <vector>

class QCheckBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QToolButton;

namespace cagewright::app {

/// Everything from model to bound cage: options, Generate, Bind.
class GeneratePanel final : public QWidget {
  Q_OBJECT

public:
  explicit GeneratePanel(Session& session, QWidget* parent = nullptr);

Q_SIGNALS:
  void loadCageRequested();

private:
  /// A field to edit an option, and what shows the option's value in it.
  struct Field {
    QWidget* editor;
    std::function<void()> show_value;
  };

  void add_option(const GenerateOption& option, QGridLayout* grid);
  Field field_of(const GenerateOption::Integer& integer);
  Field field_of(const GenerateOption::Number& number);
  Field field_of(const GenerateOption::Choice& choice);
  Field field_of(const GenerateOption::File& file);
  void add_region(QGridLayout* grid);
  void add_paint_mix(QGridLayout* grid);
  void show_parts(); ///< in the menu of what the cage is for
  void take_part(const NamedPart& part, bool on);
  void update_region();
  void update_options(); ///< values, and which of them make a difference
  void update_buttons();
  template <class Set> void change(const Set& set);

  struct Row {
    const GenerateOption* option;
    std::array<QWidget*, 3> fields; ///< its name, to edit it, and to explain it
    QLabel* explanation;            ///< a line of its own, while it is asked for
    std::function<void()> show_value;
  };

  Session& session_;
  std::vector<Row> rows_;
  std::map<GenerateOption::Group, QLabel*> titles_;
  QToolButton* region_ = nullptr;
  QToolButton* paint_mix_ = nullptr;
  QToolButton* advanced_ = nullptr;
  QPushButton* defaults_ = nullptr;
  QPushButton* generate_ = nullptr;
  QPushButton* load_ = nullptr;
  QPushButton* bind_ = nullptr;
  QPushButton* refine_ = nullptr;
};

} // namespace cagewright::app
