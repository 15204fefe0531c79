#include "app/panels/selection_panel.h"

#include "app/commands/cage_actions.h"
#include "app/document/selected_vertices.h"

#include <QButtonGroup>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace cagewright::app {

SelectionPanel::SelectionPanel(Editor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor), document_(editor.document()) {
  auto* layout = new QVBoxLayout(this);
  auto* row = new QHBoxLayout;
  auto* group = new QButtonGroup(this);
  const std::array<std::pair<QString, QString>, 3> names = {
      {{tr("Vertices"), tr("Select vertices (1)")},
       {tr("Edges"), tr("Select edges (2)")},
       {tr("Faces"), tr("Select faces (3)")}}};
  for (std::size_t i = 0; i < 3; ++i) {
    modes_[i] = new QToolButton;
    modes_[i]->setText(names[i].first);
    modes_[i]->setToolTip(names[i].second);
    modes_[i]->setCheckable(true);
    modes_[i]->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
    group->addButton(modes_[i], static_cast<int>(i));
    row->addWidget(modes_[i]);
  }
  connect(group, &QButtonGroup::idClicked, this, [this](int mode) {
    constexpr std::array actions = {CageAction::vertex_mode, CageAction::edge_mode,
                                    CageAction::face_mode};
    perform(actions[static_cast<std::size_t>(mode)], editor_);
    update_selection(); // without a cage the mode stays
  });
  layout->addLayout(row);
  summary_ = new QLabel;
  summary_->setObjectName("selection_summary");
  layout->addWidget(summary_);
  auto* form = new QFormLayout;
  const std::array<const char*, 3> axes = {"X", "Y", "Z"};
  for (std::size_t i = 0; i < 3; ++i) {
    auto* box = new QDoubleSpinBox;
    box->setObjectName(QString("position_%1").arg(axes[i]).toLower());
    box->setRange(-1e9, 1e9);
    box->setKeyboardTracking(false);
    box->setToolTip(tr("Position of the middle of the selection. Type a number to move it there"));
    box->setAccessibleName(tr("Position %1").arg(axes[i]));
    connect(box, &QDoubleSpinBox::valueChanged, this, &SelectionPanel::move_to_typed);
    form->addRow(axes[i], box);
    position_[i] = box;
  }
  layout->addLayout(form);
  layout->addStretch();
  connect(&document_, &Document::selectionChanged, this, &SelectionPanel::update_selection);
  connect(&document_, &Document::cageMoved, this, &SelectionPanel::update_selection);
  connect(&document_, &Document::cageChanged, this, &SelectionPanel::update_selection);
  update_selection();
}

Vec3 SelectionPanel::middle() const {
  const std::vector<Index> vertices =
      selected_vertices(document_.selection(), document_.cage_rest());
  Vec3 sum = Vec3::Zero();
  for (const Index v : vertices) {
    sum += document_.shown_cage_positions()[v];
  }
  return sum / static_cast<double>(vertices.size());
}

void SelectionPanel::update_selection() {
  const Selection& selection = document_.selection();
  modes_[static_cast<std::size_t>(selection.mode)]->setChecked(true);
  const bool any = document_.has_cage() && !selection.empty();
  const bool one = selection.size() == 1;
  const QString what = selection.mode == SelectionMode::vertex ? one ? tr("vertex") : tr("vertices")
                       : selection.mode == SelectionMode::edge ? one ? tr("edge") : tr("edges")
                       : one ? tr("face")
                                                               : tr("faces");
  summary_->setText(any ? tr("%L1 %2 selected").arg(selection.size()).arg(what)
                        : tr("Nothing is selected"));
  if (any) {
    shown_ = middle();
  }
  // Seven digits of what the model's size makes of them.
  const int decimals =
      std::clamp(6 - static_cast<int>(std::floor(std::log10(document_.diagonal()))), 0, 12);
  for (std::size_t i = 0; i < 3; ++i) {
    const QSignalBlocker blocker(position_[i]);
    position_[i]->setEnabled(any);
    position_[i]->setDecimals(decimals);
    position_[i]->setSingleStep(document_.diagonal() / 100);
    position_[i]->setValue(any ? shown_[static_cast<int>(i)] : 0);
  }
}

void SelectionPanel::move_to_typed() {
  if (!document_.has_cage() || document_.selection().empty() || editor_.moving()) {
    return;
  }
  Vec3 by = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    if (sender() == position_[i]) {
      by[static_cast<int>(i)] = position_[i]->value() - shown_[static_cast<int>(i)];
    }
  }
  std::vector<Index> vertices = selected_vertices(document_.selection(), document_.cage_rest());
  std::vector<Vec3> positions;
  for (const Index v : vertices) {
    positions.push_back(document_.shown_cage_positions()[v] + by);
  }
  editor_.move(std::move(vertices), positions, tr("Move"));
}

} // namespace cagewright::app
