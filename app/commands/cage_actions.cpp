#include "app/commands/cage_actions.h"

#include "app/edit/edit_cage.h"
#include "app/edit/hidden.h"
#include "app/edit/mirror_edit.h"

#include <array>
#include <utility>

namespace cagewright::app {
namespace {

// Mirror images may be off by this fraction of the diagonal.
constexpr double symmetry_tolerance = 1e-3;

QString name_of(CageAction action) {
  switch (action) {
  case CageAction::split:
    return Editor::tr("Split Edge");
  case CageAction::split_ring:
    return Editor::tr("Split Ring");
  case CageAction::collapse:
    return Editor::tr("Collapse");
  case CageAction::flip:
    return Editor::tr("Flip Edge");
  case CageAction::subdivide:
    return Editor::tr("Subdivide");
  case CageAction::remove:
    return Editor::tr("Delete");
  case CageAction::extrude:
    return Editor::tr("Extrude");
  default:
    return Editor::tr("Select");
  }
}

Selection with_mirror_images(const Document& document, const CageGraph& graph) {
  const std::optional<Symmetry> symmetry = cage_symmetry(document);
  return symmetry ? mirrored(document.selection(), symmetry->partner, graph, true)
                  : document.selection();
}

Selection selected_anew(CageAction action, const Document& document, const CageGraph& graph) {
  const Selection& now = document.selection();
  switch (action) {
  case CageAction::select_all:
    return select_all(now.mode, graph);
  case CageAction::select_none: {
    Selection none;
    none.mode = now.mode;
    return none;
  }
  case CageAction::invert:
    return inverted(now, graph);
  case CageAction::grow:
    return grown(now, graph);
  case CageAction::shrink:
    return shrunk(now, graph);
  case CageAction::select_linked:
    return linked(now, graph);
  case CageAction::select_loop:
    return combined(now, loops(now, graph), Combine::add);
  case CageAction::select_ring:
    return combined(now, rings(now, graph), Combine::add);
  case CageAction::mirror_selection:
    return with_mirror_images(document, graph);
  case CageAction::vertex_mode:
    return converted(now, SelectionMode::vertex, graph);
  case CageAction::edge_mode:
    return converted(now, SelectionMode::edge, graph);
  case CageAction::face_mode:
    return converted(now, SelectionMode::face, graph);
  default:
    return now;
  }
}

bool put_out_of_sight(CageAction action, Editor& editor, const CageGraph& graph) {
  const State& state = editor.document().state();
  const bool anything_hidden = !state.hidden_faces.empty();
  if (action == CageAction::reveal || (action == CageAction::isolate && anything_hidden)) {
    if (!anything_hidden) {
      Q_EMIT editor.message(Editor::tr("nothing is hidden"));
      return false;
    }
    editor.hide_faces({}, Editor::tr("Show All"));
    return true;
  }
  if (state.selection.empty()) {
    Q_EMIT editor.message(Editor::tr("select something first"));
    return false;
  }
  std::vector<Index> hidden = action == CageAction::hide
                                  ? hidden_with(state.selection, graph, state.hidden_faces)
                                  : hidden_but(state.selection, graph);
  if (hidden == state.hidden_faces) {
    Q_EMIT editor.message(Editor::tr("there is nothing else"));
    return false;
  }
  editor.hide_faces(std::move(hidden),
                    action == CageAction::hide ? Editor::tr("Hide") : Editor::tr("Isolate"));
  return true;
}

Result<EditedCage> edited(CageAction action, const PolygonMesh& cage, const Selection& selection,
                          const CageGraph& graph) {
  const Selection edges = converted(selection, SelectionMode::edge, graph);
  const Selection faces = converted(selection, SelectionMode::face, graph);
  switch (action) {
  case CageAction::split:
    return selection.mode == SelectionMode::face ? subdivide_faces(cage, faces.faces)
                                                 : split_edges(cage, edges.edges);
  case CageAction::split_ring:
    return split_rings(cage, edges.edges);
  case CageAction::collapse:
    return collapse_edges(cage, edges.edges);
  case CageAction::flip:
    return flip_edges(cage, edges.edges);
  case CageAction::subdivide:
    return subdivide_faces(cage, faces.faces);
  case CageAction::remove:
    return delete_elements(cage, selection);
  case CageAction::extrude:
    return extrude_faces(cage, faces.faces, extrusion_offset(cage, faces.faces));
  default:
    return Error{ErrorCode::invalid_option, "nothing to do"};
  }
}

/// The same on both sides of the mirror plane, as far as the cage is symmetric.
Result<EditedCage> edited_alike(CageAction action, Editor& editor, const PolygonMesh& cage,
                                const CageGraph& graph) {
  const Document& document = editor.document();
  const Selection& selection = document.selection();
  const std::optional<Symmetry> symmetry = cage_symmetry(document);
  if (!symmetry) {
    Q_EMIT editor.message(Editor::tr("the cage is not symmetric about that plane"));
    return edited(action, cage, selection, graph);
  }
  const Selection both = mirrored(selection, symmetry->partner, graph, true);
  Result<EditedCage> result = edited(action, cage, both, graph);
  if (!result) {
    return result;
  }
  if (!is_mirrored(cage, *symmetry)) {
    Q_EMIT editor.message(
        Editor::tr("only parts of the cage are symmetric: both sides may differ"));
    return result;
  }
  double side = 0; // on which more is selected
  for (const Index v : vertices_of(selection, graph)) {
    side += (cage.positions[v] - symmetry->point).dot(symmetry->normal);
  }
  return mirrored_edit(cage, *symmetry, *std::move(result), side,
                       symmetry_tolerance * document.diagonal());
}

} // namespace

const char* command_name(CageAction action) {
  // In the order of the actions.
  static constexpr std::array<const char*, 22> names = {
      "select_all",  "select_none", "invert",
      "grow",        "shrink",      "select_linked",
      "select_loop", "select_ring", "mirror_selection",
      "vertex_mode", "edge_mode",   "face_mode",
      "hide",        "isolate",     "reveal",
      "split",       "split_ring",  "collapse",
      "flip",        "subdivide",   "remove",
      "extrude"};
  static_assert(names.size() == static_cast<std::size_t>(CageAction::extrude) + 1);
  return names[static_cast<std::size_t>(action)];
}

bool changes_topology(CageAction action) {
  return action >= CageAction::split;
}

std::optional<Symmetry> cage_symmetry(const Document& document) {
  if (!document.has_cage()) {
    return std::nullopt;
  }
  const std::span<const Vec3> positions = document.mode() == Mode::refine
                                              ? document.cage_positions()
                                              : std::span(document.cage_rest().positions);
  return find_symmetry(positions, document.tools().symmetry_axis,
                       symmetry_tolerance * document.diagonal());
}

bool perform(CageAction action, Editor& editor) {
  Document& document = editor.document();
  if (!document.has_cage() || editor.moving()) {
    return false;
  }
  const PolygonMesh cage = document.cage();
  const CageGraph graph(cage);
  if (!changes_topology(action)) {
    if (action == CageAction::mirror_selection && !cage_symmetry(document)) {
      Q_EMIT editor.message(Editor::tr("the cage is not symmetric about that plane"));
      return false;
    }
    if (action == CageAction::hide || action == CageAction::isolate ||
        action == CageAction::reveal) {
      return put_out_of_sight(action, editor, graph);
    }
    const Selection before = document.selection();
    editor.select(selected_anew(action, document, graph));
    return !(document.selection() == before);
  }
  if (document.mode() != Mode::refine) {
    Q_EMIT editor.message(
        Editor::tr("the model is bound to this cage; go back to refining to change its faces"));
    return false;
  }
  Result<EditedCage> result = document.tools().symmetric
                                  ? edited_alike(action, editor, cage, graph)
                                  : edited(action, cage, document.selection(), graph);
  if (!result) {
    Q_EMIT editor.message(QString::fromStdString(result.error().message));
    return false;
  }
  editor.edit_topology(std::move(result->mesh), std::move(result->selection), name_of(action));
  return true;
}

} // namespace cagewright::app
