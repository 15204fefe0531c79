/// \file
/// Waiting for states, never for times: what is waited for may take as long as a busy machine
/// needs.
#pragma once

#include <QtCore/qtestsupport_core.h>

#include <functional>

namespace cagewright::app::test {

/// Handles events until the condition holds. \returns false if it never does; the limit is for
/// tests that hang, and far from what any of them needs
inline bool wait_until(const std::function<bool()>& condition, int seconds = 600) {
  return QTest::qWaitFor(condition, seconds * 1000);
}

} // namespace cagewright::app::test
