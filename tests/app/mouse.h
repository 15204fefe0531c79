/// \file
/// Moves of the mouse that are delivered at once. QTest::mouseMove() sends the display's own cursor
/// on its way instead: its events come back some time later, in the middle of another action. That
/// cursor is to be away from all windows: park_cursor().
#pragma once

#include <QCoreApplication>
#include <QCursor>
#include <QGuiApplication>
#include <QMouseEvent>
#include <QScreen>
#include <QTest>
#include <QWidget>

namespace cagewright::app::test {

/// Puts the display's own cursor where no window comes: one that opens under it would be entered,
/// and would take the keyboard, whenever the display says so.
inline void park_cursor() {
  QCursor::setPos(QGuiApplication::primaryScreen()->geometry().bottomRight());
  QGuiApplication::sync();
}

inline void move_mouse(QWidget& widget, QPoint to, Qt::MouseButton held = Qt::NoButton,
                       Qt::KeyboardModifiers modifiers = {}) {
  QMouseEvent move(QEvent::MouseMove, to, widget.mapToGlobal(to), Qt::NoButton, held, modifiers);
  QCoreApplication::sendEvent(&widget, &move);
}

/// From one place to another with a button held.
inline void drag_mouse(QWidget& widget, QPoint from, QPoint to,
                       Qt::KeyboardModifiers modifiers = {},
                       Qt::MouseButton button = Qt::LeftButton) {
  move_mouse(widget, from);
  QTest::mousePress(&widget, button, modifiers, from);
  for (int i = 1; i <= 6; ++i) {
    move_mouse(widget, from + (to - from) * i / 6, button, modifiers);
  }
  QTest::mouseRelease(&widget, button, modifiers, to);
}

} // namespace cagewright::app::test
