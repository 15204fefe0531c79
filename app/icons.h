/// \file
/// The program's own pictures for tools and commands.
#pragma once

#include <QIcon>
#include <QString>

namespace cagewright::app {

/// The picture app/icons/NAME.svg, sharp at any size, in the colors of the palette as it is when it
/// is drawn: that of text, fainter when disabled, that of highlighted text when it is on.
QIcon icon(const QString& name);

} // namespace cagewright::app
