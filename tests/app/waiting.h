/// \file
/// Waiting for what happens beside the GUI thread.
#pragma once

#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEventLoop>

#include <functional>

namespace cagewright::app::test {

/// Handles events until the condition holds. \returns false if it never does
inline bool wait_until(const std::function<bool()>& condition, int seconds = 120) {
  QElapsedTimer clock;
  clock.start();
  while (!condition()) {
    if (clock.elapsed() > seconds * 1000LL) {
      return false;
    }
    QCoreApplication::processEvents(QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents, 50);
    QCoreApplication::sendPostedEvents(nullptr, QEvent::DeferredDelete);
  }
  return true;
}

} // namespace cagewright::app::test
