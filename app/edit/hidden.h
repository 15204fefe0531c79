/// \file
/// Parts of a cage that are put out of sight.
#pragma once

#include "app/edit/cage_graph.h"
#include "app/edit/selection.h"

#include <span>
#include <vector>

namespace cagewright::app {

/// Which elements of a cage are in sight when some faces are hidden: edges and vertices go with the
/// last face that uses them.
class InSight {
public:
  /// Everything, of any cage.
  InSight() = default;
  /// \param hidden_faces  ascending; numbers beyond the last face are ignored
  InSight(const CageGraph& graph, std::span<const Index> hidden_faces);

  [[nodiscard]] bool everything() const { return faces_.empty(); }
  [[nodiscard]] bool face(Index f) const { return everything() || faces_[f] != 0; }
  [[nodiscard]] bool edge(Index e) const { return everything() || edges_[e] != 0; }
  [[nodiscard]] bool vertex(Index v) const { return everything() || vertices_[v] != 0; }

private:
  std::vector<char> faces_, edges_, vertices_; // all empty, or one for each
};

/// What of a selection is in sight.
Selection in_sight(const Selection& selection, const CageGraph& graph, const InSight& sight);

/// The faces that are hidden when the selection is, besides those that are already: the selected
/// ones, and those round selected edges and vertices. Ascending.
std::vector<Index> hidden_with(const Selection& selection, const CageGraph& graph,
                               std::span<const Index> hidden_faces);

/// The faces that are hidden when only the selection is to be seen. Ascending.
std::vector<Index> hidden_but(const Selection& selection, const CageGraph& graph);

} // namespace cagewright::app
