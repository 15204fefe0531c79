/// \file
/// What to do next, for those who see the program for the first time.
#pragma once

#include "app/session.h"

#include <QFrame>

class QLabel;
class QPushButton;

namespace cagewright::app {

/// One line above the view: the next step from an empty window to an exported model, and a button
/// that does it.
class GuideBar final : public QFrame {
  Q_OBJECT

public:
  explicit GuideBar(Session& session, QWidget* parent = nullptr);

Q_SIGNALS:
  void openRequested();
  void exportRequested();

private:
  void update_step();

  Session& session_;
  QLabel* text_ = nullptr;
  QPushButton* button_ = nullptr;
};

} // namespace cagewright::app
