#include "app/panels/guide_bar.h"

#include "app/icons.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include <algorithm>

namespace cagewright::app {
namespace {

bool choosing_region(const Document& document) {
  return document.mode() == Mode::refine && document.tools().tool == Tool::region;
}

} // namespace

GuideBar::GuideBar(Session& session, QWidget* parent) : QFrame(parent), session_(session) {
  setFrameShape(QFrame::StyledPanel);
  setObjectName("guide");
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(10, 3, 3, 3);
  text_ = new QLabel;
  text_->setWordWrap(true);
  text_->setObjectName("guide_text");
  layout->addWidget(text_, 1);
  button_ = new QPushButton;
  button_->setObjectName("guide_button");
  layout->addWidget(button_);
  auto* close = new QToolButton;
  close->setIcon(icon("close"));
  close->setAutoRaise(true);
  close->setToolTip(tr("Hides these hints. Help > First Steps brings them back"));
  layout->addWidget(close);
  connect(close, &QToolButton::clicked, this, &QWidget::hide);
  connect(button_, &QPushButton::clicked, this, [this] {
    const Document& document = session_.document();
    if (!document.has_model()) {
      Q_EMIT openRequested();
    } else if (!document.has_cage() || choosing_region(document)) {
      session_.generate();
    } else if (document.mode() == Mode::refine) {
      session_.bind();
    } else {
      Q_EMIT exportRequested();
    }
  });
  const Document& document = session.document();
  connect(&document, &Document::modelChanged, this, &GuideBar::update_step);
  connect(&document, &Document::cageChanged, this, &GuideBar::update_step);
  connect(&document, &Document::regionChanged, this, &GuideBar::update_step);
  connect(&document, &Document::modeChanged, this, &GuideBar::update_step);
  connect(&document, &Document::selectionChanged, this, &GuideBar::update_step);
  connect(&document, &Document::toolsChanged, this, &GuideBar::update_step);
  connect(&session.editor().undo_stack(), &QUndoStack::indexChanged, this, &GuideBar::update_step);
  connect(&session.jobs(), &JobRunner::started, this, &GuideBar::update_step);
  connect(&session.jobs(), &JobRunner::finished, this, &GuideBar::update_step);
  update_step();
}

void GuideBar::update_step() {
  const Document& document = session_.document();
  const auto say = [this](const QString& text, const QString& button) {
    text_->setText(text);
    button_->setText(button);
    button_->setVisible(!button.isEmpty());
  };
  button_->setEnabled(!session_.jobs().busy());
  if (!document.has_model()) {
    say(tr("<b>Step 1 of 5.</b> Open a model: OBJ, PLY, STL, OFF or glTF."), tr("Open..."));
  } else if (choosing_region(document)) {
    say(document.state().region
            ? tr("<b>Step 2 of 5.</b> The cage is for %1. Paint more of it, or erase with Shift; "
                 "then make a cage for it.")
                  .arg(document.state().region->name.toHtmlEscaped())
            : tr("<b>Step 2 of 5.</b> Paint the part of the model that the cage is for. The rest "
                 "stays where it is."),
        document.state().region ? tr("Generate Cage") : QString());
  } else if (!document.has_cage()) {
    say(tr("<b>Step 2 of 5.</b> Make a cage: a coarse shell round the model, by which you will "
           "move it."),
        tr("Generate Cage"));
  } else if (document.mode() == Mode::refine && document.tools().tool == Tool::paint) {
    say(tr("<b>Step 2 of 5.</b> Paint on the model where the cage is to be finer. Then make "
           "another one (Ctrl+G)."),
        {});
  } else if (document.mode() == Mode::refine && document.tools().tool == Tool::mix) {
    say(tr("<b>Step 3 of 5.</b> Paint where the model is to follow by the kind \"Where painted\". "
           "Then bind it."),
        tr("Bind"));
  } else if (document.mode() == Mode::refine) {
    say(tr("<b>Step 3 of 5.</b> Edit the cage if you like: it stays a cage while nothing turns "
           "red. Then bind the model to it."),
        tr("Bind"));
  } else if (document.cage_positions().empty() ||
             std::equal(document.cage_positions().begin(), document.cage_positions().end(),
                        document.cage_rest().positions.begin())) {
    say(document.tools().tool == Tool::mix ? tr("<b>Step 4 of 5.</b> Paint where the model is to "
                                                "follow by the kind \"Where painted\".")
        : document.tools().tool == Tool::pull ? tr("<b>Step 4 of 5.</b> Drag the model itself: its "
                                                   "cage comes along. A click leaves a "
                                                   "pin that holds it.")
        : document.selection().empty()
            ? tr("<b>Step 4 of 5.</b> Click a vertex of the cage. Shift adds more.")
            : tr("<b>Step 4 of 5.</b> Drag an arrow of the gizmo, or press G and move the mouse: "
                 "the model follows."),
        {});
  } else {
    say(tr("<b>Step 5 of 5.</b> Export the deformed model, or keep this pose and make others."),
        tr("Export Model..."));
  }
}

} // namespace cagewright::app
