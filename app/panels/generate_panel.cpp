#include "app/panels/generate_panel.h"

#include "app/icons.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <variant>

namespace cagewright::app {
namespace {

/// The wheel scrolls the panel, not the values on its way.
class IgnoreWheel final : public QObject {
public:
  using QObject::QObject;
  bool eventFilter(QObject* watched, QEvent* event) override {
    auto* widget = qobject_cast<QWidget*>(watched);
    if (event->type() == QEvent::Wheel && widget != nullptr && !widget->hasFocus()) {
      event->ignore();
      return true;
    }
    return QObject::eventFilter(watched, event);
  }
};

QLabel* explanation(const QString& text) {
  auto* label = new QLabel(text);
  label->setWordWrap(true);
  label->setForegroundRole(QPalette::PlaceholderText);
  QFont font = label->font();
  font.setPointSizeF(font.pointSizeF() * 0.88);
  label->setFont(font);
  label->setContentsMargins(0, 0, 0, 5);
  return label;
}

/// A button with a menu that says what is chosen, as much of it as there is room for.
class ChoiceButton final : public QToolButton {
public:
  ChoiceButton() {
    setPopupMode(QToolButton::InstantPopup);
    setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed); // as wide as its column, not its text
    setStyleSheet(QString("QToolButton { padding-right: %1px; } QToolButton::menu-indicator { "
                          "subcontrol-origin: padding; subcontrol-position: right center; right: "
                          "3px; }")
                      .arg(room_for_arrow));
  }

  void say(const QString& text) {
    whole_ = text;
    setAccessibleDescription(text);
    show_text();
  }

protected:
  void resizeEvent(QResizeEvent* event) override {
    QToolButton::resizeEvent(event);
    show_text();
  }

private:
  static constexpr int room_for_arrow = 14;
  static constexpr int rims = 8; // of the button, and between text and rim

  void show_text() {
    setText(fontMetrics().elidedText(whole_, Qt::ElideRight, width() - room_for_arrow - rims));
  }

  QString whole_;
};

QString big_button_style() {
  return "QPushButton { padding: 8px; font-weight: bold; }";
}

} // namespace

GeneratePanel::GeneratePanel(Session& session, QWidget* parent)
    : QWidget(parent), session_(session) {
  auto* layout = new QVBoxLayout(this);
  setMinimumWidth(210);

  // One grid for all, so that fields stand below each other, whatever is shown.
  auto* content = new QWidget;
  auto* options = new QVBoxLayout(content);
  options->setContentsMargins(0, 0, 6, 0);
  auto* grid = new QGridLayout;
  grid->setColumnStretch(1, 1);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(5);
  options->addLayout(grid);
  options->addStretch();
  const auto add_group = [&](GenerateOption::Group group) {
    for (const GenerateOption& option : generate_options()) {
      if (option.group == group) {
        add_option(option, grid);
      }
    }
  };
  add_region(grid);
  add_group(GenerateOption::Group::basic);
  advanced_ = new QToolButton;
  advanced_->setObjectName("advanced");
  advanced_->setText(tr("Advanced"));
  advanced_->setCheckable(true);
  advanced_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  advanced_->setAutoRaise(true);
  grid->addWidget(advanced_, grid->rowCount(), 0, 1, 3);
  connect(advanced_, &QToolButton::toggled, this, &GeneratePanel::update_options);
  const std::pair<GenerateOption::Group, QString> titles[] = {
      {GenerateOption::Group::budget, tr("How close, and where finer")},
      {GenerateOption::Group::envelope, tr("Envelope")},
      {GenerateOption::Group::boxes, tr("Boxes")}};
  for (const auto& [group, title] : titles) {
    auto* label = new QLabel("<b>" + title + "</b>");
    label->setContentsMargins(0, 6, 0, 0);
    grid->addWidget(label, grid->rowCount(), 0, 1, 3);
    titles_[group] = label;
    add_group(group);
  }
  defaults_ = new QPushButton(tr("Defaults"));
  defaults_->setToolTip(tr("Puts all options back"));
  connect(defaults_, &QPushButton::clicked, this, [this] {
    GenerateSettings defaults; // of a cage: how it is followed is another matter
    defaults.coordinates = session_.settings().coordinates;
    defaults.coordinate_numbers = session_.settings().coordinate_numbers;
    defaults.beside = session_.settings().beside;
    defaults.mixed = session_.settings().mixed;
    session_.set_settings(defaults);
  });
  grid->addWidget(defaults_, grid->rowCount(), 1);

  auto* scroll = new QScrollArea;
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  layout->addWidget(scroll, 1);

  generate_ = new QPushButton(tr("Generate Cage"));
  generate_->setObjectName("generate");
  generate_->setStyleSheet(big_button_style());
  generate_->setToolTip(tr("Makes a cage with these options (Ctrl+G). The cage there is stays "
                           "until the new one is ready."));
  connect(generate_, &QPushButton::clicked, &session_, &Session::generate);
  layout->addWidget(generate_);

  load_ = new QPushButton(tr("Load a Cage Instead..."));
  load_->setToolTip(tr("A cage made elsewhere, from a file"));
  connect(load_, &QPushButton::clicked, this, &GeneratePanel::loadCageRequested);
  layout->addWidget(load_);

  auto* follows = new QGridLayout;
  follows->setColumnStretch(1, 1);
  follows->setHorizontalSpacing(6);
  layout->addLayout(follows);
  for (const GenerateOption& option : generate_options()) {
    if (option.group == GenerateOption::Group::binding) {
      add_option(option, follows);
    }
    if (option.key == "mix") {
      add_paint_mix(follows);
    }
  }

  bind_ = new QPushButton(tr("Bind"));
  bind_->setObjectName("bind");
  bind_->setStyleSheet(big_button_style());
  bind_->setToolTip(tr("Ties the model to the cage (Ctrl+B): from then on, dragging the cage "
                       "deforms the model"));
  connect(bind_, &QPushButton::clicked, &session_, [this] { session_.bind(); });
  layout->addWidget(bind_);

  refine_ = new QPushButton(tr("Back to Refining the Cage"));
  refine_->setObjectName("refine");
  refine_->setToolTip(tr("Unties the model, so that the cage itself can be edited"));
  connect(refine_, &QPushButton::clicked, &session_, &Session::refine);
  layout->addWidget(refine_);

  connect(&session_, &Session::settingsChanged, this, &GeneratePanel::update_options);
  connect(&session_.document(), &Document::regionChanged, this, &GeneratePanel::update_region);
  connect(&session_.document(), &Document::modelChanged, this, &GeneratePanel::update_region);
  connect(&session_.document(), &Document::modelChanged, this, &GeneratePanel::update_buttons);
  connect(&session_.document(), &Document::cageChanged, this, &GeneratePanel::update_buttons);
  connect(&session_.document(), &Document::modeChanged, this, &GeneratePanel::update_buttons);
  connect(&session_.jobs(), &JobRunner::started, this, &GeneratePanel::update_buttons);
  connect(&session_.jobs(), &JobRunner::finished, this, &GeneratePanel::update_buttons);
  update_options();
  update_buttons();
  update_region();
}

/// What of the model the cage is for: all, objects of it, or what is painted.
void GeneratePanel::add_region(QGridLayout* grid) {
  region_ = new ChoiceButton;
  region_->setObjectName("region");
  region_->setToolTip(tr("What of the model the cage is for: all of it, some of its objects, or "
                         "what you paint. The rest stays where it is"));
  region_->setAccessibleName(tr("Cage for"));
  region_->setMinimumWidth(60);
  auto* menu = new QMenu(region_);
  menu->setToolTipsVisible(true);
  region_->setMenu(menu);
  connect(menu, &QMenu::aboutToShow, this, &GeneratePanel::show_parts);
  auto* label = new QLabel(tr("Cage for"));
  label->setToolTip(region_->toolTip());
  label->setBuddy(region_);
  const int row = grid->rowCount();
  grid->addWidget(label, row, 0);
  grid->addWidget(region_, row, 1, 1, 2); // it has no "?", and the text is long
}

/// Below the second kind, while there is one.
void GeneratePanel::add_paint_mix(QGridLayout* grid) {
  paint_mix_ = new QToolButton;
  paint_mix_->setIcon(icon("tool_mix"));
  paint_mix_->setText(tr("Paint It"));
  paint_mix_->setObjectName("paint_mix");
  paint_mix_->setCheckable(true);
  paint_mix_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  paint_mix_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  paint_mix_->setToolTip(tr("Takes the brush that says where this kind holds: Shift erases, "
                            "Ctrl+wheel changes its size"));
  grid->addWidget(paint_mix_, grid->rowCount(), 1, 1, 2);
  connect(paint_mix_, &QToolButton::clicked, this, [this](bool on) {
    ToolSettings tools = session_.document().tools();
    tools.tool = on ? Tool::mix : Tool::translate;
    session_.document().set_tools(tools);
  });
  connect(&session_.document(), &Document::toolsChanged, this, &GeneratePanel::update_options);
}

void GeneratePanel::show_parts() {
  QMenu* menu = region_->menu();
  menu->clear();
  const Document& document = session_.document();
  if (!document.has_model()) {
    return;
  }
  const auto& region = document.state().region;
  QAction* whole = menu->addAction(tr("The Whole Model"));
  whole->setCheckable(true);
  whole->setChecked(!region);
  connect(whole, &QAction::triggered, &session_, &Session::choose_whole_model);
  QAction* rest = menu->addAction(tr("All but Specks"));
  rest->setToolTip(tr("Without tiny pieces far from the rest, such as dust in a scan, and vertices "
                      "that no face uses"));
  connect(rest, &QAction::triggered, &session_, &Session::choose_all_but_specks);
  menu->addSeparator();
  for (NamedPart& part : named_parts(*document.model())) {
    QAction* action = menu->addAction(part.name);
    action->setCheckable(true);
    action->setChecked(region && has_part(region->faces, part));
    action->setToolTip(tr("%L1 faces").arg(part.faces.size()));
    connect(action, &QAction::triggered, this,
            [this, part = std::move(part)](bool on) { take_part(part, on); });
  }
  menu->addSeparator();
  QAction* paint = menu->addAction(icon("tool_region"), tr("Paint It..."));
  paint->setToolTip(tr("With the brush, on the model, or with Ctrl by drawing round it"));
  connect(paint, &QAction::triggered, this, [this] {
    ToolSettings tools = session_.document().tools();
    tools.tool = Tool::region;
    session_.document().set_tools(tools);
  });
}

/// Besides what is chosen already, or no more.
void GeneratePanel::take_part(const NamedPart& part, bool on) {
  const auto& region = session_.document().state().region;
  std::vector<Index> faces;
  if (region && on) {
    std::ranges::set_union(region->faces, part.faces, std::back_inserter(faces));
  } else if (region) {
    std::ranges::set_difference(region->faces, part.faces, std::back_inserter(faces));
  } else {
    faces = part.faces;
  }
  if (faces.empty()) {
    session_.choose_whole_model();
    return;
  }
  QStringList names;
  for (const NamedPart& other : named_parts(*session_.document().model())) {
    if (has_part(faces, other)) {
      names.append(other.name);
    }
  }
  session_.choose_region(names.isEmpty() ? tr("the painted part") : names.join(", "),
                         std::move(faces));
}

void GeneratePanel::update_region() {
  const Document& document = session_.document();
  const auto& region = document.state().region;
  static_cast<ChoiceButton*>(region_)->say(region ? region->name : tr("the whole model"));
  region_->setEnabled(document.has_model() && document.mode() == Mode::refine);
}

template <class Set> void GeneratePanel::change(const Set& set) {
  GenerateSettings settings = session_.settings();
  set(settings);
  session_.set_settings(settings);
}

GeneratePanel::Field GeneratePanel::field_of(const GenerateOption::Integer& integer) {
  auto* box = new QSpinBox;
  box->setRange(integer.least, integer.most);
  box->setSpecialValueText(integer.at_least);
  connect(box, &QSpinBox::valueChanged, this, [this, &integer](int value) {
    change([&](GenerateSettings& s) { integer.set(s, value); });
  });
  return {box, [this, box, &integer] {
            const QSignalBlocker blocker(box);
            box->setValue(integer.get(session_.settings()));
          }};
}

GeneratePanel::Field GeneratePanel::field_of(const GenerateOption::Number& number) {
  auto* box = new QDoubleSpinBox;
  box->setRange(number.least, number.most);
  box->setDecimals(number.decimals);
  box->setSingleStep(number.step);
  box->setSpecialValueText(number.at_least);
  connect(box, &QDoubleSpinBox::valueChanged, this, [this, &number](double value) {
    change([&](GenerateSettings& s) { number.value(s) = value; });
  });
  return {box, [this, box, &number] {
            GenerateSettings settings = session_.settings();
            const QSignalBlocker blocker(box);
            box->setValue(number.value(settings));
          }};
}

GeneratePanel::Field GeneratePanel::field_of(const GenerateOption::Choice& choice) {
  auto* box = new QComboBox;
  box->addItems(choice.labels);
  connect(box, &QComboBox::currentIndexChanged, this,
          [this, &choice](int at) { change([&](GenerateSettings& s) { choice.set(s, at); }); });
  return {box, [this, box, &choice] {
            const QSignalBlocker blocker(box);
            box->setCurrentIndex(choice.get(session_.settings()));
          }};
}

GeneratePanel::Field GeneratePanel::field_of(const GenerateOption::File& file) {
  auto* line = new QLineEdit;
  line->setPlaceholderText(tr("None"));
  QAction* browse = line->addAction(style()->standardIcon(QStyle::SP_DialogOpenButton),
                                    QLineEdit::TrailingPosition);
  browse->setToolTip(tr("Choose a file"));
  connect(browse, &QAction::triggered, this, [this, line, &file] {
    const QString path = QFileDialog::getOpenFileName(this, tr("Choose a File"), {}, file.filter);
    if (!path.isEmpty()) {
      line->setText(path);
    }
  });
  connect(line, &QLineEdit::textChanged, this, [this, &file](const QString& path) {
    change([&](GenerateSettings& s) { file.value(s) = path; });
  });
  return {line, [this, line, &file] {
            GenerateSettings settings = session_.settings();
            const QSignalBlocker blocker(line);
            if (line->text() != file.value(settings)) { // the cursor stays where it is typed
              line->setText(file.value(settings));
            }
          }};
}

void GeneratePanel::add_option(const GenerateOption& option, QGridLayout* grid) {
  Field field = std::visit([this](const auto& kind) { return field_of(kind); }, option.kind);
  field.editor->setObjectName(option.key);
  field.editor->setToolTip(option.help);
  field.editor->setAccessibleName(option.label);
  field.editor->setAccessibleDescription(option.help);
  field.editor->setFocusPolicy(Qt::StrongFocus);
  field.editor->installEventFilter(new IgnoreWheel(field.editor));
  // Narrow panels have narrow fields, not cut ones.
  field.editor->setMinimumWidth(60);
  field.editor->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  auto* label = new QLabel(option.label);
  label->setToolTip(option.help);
  label->setBuddy(field.editor);
  auto* ask = new QToolButton;
  ask->setObjectName("help_" + option.key);
  ask->setText("?");
  ask->setAutoRaise(true);
  ask->setCheckable(true);
  ask->setToolTip(option.help);
  ask->setAccessibleName(tr("Help on %1").arg(option.label));
  QLabel* help = explanation(option.help);
  const int row = grid->rowCount();
  grid->addWidget(label, row, 0);
  grid->addWidget(field.editor, row, 1);
  grid->addWidget(ask, row, 2);
  grid->addWidget(help, row + 1, 0, 1, 3);
  connect(ask, &QToolButton::toggled, this, &GeneratePanel::update_options);
  rows_.push_back({&option, {label, field.editor, ask}, help, std::move(field.show_value)});
}

void GeneratePanel::update_options() {
  const bool advanced = advanced_->isChecked();
  advanced_->setArrowType(advanced ? Qt::DownArrow : Qt::RightArrow);
  defaults_->setVisible(advanced);
  std::set<GenerateOption::Group> shown;
  for (const Row& row : rows_) {
    row.show_value();
    const GenerateOption::Group group = row.option->group;
    const bool visible = row.option->applies(session_.settings()) &&
                         (advanced || group == GenerateOption::Group::basic ||
                          group == GenerateOption::Group::binding);
    for (QWidget* field : row.fields) {
      field->setVisible(visible);
    }
    row.explanation->setVisible(visible && qobject_cast<QToolButton*>(row.fields[2])->isChecked());
    if (visible) {
      shown.insert(group);
    }
  }
  for (const auto& [group, title] : titles_) {
    title->setVisible(shown.contains(group));
  }
  const bool mixes = coordinate_choice(session_.settings()).second.has_value();
  paint_mix_->setVisible(mixes);
  paint_mix_->setEnabled(session_.document().has_model());
  paint_mix_->setChecked(session_.document().tools().tool == Tool::mix);
}

void GeneratePanel::update_buttons() {
  const Document& document = session_.document();
  const bool free = !session_.jobs().busy();
  const bool deforming = document.mode() == Mode::deform;
  generate_->setEnabled(free && document.has_model());
  load_->setEnabled(free && document.has_model());
  bind_->setEnabled(free && document.has_model() && document.has_cage());
  bind_->setVisible(!deforming);
  refine_->setVisible(deforming);
  paint_mix_->setEnabled(document.has_model());
  update_region();
}

} // namespace cagewright::app
