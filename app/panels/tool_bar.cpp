#include "app/panels/tool_bar.h"

#include <QActionGroup>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSignalBlocker>

#include <array>

namespace cagewright::app {
namespace {

struct Named {
  const char* name;
  const char* text;
  const char* help;
};

constexpr std::array<Named, 5> tool_names = {
    Named{"tool_box", "Select Box",
          "Drag a box round what to select (B). Shift adds, Shift+Ctrl takes away"},
    Named{"tool_lasso", "Lasso", "Draw round what to select. With any tool: hold Ctrl"},
    Named{"tool_move", "Move", "Drag the arrows to move the selection. G moves it at once"},
    Named{"tool_rotate", "Rotate", "Drag the rings to turn the selection. R turns it at once"},
    Named{"tool_scale", "Scale", "Drag the handles to scale the selection. S scales it at once"}};

struct Switch {
  Named named;
  bool ToolSettings::*value;
};

const std::array<Switch, 5> switch_names = {
    Switch{{"see_through", "See Through", "Also select what the faces of the cage hide"},
           &ToolSettings::see_through},
    Switch{{"snap", "Snap", "Movements go in steps; hold Ctrl for the opposite"},
           &ToolSettings::snap},
    Switch{{"proportional", "Proportional", "Neighbors follow, less with distance"},
           &ToolSettings::proportional},
    Switch{{"symmetric", "Symmetric", "The mirror image of the selection follows"},
           &ToolSettings::symmetric},
    Switch{{"stop_at_contact", "Stop at Contact",
            "While refining: drags go no further than the cage stays valid"},
           &ToolSettings::stop_at_contact}};

} // namespace

ToolBar::ToolBar(Document& document, QWidget* parent)
    : QToolBar(tr("Tools"), parent), document_(document) {
  setObjectName("tools");
  tools_ = new QActionGroup(this);
  for (std::size_t i = 0; i < tool_names.size(); ++i) {
    QAction* action = addAction(tr(tool_names[i].text));
    action->setObjectName(tool_names[i].name);
    action->setToolTip(tr(tool_names[i].help));
    action->setStatusTip(tr(tool_names[i].help));
    action->setCheckable(true);
    tools_->addAction(action);
    connect(action, &QAction::triggered, this,
            [this, i] { change([&](ToolSettings& t) { t.tool = static_cast<Tool>(i); }); });
  }
  addSeparator();
  axes_ = new QComboBox;
  axes_->addItems({tr("World axes"), tr("Local axes"), tr("View axes")});
  axes_->setToolTip(tr("Along which axes the gizmo moves"));
  connect(axes_, &QComboBox::currentIndexChanged, this,
          [this](int i) { change([&](ToolSettings& t) { t.axes = static_cast<AxesKind>(i); }); });
  addWidget(axes_);
  addSeparator();
  for (const Switch& s : switch_names) {
    QAction* action = addAction(tr(s.named.text));
    action->setObjectName(s.named.name);
    action->setToolTip(tr(s.named.help));
    action->setStatusTip(tr(s.named.help));
    action->setCheckable(true);
    connect(action, &QAction::toggled, this,
            [this, &s](bool on) { change([&](ToolSettings& t) { t.*s.value = on; }); });
    switches_.append(action);
    if (s.value == &ToolSettings::snap) {
      step_ = new QDoubleSpinBox;
      step_->setRange(0.001, 0.5);
      step_->setDecimals(3);
      step_->setSingleStep(0.005);
      step_->setToolTip(tr("Step of snapping, as a fraction of the model's diagonal"));
      connect(step_, &QDoubleSpinBox::valueChanged, this,
              [this](double v) { change([&](ToolSettings& t) { t.snap_step = v; }); });
      addWidget(step_);
    } else if (s.value == &ToolSettings::proportional) {
      radius_ = new QDoubleSpinBox;
      radius_->setRange(0.001, 2);
      radius_->setDecimals(3);
      radius_->setSingleStep(0.02);
      radius_->setToolTip(
          tr("How far proportional editing reaches, as a fraction of the diagonal"));
      connect(radius_, &QDoubleSpinBox::valueChanged, this,
              [this](double v) { change([&](ToolSettings& t) { t.proportional_radius = v; }); });
      addWidget(radius_);
    } else if (s.value == &ToolSettings::symmetric) {
      mirror_ = new QComboBox;
      mirror_->addItems({tr("across X"), tr("across Y"), tr("across Z")});
      mirror_->setToolTip(tr("The normal of the mirror plane"));
      connect(mirror_, &QComboBox::currentIndexChanged, this,
              [this](int i) { change([&](ToolSettings& t) { t.symmetry_axis = i; }); });
      addWidget(mirror_);
    }
  }
  connect(&document, &Document::toolsChanged, this, &ToolBar::update_tools);
  update_tools();
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
  const QSignalBlocker blockers[] = {QSignalBlocker(axes_), QSignalBlocker(mirror_),
                                     QSignalBlocker(step_), QSignalBlocker(radius_)};
  axes_->setCurrentIndex(static_cast<int>(tools.axes));
  mirror_->setCurrentIndex(tools.symmetry_axis);
  step_->setValue(tools.snap_step);
  radius_->setValue(tools.proportional_radius);
}

} // namespace cagewright::app
