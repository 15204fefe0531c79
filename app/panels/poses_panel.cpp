#include "app/panels/poses_panel.h"

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

constexpr int blend_steps = 200;
// Of a slider of the mixer, from nothing to all of a pose. Numbers go farther.
constexpr int share_steps = 100;
constexpr double most_share = 5;

} // namespace

PosesPanel::PosesPanel(Editor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor), document_(editor.document()) {
  auto* layout = new QVBoxLayout(this);
  list_ = new QListWidget;
  list_->setObjectName("poses");
  list_->setToolTip(tr("Double-click applies a pose, F2 renames it"));
  list_->setEditTriggers(QAbstractItemView::EditKeyPressed);
  list_->setMinimumHeight(50);
  layout->addWidget(list_, 1);

  const auto button = [this](const char* name, const QString& text, const QString& help) {
    auto* made = new QPushButton(text);
    made->setObjectName(name);
    made->setToolTip(help);
    return made;
  };
  add_ = button("add_pose", tr("Keep"), tr("Keeps the cage as it is now as a new pose (Ctrl+K)"));
  update_ = button("update_pose", tr("Replace"), tr("The cage as it is becomes this pose"));
  apply_ = button("apply_pose", tr("Apply"), tr("The cage takes this pose"));
  remove_ = button("remove_pose", tr("Remove"), tr("Forgets this pose"));
  reset_ = button("reset_pose", tr("Reset"), tr("The cage goes back to rest (Ctrl+Shift+R)"));
  compare_ = button("compare", tr("Compare"), tr("Hold to see the model at rest (hold C)"));
  auto* grid = new QGridLayout;
  grid->addWidget(add_, 0, 0);
  grid->addWidget(apply_, 0, 1);
  grid->addWidget(update_, 1, 0);
  grid->addWidget(remove_, 1, 1);
  grid->addWidget(reset_, 2, 0);
  grid->addWidget(compare_, 2, 1);
  layout->addLayout(grid);

  mixer_ = new QWidget;
  mixer_->setObjectName("mixer");
  layout->addWidget(mixer_);
  layout->addWidget(new QLabel(tr("From rest to pose")));
  blend_ = new QSlider(Qt::Horizontal);
  blend_->setObjectName("blend");
  blend_->setRange(0, blend_steps);
  blend_->setValue(blend_steps);
  blend_->setToolTip(tr("How much of the pose is shown. Dragging the cage goes on from there"));
  layout->addWidget(blend_);

  connect(add_, &QPushButton::clicked, this, &PosesPanel::add_pose);
  const auto with_current = [this](auto act) {
    return [this, act] {
      if (list_->currentRow() >= 0) {
        act(static_cast<std::size_t>(list_->currentRow()));
      }
    };
  };
  connect(update_, &QPushButton::clicked, this,
          with_current([this](std::size_t pose) { editor_.update_pose(pose); }));
  connect(apply_, &QPushButton::clicked, this,
          with_current([this](std::size_t pose) { editor_.apply_pose(pose); }));
  connect(remove_, &QPushButton::clicked, this,
          with_current([this](std::size_t pose) { editor_.remove_pose(pose); }));
  connect(list_, &QListWidget::itemDoubleClicked, this,
          with_current([this](std::size_t pose) { editor_.apply_pose(pose); }));
  connect(reset_, &QPushButton::clicked, this, [this] { editor_.reset_pose(); });
  connect(compare_, &QPushButton::pressed, this, [this] { document_.set_comparing(true); });
  connect(compare_, &QPushButton::released, this, [this] { document_.set_comparing(false); });
  connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
    const auto pose = static_cast<std::size_t>(list_->row(item));
    // Not at once: the list is in the middle of editing.
    QMetaObject::invokeMethod(
        this,
        [this, pose, name = item->text()] {
          if (pose < document_.state().poses.size()) {
            editor_.rename_pose(pose, name);
          }
          update_list();
        },
        Qt::QueuedConnection);
  });
  connect(list_, &QListWidget::currentRowChanged, this, &PosesPanel::update_buttons);
  connect(blend_, &QSlider::valueChanged, this,
          [this](int value) { document_.set_blend(static_cast<double>(value) / blend_steps); });
  connect(&document_, &Document::posesChanged, this, &PosesPanel::update_list);
  connect(&document_, &Document::modeChanged, this, &PosesPanel::update_buttons);
  connect(&document_, &Document::viewStateChanged, this, &PosesPanel::update_blend);
  connect(&document_, &Document::viewStateChanged, this, &PosesPanel::update_mixer);
  connect(&document_, &Document::timeLineChanged, this, &PosesPanel::update_mixer);
  update_list();
}

void PosesPanel::add_pose() {
  if (document_.mode() != Mode::deform) {
    return;
  }
  const auto& poses = document_.state().poses;
  for (std::size_t n = poses.size() + 1;; ++n) {
    const QString name = tr("Pose %1").arg(n);
    if (std::ranges::none_of(poses, [&](const Pose& p) { return p.name == name; })) {
      editor_.add_pose(name);
      list_->setCurrentRow(list_->count() - 1);
      return;
    }
  }
}

void PosesPanel::update_list() {
  const QSignalBlocker blocker(list_); // (while a slider is dragged only the mixer changes)
  const int row = list_->currentRow();
  list_->clear();
  for (const Pose& pose : document_.state().poses) {
    auto* item = new QListWidgetItem(pose.name, list_);
    item->setFlags(item->flags() | Qt::ItemIsEditable);
  }
  list_->setCurrentRow(std::min(row, list_->count() - 1));
  update_buttons();
  update_mixer();
}

/// A slider and a number for each pose.
void PosesPanel::make_mixer() {
  shares_.clear();
  qDeleteAll(mixer_->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
  delete mixer_->layout();
  auto* grid = new QGridLayout(mixer_);
  grid->setContentsMargins(0, 4, 0, 4);
  grid->setColumnStretch(1, 1);
  if (!mixed_.empty()) {
    auto* title = new QLabel(tr("Mix of poses"));
    title->setToolTip(tr("How much of each pose is in the cage; what the poses move is added. A "
                         "keyframe (K) keeps the mix"));
    grid->addWidget(title, 0, 0, 1, 3);
  }
  for (std::size_t p = 0; p < mixed_.size(); ++p) {
    const int row = static_cast<int>(p) + 1;
    auto* name = new QLabel(mixed_[p]);
    name->setMaximumWidth(90);
    name->setToolTip(mixed_[p]);
    auto* slider = new QSlider(Qt::Horizontal);
    slider->setObjectName(QString("share_%1").arg(p));
    slider->setAccessibleName(mixed_[p]);
    slider->setRange(0, share_steps);
    slider->setFocusPolicy(Qt::TabFocus);
    auto* number = new QDoubleSpinBox;
    number->setObjectName(QString("share_number_%1").arg(p));
    number->setRange(-most_share, most_share);
    number->setSingleStep(0.05);
    number->setKeyboardTracking(false);
    grid->addWidget(name, row, 0);
    grid->addWidget(slider, row, 1);
    grid->addWidget(number, row, 2);
    connect(slider, &QSlider::sliderPressed, this, [this] { editor_.begin_mix(); });
    connect(slider, &QSlider::sliderReleased, this, [this] { editor_.end_mix(); });
    connect(slider, &QSlider::valueChanged, this, [this, p](int value) {
      editor_.mix_pose(p, static_cast<double>(value) / share_steps);
    });
    connect(number, &QDoubleSpinBox::valueChanged, this,
            [this, p](double value) { editor_.mix_pose(p, value); });
    shares_.push_back({slider, number});
  }
}

void PosesPanel::update_mixer() {
  std::vector<QString> names;
  for (const Pose& pose : document_.state().poses) {
    names.push_back(pose.name);
  }
  if (names != mixed_ || mixer_->layout() == nullptr) {
    mixed_ = std::move(names);
    make_mixer();
  }
  const std::vector<double> shares = document_.shown_pose_shares();
  for (std::size_t p = 0; p < shares_.size(); ++p) {
    const QSignalBlocker blockers[] = {QSignalBlocker(shares_[p].slider),
                                       QSignalBlocker(shares_[p].number)};
    shares_[p].slider->setValue(static_cast<int>(std::lround(share_steps * shares[p])));
    shares_[p].number->setValue(shares[p]);
  }
  mixer_->setEnabled(document_.mode() == Mode::deform);
}

void PosesPanel::update_buttons() {
  const bool deforming = document_.mode() == Mode::deform;
  for (QWidget* widget : std::initializer_list<QWidget*>{add_, reset_, compare_, blend_}) {
    widget->setEnabled(deforming);
  }
  for (QWidget* widget : {update_, apply_, remove_}) {
    widget->setEnabled(deforming && list_->currentRow() >= 0);
  }
  if (mixer_ != nullptr) {
    mixer_->setEnabled(deforming);
  }
}

void PosesPanel::update_blend() {
  const QSignalBlocker blocker(blend_);
  blend_->setValue(static_cast<int>(std::lround(document_.blend() * blend_steps)));
}

} // namespace cagewright::app
