#include "app/panels/tool_bar.h"

#include "app/icons.h"

#include <QActionGroup>
#include <QDoubleSpinBox>
#include <QMenu>
#include <QSignalBlocker>
#include <QToolButton>

#include <array>
#include <cmath>

namespace cagewright::app {
namespace {

struct Named {
  const char* name;
  const char* text;
  const char* help;
};

constexpr std::array<Named, 9> tool_names = {
    Named{"tool_box", "Box",
          "Drag a box round what to select (B). Shift adds, Shift+Ctrl takes away"},
    Named{"tool_lasso", "Lasso", "Draw round what to select. With any tool: hold Ctrl"},
    Named{"tool_move", "Move", "Drag the arrows to move the selection. G moves it at once"},
    Named{"tool_rotate", "Rotate", "Drag the rings to turn the selection. R turns it at once"},
    Named{"tool_scale", "Scale", "Drag the handles to scale the selection. S scales it at once"},
    Named{"tool_pull", "Drag Model",
          "Drag the bound model itself: the cage is bent to suit. A click leaves a pin that holds "
          "it; Ctrl+click takes the pin away"},
    Named{"tool_paint", "Paint Density",
          "Paint on the model where the next cage is to be finer. Ctrl: coarser, Shift: erase, "
          "Ctrl+wheel: size of the brush"},
    Named{"tool_region", "Paint What the Cage Is For",
          "Paint the part of the model that the cage is for; the rest stays where it is. Shift: "
          "erase, Ctrl: draw round it, Ctrl+wheel: size of the brush"},
    Named{"tool_mix", "Paint Mix",
          "Paint where the model follows by the second kind of coordinates, bound or not. Shift: "
          "erase, Ctrl+wheel: size of the brush"}};

struct Switch {
  Named named;
  bool ToolSettings::*value;
};

constexpr std::array<Switch, 6> switch_names = {
    Switch{{"see_through", "See Through", "Also select what the faces of the cage hide"},
           &ToolSettings::see_through},
    Switch{{"snap", "Snap", "Movements go in steps; hold Ctrl for the opposite"},
           &ToolSettings::snap},
    Switch{{"proportional", "Proportional", "Neighbors follow, less with distance (O)"},
           &ToolSettings::proportional},
    Switch{{"connected_only", "Connected",
            "Proportional editing measures along the edges of the cage, not through the air: the "
            "other leg stays where it is"},
           &ToolSettings::connected_only},
    Switch{{"symmetric", "Symmetric",
            "The mirror image of what is edited follows: movements and changes of faces alike"},
           &ToolSettings::symmetric},
    Switch{{"stop_at_contact", "Stop at Contact",
            "While refining: drags go no further than the cage stays valid"},
           &ToolSettings::stop_at_contact}};

struct ChoiceText {
  Named named;
  std::array<Named, 3> entries;
  int (*get)(const ToolSettings&);
  void (*set)(ToolSettings&, int);
};

constexpr std::array<ChoiceText, 4> choice_names = {
    ChoiceText{{"axes", "Axes", "Along which axes the gizmo and the keys X, Y, Z work"},
               {Named{"axes_world", "World", "The axes of the model's file"},
                Named{"axes_local", "Local", "Z along the normal of the selection"},
                Named{"axes_view", "View", "X to the right, Y up, Z towards you"}},
               [](const ToolSettings& t) { return static_cast<int>(t.axes); },
               [](ToolSettings& t, int i) { t.axes = static_cast<AxesKind>(i); }},
    ChoiceText{{"pivot", "Pivot", "The point that stays where it is when turning and scaling"},
               {Named{"pivot_median", "Median", "The mean of the selected vertices"},
                Named{"pivot_box", "Middle", "The middle of the box round the selection"},
                Named{"pivot_individual", "Each Part",
                      "Each connected part of the selection turns about its own middle"}},
               [](const ToolSettings& t) { return static_cast<int>(t.pivot); },
               [](ToolSettings& t, int i) { t.pivot = static_cast<Pivot>(i); }},
    ChoiceText{{"falloff", "Falloff", "How much neighbors follow in proportional editing"},
               {Named{"falloff_smooth", "Smooth", "Soft at both ends: a round hill"},
                Named{"falloff_linear", "Linear", "Evenly less with distance: a cone"},
                Named{"falloff_sharp", "Sharp", "Much less soon: a peak"}},
               [](const ToolSettings& t) { return static_cast<int>(t.falloff); },
               [](ToolSettings& t, int i) { t.falloff = static_cast<Falloff>(i); }},
    ChoiceText{{"mirror", "Mirror Plane",
                "The plane of symmetric editing and of mirrored "
                "selections, by its normal"},
               {Named{"mirror_x", "Across X", "Left and right of models that look along Z"},
                Named{"mirror_y", "Across Y", "The plane across the Y axis"},
                Named{"mirror_z", "Across Z", "The plane across the Z axis"}},
               [](const ToolSettings& t) { return t.symmetry_axis; },
               [](ToolSettings& t, int i) { t.symmetry_axis = i; }}};

enum : std::size_t { choose_axes, choose_pivot, choose_falloff, choose_mirror };

/// The step of snapping that the tool goes in, its limits and its unit.
struct StepOf {
  double ToolSettings::*value;
  double most;
  double step;
  int decimals;
  const char* suffix;
  const char* help;
};

StepOf step_of(Tool tool) {
  switch (tool) {
  case Tool::rotate:
    return {&ToolSettings::snap_angle_degrees, 90, 5, 1, "\u00b0", "Step of turning, in degrees"};
  case Tool::scale:
    return {&ToolSettings::snap_scale, 1, 0.05, 3, "", "Step of scaling, as a factor"};
  default:
    return {&ToolSettings::snap_step,
            0.5,
            0.005,
            3,
            "",
            "Step of moving, as a fraction of the model's diagonal"};
  }
}

void tell(QAction* action, const Named& named) {
  action->setObjectName(named.name);
  action->setIcon(icon(named.name));
  action->setToolTip(
      QString("<b>%1</b><br>%2").arg(ToolBar::tr(named.text), ToolBar::tr(named.help)));
  action->setStatusTip(ToolBar::tr(named.help));
  action->setCheckable(true);
}

} // namespace

ToolBar::ToolBar(Document& document, QWidget* parent)
    : QToolBar(tr("Tools"), parent), document_(document) {
  setObjectName("tools");
  setIconSize(QSize(20, 20));
  setToolButtonStyle(Qt::ToolButtonIconOnly);
  add_tools();
  addSeparator();
  add_choice(choose_axes);
  add_choice(choose_pivot);
  addSeparator();
  for (std::size_t i = 0; i < switch_names.size(); ++i) {
    const bool ToolSettings::*value = switch_names[i].value;
    if (value == &ToolSettings::connected_only) {
      radius_ = add_number(
          "radius", 0.001, 10, 0.02, 3,
          tr("How far proportional editing reaches, as a fraction of the diagonal (the wheel "
             "changes it while dragging)"));
      connect(radius_, &QDoubleSpinBox::valueChanged, this,
              [this](double v) { change([&](ToolSettings& t) { t.proportional_radius = v; }); });
      add_choice(choose_falloff);
    }
    add_switch(i);
    if (value == &ToolSettings::snap) {
      step_ = add_number("snap_step", 0.001, 90, 0.005, 3, {});
      connect(step_, &QDoubleSpinBox::valueChanged, this,
              [this](double v) { change([&](ToolSettings& t) { t.*step_of(t.tool).value = v; }); });
    } else if (value == &ToolSettings::symmetric) {
      add_choice(choose_mirror);
    }
  }
  connect(&document, &Document::toolsChanged, this, &ToolBar::update_tools);
  update_tools();
}

void ToolBar::add_tools() {
  tools_ = new QActionGroup(this);
  for (std::size_t i = 0; i < tool_names.size(); ++i) {
    QAction* action = addAction(tr(tool_names[i].text));
    tell(action, tool_names[i]);
    tools_->addAction(action);
    connect(action, &QAction::triggered, this,
            [this, i] { change([&](ToolSettings& t) { t.tool = static_cast<Tool>(i); }); });
  }
}

void ToolBar::add_switch(std::size_t number) {
  const Switch& s = switch_names[number];
  QAction* action = addAction(tr(s.named.text));
  tell(action, s.named);
  connect(action, &QAction::toggled, this,
          [this, &s](bool on) { change([&](ToolSettings& t) { t.*s.value = on; }); });
  switches_.append(action);
}

void ToolBar::add_choice(std::size_t number) {
  const ChoiceText& text = choice_names[number];
  Choice choice{new QToolButton, new QMenu(tr(text.named.text), this), new QActionGroup(this),
                text.get};
  for (int i = 0; i < 3; ++i) {
    const Named& named = text.entries[static_cast<std::size_t>(i)];
    QAction* action = choice.menu->addAction(tr(named.text));
    tell(action, named);
    choice.entries->addAction(action);
    connect(action, &QAction::triggered, this,
            [this, &text, i] { change([&](ToolSettings& t) { text.set(t, i); }); });
  }
  choice.button->setObjectName(text.named.name);
  choice.button->setIcon(icon(text.named.name));
  choice.button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  choice.button->setToolTip(
      QString("<b>%1</b><br>%2").arg(tr(text.named.text), tr(text.named.help)));
  choice.button->setAccessibleName(tr(text.named.text));
  choice.button->setPopupMode(QToolButton::InstantPopup);
  choice.button->setMenu(choice.menu);
  choice.button->setAutoRaise(true);
  choice.button->setStyleSheet( // with room for the arrow
      "QToolButton { padding-right: 13px; } "
      "QToolButton::menu-indicator { subcontrol-origin: padding; subcontrol-position: right "
      "center; "
      "right: 2px; }");
  connect(choice.menu, &QMenu::aboutToHide, choice.button, [button = choice.button] {
    // A click elsewhere closes the menu; that the pointer has gone nobody tells the button.
    const bool under = button->rect().contains(button->mapFromGlobal(QCursor::pos()));
    button->setAttribute(Qt::WA_UnderMouse, under);
    button->update();
  });
  addWidget(choice.button);
  choices_.push_back(choice);
}

QDoubleSpinBox* ToolBar::add_number(const char* name, double least, double most, double step,
                                    int decimals, const QString& help) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setRange(least, most);
  box->setDecimals(decimals);
  box->setSingleStep(step);
  box->setToolTip(help);
  box->setKeyboardTracking(false);
  addWidget(box);
  return box;
}

void ToolBar::add_to(QMenu* menu) const {
  menu->addActions(tools_->actions());
  menu->addSeparator();
  menu->addActions(switches_);
  menu->addSeparator();
  for (const Choice& choice : choices_) {
    menu->addMenu(choice.menu);
  }
}

template <class Set> void ToolBar::change(const Set& set) {
  ToolSettings tools = document_.tools();
  set(tools);
  document_.set_tools(tools);
}

void ToolBar::update_tools() {
  const ToolSettings& tools = document_.tools();
  tools_->actions()[static_cast<int>(tools.tool)]->setChecked(true);
  for (int i = 0; i < switches_.size(); ++i) {
    switches_[i]->setChecked(tools.*switch_names[static_cast<std::size_t>(i)].value);
  }
  for (const Choice& choice : choices_) {
    QAction* entry = choice.entries->actions()[choice.chosen(tools)];
    entry->setChecked(true);
    choice.button->setText(entry->text());
  }
  const QSignalBlocker blockers[] = {QSignalBlocker(step_), QSignalBlocker(radius_)};
  const StepOf step = step_of(tools.tool);
  step_->setRange(0.001, step.most);
  step_->setDecimals(step.decimals);
  step_->setSingleStep(step.step);
  step_->setSuffix(step.suffix);
  step_->setToolTip(tr(step.help));
  step_->setValue(tools.*step.value);
  radius_->setValue(tools.proportional_radius);
}

} // namespace cagewright::app
