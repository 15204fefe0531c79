/// \file
/// What keys, menus and buttons do with the selection and the topology of the cage.
#pragma once

#include "app/commands/editor.h"
#include "app/edit/select.h"
#include "app/edit/transform.h"

#include <optional>

namespace cagewright::app {

/// One step of undo each; nothing happens without a cage. A failure is a sentence for
/// Editor::message().
enum class CageAction {
  select_all,
  select_none,
  invert,
  grow,
  shrink,
  select_linked,
  select_loop,
  select_ring,
  mirror_selection, ///< adds the mirror images
  vertex_mode,
  edge_mode,
  face_mode,
  hide,    ///< the selection
  isolate, ///< hides all but the selection; if something is hidden: shows everything
  reveal,  ///< shows everything
  split,   ///< selected edges; in face mode the same as subdivide
  split_ring,
  collapse,
  flip,
  subdivide,
  remove,
  extrude,
};

/// What it is called in menus, key maps and tests: "select_all".
const char* command_name(CageAction action);

/// \returns false if it did nothing
bool perform(CageAction action, Editor& editor);

/// Whether it changes the topology, and so works in refine mode only.
bool changes_topology(CageAction action);

/// The mirror images of the cage's vertices at rest, as the tools' symmetry axis says.
std::optional<Symmetry> cage_symmetry(const Document& document);

} // namespace cagewright::app
