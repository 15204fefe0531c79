/// \file
/// Light and dark.
#pragma once

#include <QString>

class QApplication;

namespace cagewright::app {

enum class Theme { light, dark };

/// "light" or "dark"; anything else is light.
Theme theme_named(const QString& name);
QString name_of(Theme theme);

/// The same style on every desktop, in these colors.
void apply_theme(QApplication& application, Theme theme);

} // namespace cagewright::app
