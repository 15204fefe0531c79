/// \file
/// Which mouse buttons and keys do what, as in the program that one comes from.
#pragma once

#include <QKeySequence>
#include <QList>
#include <QString>
#include <Qt>

#include <optional>
#include <utility>
#include <vector>

namespace cagewright::app {

enum class KeyMap {
  blender,      ///< middle button; G, R, S at once
  maya,         ///< Alt and a button; W, E, R for the tools
  three_button, ///< left beside the cage turns, middle pans, right zooms; keys as in blender
};

/// As in the preferences: "blender". Other names: blender.
KeyMap key_map_named(const QString& name);
QString name_of(KeyMap map);

enum class CameraMove { orbit, pan, zoom };

/// What a drag with that button does to the camera; nothing: it is not the camera's.
std::optional<CameraMove> camera_move(KeyMap map, Qt::MouseButton button,
                                      Qt::KeyboardModifiers modifiers);

/// Whether a drag that begins beside the cage turns the view, instead of drawing a box.
bool turns_beside_the_cage(KeyMap map);

/// The keys of a command of the menus or the tool bar (by its object name).
/// \param usual  those it has in the map blender
QList<QKeySequence> keys_of(KeyMap map, const QString& command, const QList<QKeySequence>& usual);

/// What the mouse does, as lines of (button, effect), for people.
std::vector<std::pair<QString, QString>> mouse_help(KeyMap map);

} // namespace cagewright::app
