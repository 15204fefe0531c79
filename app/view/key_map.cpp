#include "app/view/key_map.h"

#include <QCoreApplication>

#include <array>

namespace cagewright::app {
namespace {

struct Tr {
  Q_DECLARE_TR_FUNCTIONS(KeyMap)
};

struct OtherKeys {
  const char* command;
  std::array<const char*, 2> keys; ///< the second may be null
};

// Where Maya's hands expect something else. What a key is taken from has another here.
constexpr std::array<OtherKeys, 13> maya_keys = {{{"tool_box", {"Q", nullptr}},
                                                  {"tool_move", {"W", nullptr}},
                                                  {"tool_rotate", {"E", nullptr}},
                                                  {"tool_scale", {"R", nullptr}},
                                                  {"extrude", {"Ctrl+E", nullptr}},
                                                  {"export_model", {"Ctrl+Shift+E", nullptr}},
                                                  {"frame_all", {"A", "Home"}},
                                                  {"select_all", {"Ctrl+A", nullptr}},
                                                  {"keyframe", {"S", "K"}},
                                                  {"vertex_mode", {"F9", "1"}},
                                                  {"edge_mode", {"F10", "2"}},
                                                  {"face_mode", {"F11", "3"}},
                                                  {"isolate", {"Shift+I", "/"}}}};

constexpr std::array<const char*, 3> names = {"blender", "maya", "three_button"};

} // namespace

KeyMap key_map_named(const QString& name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (name == names[i]) {
      return static_cast<KeyMap>(i);
    }
  }
  return KeyMap::blender;
}

QString name_of(KeyMap map) {
  return names[static_cast<std::size_t>(map)];
}

std::optional<CameraMove> camera_move(KeyMap map, Qt::MouseButton button,
                                      Qt::KeyboardModifiers modifiers) {
  const bool alt = modifiers.testFlag(Qt::AltModifier);
  const bool shift = modifiers.testFlag(Qt::ShiftModifier);
  const bool control = modifiers.testFlag(Qt::ControlModifier);
  const CameraMove by_modifier = shift     ? CameraMove::pan
                                 : control ? CameraMove::zoom
                                           : CameraMove::orbit;
  switch (map) {
  case KeyMap::blender:
    if (button == Qt::MiddleButton || (button == Qt::LeftButton && alt)) {
      return by_modifier;
    }
    break;
  case KeyMap::maya:
    if (button == Qt::LeftButton && alt) {
      return by_modifier;
    }
    if (button == Qt::MiddleButton) {
      return CameraMove::pan;
    }
    if (button == Qt::RightButton && alt) {
      return CameraMove::zoom;
    }
    break;
  case KeyMap::three_button:
    if (button == Qt::LeftButton && alt) {
      return by_modifier;
    }
    if (button == Qt::MiddleButton) {
      return CameraMove::pan;
    }
    if (button == Qt::RightButton) {
      return CameraMove::zoom;
    }
    break;
  }
  return std::nullopt;
}

bool turns_beside_the_cage(KeyMap map) {
  return map == KeyMap::three_button;
}

QList<QKeySequence> keys_of(KeyMap map, const QString& command, const QList<QKeySequence>& usual) {
  if (map == KeyMap::maya) {
    for (const OtherKeys& other : maya_keys) {
      if (command == other.command) {
        QList<QKeySequence> keys;
        for (const char* key : other.keys) {
          if (key != nullptr) {
            keys.append(QKeySequence(key));
          }
        }
        return keys;
      }
    }
  }
  return usual;
}

std::vector<std::pair<QString, QString>> mouse_help(KeyMap map) {
  std::vector<std::pair<QString, QString>> help;
  const auto add = [&](const QString& button, const QString& effect) {
    help.emplace_back(button, effect);
  };
  switch (map) {
  case KeyMap::blender:
    add(Tr::tr("Middle button, Alt+left"), Tr::tr("orbit; with Shift pan, with Ctrl zoom"));
    break;
  case KeyMap::maya:
    add(Tr::tr("Alt+left"), Tr::tr("orbit"));
    add(Tr::tr("Middle button, Alt+middle"), Tr::tr("pan"));
    add(Tr::tr("Alt+right"), Tr::tr("zoom"));
    break;
  case KeyMap::three_button:
    add(Tr::tr("Left beside the cage, Alt+left"), Tr::tr("orbit"));
    add(Tr::tr("Middle button"), Tr::tr("pan"));
    add(Tr::tr("Drag with the right button"), Tr::tr("zoom"));
    break;
  }
  add(Tr::tr("Wheel"), Tr::tr("zoom to the pointer"));
  add(Tr::tr("Left button"), Tr::tr("select; Shift adds; drag a vertex, an edge, or a handle"));
  if (turns_beside_the_cage(map)) {
    add(Tr::tr("B, then drag"), Tr::tr("select by a box; Ctrl+drag: lasso"));
  } else {
    add(Tr::tr("Drag beside"), Tr::tr("select by a box; Ctrl: lasso"));
  }
  add(Tr::tr("... with Shift, Ctrl+Shift"), Tr::tr("add to the selection, take from it"));
  add(Tr::tr("Double click"), Tr::tr("select a loop of edges, or a ring of faces"));
  add(Tr::tr("Right click"), Tr::tr("what can be done here; while dragging: take it back"));
  return help;
}

} // namespace cagewright::app
