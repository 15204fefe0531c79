#include "app/panels/welcome_page.h"

#include "app/icons.h"

#include <QDir>
#include <QFileInfo>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

namespace cagewright::app {
namespace {

// As wide as lines are pleasant to read, and so many files as one overlooks.
constexpr int page_width = 620;
constexpr qsizetype most_recent_shown = 6;

QLabel* heading(const QString& text, double size, bool bold) {
  auto* label = new QLabel(text);
  QFont font = label->font();
  font.setPointSizeF(font.pointSizeF() * size);
  font.setBold(bold);
  label->setFont(font);
  label->setAlignment(Qt::AlignCenter);
  label->setWordWrap(true);
  return label;
}

} // namespace

WelcomePage::WelcomePage(QWidget* parent) : QScrollArea(parent) {
  setObjectName("welcome");
  setFrameShape(QFrame::NoFrame);
  setWidgetResizable(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // The view's own background is seen behind it.
  setStyleSheet("QScrollArea, QScrollArea > QWidget > QWidget#welcome_page { background: "
                "transparent; }");
  auto* page = new QWidget;
  page->setObjectName("welcome_page");
  page->setAutoFillBackground(false);
  viewport()->setAutoFillBackground(false);
  auto* outer = new QHBoxLayout(page);
  outer->addStretch(1);
  auto* column = new QWidget;
  column->setMaximumWidth(page_width);
  outer->addWidget(column, 100);
  outer->addStretch(1);
  auto* layout = new QVBoxLayout(column);
  layout->setSpacing(10);
  layout->addStretch(2);
  layout->addWidget(heading(tr("Drop a model here"), 1.9, true));

  auto* open = new QPushButton(icon("open"), tr("Open a Model..."));
  open->setObjectName("welcome_open");
  open->setToolTip(tr("OBJ, PLY, STL, OFF or glTF, or a project (Ctrl+O)"));
  open->setDefault(true);
  auto* open_row = new QHBoxLayout;
  open_row->addStretch();
  open_row->addWidget(open);
  open_row->addStretch();
  layout->addLayout(open_row);
  connect(open, &QPushButton::clicked, this, &WelcomePage::openRequested);

  layout->addSpacing(14);
  layout->addWidget(heading(tr("Or try it with a creature of ours"), 1.1, false));
  auto* samples = new QHBoxLayout;
  const auto add_sample = [&](const char* name, const char* picture, const QString& text,
                              const QString& help, Sample sample) {
    auto* button = new QToolButton;
    button->setObjectName(name);
    button->setIcon(icon(picture));
    button->setIconSize(QSize(28, 28));
    button->setText(text);
    button->setToolTip(help);
    button->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    samples->addWidget(button);
    connect(button, &QToolButton::clicked, this,
            [this, sample] { Q_EMIT sampleRequested(sample); });
  };
  add_sample("sample_model", "generate", tr("Make Its Cage"),
             tr("Opens the creature; Generate Cage comes next"), Sample::model);
  add_sample("sample_caged", "bind", tr("Edit and Bind"), tr("Opens it in a cage, to be refined"),
             Sample::caged);
  add_sample("sample_bound", "tool_pull", tr("Bend It"),
             tr("Opens it bound to its cage: drag a vertex of the cage"), Sample::bound);
  layout->addLayout(samples);

  layout->addSpacing(14);
  recent_ = new QVBoxLayout;
  recent_->setSpacing(1);
  layout->addLayout(recent_);
  auto* help = new QToolButton;
  help->setObjectName("welcome_help");
  help->setText(tr("First Steps..."));
  help->setAutoRaise(true);
  help->setFocusPolicy(Qt::TabFocus);
  layout->addWidget(help, 0, Qt::AlignCenter);
  connect(help, &QToolButton::clicked, this, &WelcomePage::helpRequested);
  layout->addStretch(3);
  setWidget(page);
}

void WelcomePage::set_recent(const QStringList& paths) {
  while (QLayoutItem* item = recent_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  if (paths.isEmpty()) {
    return;
  }
  recent_->addWidget(heading(tr("Opened last"), 1.1, false));
  for (const QString& path : paths.mid(0, most_recent_shown)) {
    const QFileInfo file(path);
    auto* button = new QToolButton;
    button->setObjectName("recent");
    const QString folder = button->fontMetrics().elidedText(QDir::toNativeSeparators(file.path()),
                                                            Qt::ElideMiddle, page_width / 2);
    button->setText(file.fileName() + "   \u2013   " + folder);
    button->setToolTip(path);
    button->setAutoRaise(true);
    button->setFocusPolicy(Qt::TabFocus);
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    connect(button, &QToolButton::clicked, this, [this, path] { Q_EMIT fileRequested(path); });
    recent_->addWidget(button);
  }
}

} // namespace cagewright::app
