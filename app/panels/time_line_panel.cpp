#include "app/panels/time_line_panel.h"

#include "app/icons.h"

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QPainter>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

constexpr double margin = 14;

/// 1, 2, 5, 10, ... so that at least `least` frames lie between two.
int tick_step(double least) {
  int step = 1;
  for (int i = 0; step < least && i < 24; ++i) {
    step = i % 3 == 1 ? step / 2 * 5 : step * 2;
  }
  return step;
}

} // namespace

TimeRuler::TimeRuler(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setObjectName("time_ruler");
  setAccessibleName(tr("Time line"));
  setToolTip(tr("Click to go to a frame; the arrow keys go frame by frame. Diamonds are "
                "keyframes"));
  connect(&document, &Document::timeLineChanged, this, qOverload<>(&QWidget::update));
  connect(&document, &Document::viewStateChanged, this, qOverload<>(&QWidget::update));
}

int TimeRuler::frame() const {
  return static_cast<int>(std::lround(document_.frame()));
}

double TimeRuler::x_of(double frame) const {
  const TimeLine& line = document_.state().time_line;
  return margin + (frame - line.first) / (line.last - line.first) * (width() - 2 * margin);
}

void TimeRuler::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const TimeLine& line = document_.state().time_line;
  const QColor ink = palette().color(QPalette::WindowText);
  QColor faint = ink;
  faint.setAlphaF(0.35F);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  const double per_frame = (width() - 2 * margin) / (line.last - line.first);
  const int step = tick_step(46 / per_frame);
  const int first = static_cast<int>(std::ceil(static_cast<double>(line.first) / step)) * step;
  const int middle = height() - 14;
  for (int frame = first; frame <= line.last; frame += step) {
    const double x = x_of(frame);
    painter.setPen(faint);
    painter.drawLine(QPointF(x, 15), QPointF(x, height() - 4));
    painter.setPen(ink);
    painter.drawText(QRectF(x - 24, 0, 48, 15), Qt::AlignCenter, QString::number(frame));
  }
  painter.setPen(faint);
  painter.drawLine(QPointF(margin, middle), QPointF(width() - margin, middle));
  painter.setPen(Qt::NoPen);
  painter.setBrush(QColor("#e8a020"));
  for (const Keyframe& key : line.keys) {
    const QPointF at(x_of(key.frame), middle);
    painter.drawPolygon(QPolygonF(
        {at + QPointF(0, -6), at + QPointF(5, 0), at + QPointF(0, 6), at + QPointF(-5, 0)}));
  }
  painter.setPen(QPen(palette().color(QPalette::Highlight), 2));
  const double x = x_of(document_.frame());
  painter.drawLine(QPointF(x, 2), QPointF(x, height() - 2));
}

void TimeRuler::choose(double x) {
  const TimeLine& line = document_.state().time_line;
  const double frame =
      line.first + (x - margin) / (width() - 2 * margin) * (line.last - line.first);
  Q_EMIT frameChosen(std::clamp(static_cast<int>(std::lround(frame)), line.first, line.last));
}

void TimeRuler::mousePressEvent(QMouseEvent* event) {
  choose(event->position().x());
}

void TimeRuler::mouseMoveEvent(QMouseEvent* event) {
  if (event->buttons() != Qt::NoButton) {
    choose(event->position().x());
  }
}

void TimeRuler::keyPressEvent(QKeyEvent* event) {
  const TimeLine& line = document_.state().time_line;
  switch (event->key()) {
  case Qt::Key_Left:
    Q_EMIT frameChosen(std::max(frame() - 1, line.first));
    break;
  case Qt::Key_Right:
    Q_EMIT frameChosen(std::min(frame() + 1, line.last));
    break;
  case Qt::Key_Home:
    Q_EMIT frameChosen(line.first);
    break;
  case Qt::Key_End:
    Q_EMIT frameChosen(line.last);
    break;
  default:
    QWidget::keyPressEvent(event);
  }
}

TimeLinePanel::TimeLinePanel(Editor& editor, QWidget* parent)
    : QWidget(parent), editor_(editor), document_(editor.document()) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  ruler_ = new TimeRuler(document_);
  auto* row = new QHBoxLayout;
  const auto button = [row](const char* name, const QString& text, const QString& help) {
    auto* made = new QToolButton;
    made->setObjectName(name);
    made->setText(text);
    made->setToolButtonStyle(Qt::ToolButtonIconOnly); // panels beside it need the room
    made->setToolTip(QString("<b>%1</b><br>%2").arg(text, help));
    made->setAccessibleName(text);
    row->addWidget(made);
    return made;
  };
  play_ = button("play", tr("Play"), tr("Plays the keyframes, again and again (Space)"));
  set_ = button("set_keyframe", tr("Set Keyframe"),
                tr("The cage as it is becomes a keyframe at this frame (K)"));
  remove_ =
      button("remove_keyframe", tr("Remove Keyframe"), tr("Removes the keyframe at this frame"));
  set_->setIcon(icon("keyframe"));
  remove_->setIcon(icon("keyframe_remove"));
  row->addStretch();
  const auto number = [row](auto* box, const char* name, const QString& label,
                            const QString& help) {
    row->addWidget(new QLabel(label));
    box->setObjectName(name);
    box->setToolTip(help);
    box->setAccessibleName(label);
    box->setKeyboardTracking(false);
    row->addWidget(box);
    return box;
  };
  frame_ = number(new QSpinBox, "frame", tr("Frame"), tr("The frame that is shown"));
  first_ = number(new QSpinBox, "first_frame", tr("from"), tr("First frame"));
  last_ = number(new QSpinBox, "last_frame", tr("to"), tr("Last frame"));
  rate_ =
      number(new QDoubleSpinBox, "rate", tr("fps"), tr("Frames per second: the speed of playing"));
  first_->setRange(TimeLine::least_frame, TimeLine::most_frame - 1);
  last_->setRange(TimeLine::least_frame + 1, TimeLine::most_frame);
  rate_->setRange(1, 240);
  rate_->setDecimals(0);
  layout->addWidget(ruler_);
  layout->addLayout(row);
  layout->addStretch();

  connect(ruler_, &TimeRuler::frameChosen, this, &TimeLinePanel::go_to);
  connect(frame_, &QSpinBox::valueChanged, this, &TimeLinePanel::go_to);
  connect(play_, &QToolButton::clicked, this, &TimeLinePanel::toggle_playing);
  connect(set_, &QToolButton::clicked, this, &TimeLinePanel::set_keyframe);
  connect(remove_, &QToolButton::clicked, this,
          [this] { editor_.remove_keyframe(ruler_->frame()); });
  const auto change_line = [this] {
    TimeLine line = document_.state().time_line;
    line.first = first_->value();
    line.last = std::max(last_->value(), line.first + 1);
    line.frames_per_second = rate_->value();
    editor_.set_time_line(std::move(line), tr("Change Time Line"));
  };
  connect(first_, &QSpinBox::valueChanged, this, change_line);
  connect(last_, &QSpinBox::valueChanged, this, change_line);
  connect(rate_, &QDoubleSpinBox::valueChanged, this, change_line);
  timer_.setInterval(16);
  connect(&timer_, &QTimer::timeout, this, &TimeLinePanel::next_frame);
  connect(&document_, &Document::timeLineChanged, this, &TimeLinePanel::update_line);
  connect(&document_, &Document::viewStateChanged, this, &TimeLinePanel::update_line);
  connect(&document_, &Document::modeChanged, this, &TimeLinePanel::update_line);
  update_line();
}

void TimeLinePanel::update_line() {
  const TimeLine& line = document_.state().time_line;
  const bool deforming = document_.mode() == Mode::deform;
  if (timer_.isActive() && !document_.time()) { // something was edited, or undone
    timer_.stop();
  }
  play_->setText(timer_.isActive() ? tr("Pause") : tr("Play"));
  play_->setIcon(icon(timer_.isActive() ? "pause" : "play"));
  for (QWidget* widget :
       std::initializer_list<QWidget*>{ruler_, set_, frame_, first_, last_, rate_}) {
    widget->setEnabled(deforming);
  }
  play_->setEnabled(deforming && !line.keys.empty());
  const int at = ruler_->frame();
  remove_->setEnabled(deforming && std::ranges::any_of(line.keys, [&](const Keyframe& key) {
                        return key.frame == at;
                      }));
  const QSignalBlocker blockers[] = {QSignalBlocker(frame_), QSignalBlocker(first_),
                                     QSignalBlocker(last_), QSignalBlocker(rate_)};
  frame_->setRange(line.first, line.last);
  frame_->setValue(at);
  first_->setValue(line.first);
  last_->setValue(line.last);
  rate_->setValue(line.frames_per_second);
}

void TimeLinePanel::go_to(int frame) {
  timer_.stop();
  document_.set_time(frame);
  update_line();
}

void TimeLinePanel::set_keyframe() {
  if (document_.mode() == Mode::deform) {
    editor_.set_keyframe(ruler_->frame());
  }
}

void TimeLinePanel::toggle_playing() {
  const TimeLine& line = document_.state().time_line;
  if (timer_.isActive()) {
    timer_.stop();
  } else if (document_.mode() == Mode::deform && !line.keys.empty()) {
    start_ = document_.frame();
    if (start_ >= line.last) {
      start_ = line.first;
    }
    document_.set_time(start_);
    clock_.start();
    timer_.start();
  }
  update_line();
}

void TimeLinePanel::next_frame() {
  const TimeLine& line = document_.state().time_line;
  const double passed = static_cast<double>(clock_.elapsed()) / 1000 * line.frames_per_second;
  const double length = line.last - line.first;
  document_.set_time(line.first + std::fmod(start_ - line.first + passed, length));
}

} // namespace cagewright::app
