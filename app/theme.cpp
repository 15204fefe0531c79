#include "app/theme.h"

#include <QApplication>
#include <QPalette>
#include <QStyleFactory>

namespace cagewright::app {
namespace {

QPalette light_palette() {
  QPalette p;
  p.setColor(QPalette::Window, QColor("#f0f0ef"));
  p.setColor(QPalette::WindowText, QColor("#1c1c1e"));
  p.setColor(QPalette::Base, QColor("#ffffff"));
  p.setColor(QPalette::AlternateBase, QColor("#f5f5f4"));
  p.setColor(QPalette::Text, QColor("#1c1c1e"));
  p.setColor(QPalette::Button, QColor("#e8e8e6"));
  p.setColor(QPalette::ButtonText, QColor("#1c1c1e"));
  p.setColor(QPalette::ToolTipBase, QColor("#fffbe6"));
  p.setColor(QPalette::ToolTipText, QColor("#1c1c1e"));
  p.setColor(QPalette::PlaceholderText, QColor("#5f6368"));
  p.setColor(QPalette::Highlight, QColor("#2f6fd0"));
  p.setColor(QPalette::HighlightedText, QColor("#ffffff"));
  p.setColor(QPalette::Link, QColor("#1f5bb5"));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    p.setColor(QPalette::Disabled, role, QColor("#9a9a9c"));
  }
  return p;
}

QPalette dark_palette() {
  QPalette p;
  p.setColor(QPalette::Window, QColor("#2b2d30"));
  p.setColor(QPalette::WindowText, QColor("#e3e4e6"));
  p.setColor(QPalette::Base, QColor("#1f2123"));
  p.setColor(QPalette::AlternateBase, QColor("#26282b"));
  p.setColor(QPalette::Text, QColor("#e3e4e6"));
  p.setColor(QPalette::Button, QColor("#393b40"));
  p.setColor(QPalette::ButtonText, QColor("#e3e4e6"));
  p.setColor(QPalette::BrightText, QColor("#ff6b6b"));
  p.setColor(QPalette::ToolTipBase, QColor("#393b40"));
  p.setColor(QPalette::ToolTipText, QColor("#e3e4e6"));
  p.setColor(QPalette::PlaceholderText, QColor("#9da0a6"));
  p.setColor(QPalette::Highlight, QColor("#3574d6"));
  p.setColor(QPalette::HighlightedText, QColor("#ffffff"));
  p.setColor(QPalette::Link, QColor("#6ea8ff"));
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    p.setColor(QPalette::Disabled, role, QColor("#74777d"));
  }
  return p;
}

} // namespace

Theme theme_named(const QString& name) {
  return name == "dark" ? Theme::dark : Theme::light;
}

QString name_of(Theme theme) {
  return theme == Theme::dark ? "dark" : "light";
}

void apply_theme(QApplication& application, Theme theme) {
  QApplication::setStyle(QStyleFactory::create("Fusion"));
  QApplication::setPalette(theme == Theme::dark ? dark_palette() : light_palette());
  application.setStyleSheet(
      "QToolTip { padding: 3px; } "
      "QDockWidget { font-weight: bold; } QDockWidget > QWidget { font-weight: normal; } "
      // What is on is seen at a glance, in light and dark.
      "QToolBar QToolButton { padding: 3px 4px; border-radius: 3px; border: none; } "
      "QToolBar QToolButton:hover { background: rgba(128, 128, 128, 70); } "
      "QToolButton#advanced:checked { background: none; color: palette(button-text); } "
      "QToolButton:checked { background: palette(highlight); color: palette(highlighted-text); "
      "border-radius: 3px; }");
  // Boxes to be checked are seen on dark panels, too.
  QPalette boxes = QApplication::palette();
  if (theme == Theme::dark) {
    boxes.setColor(QPalette::Base, QColor("#4a4d53"));
  }
  for (const char* name : {"QCheckBox", "QRadioButton"}) {
    QApplication::setPalette(boxes, name);
  }
}

} // namespace cagewright::app
