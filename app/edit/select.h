/// \file
/// Making selections from selections.
#pragma once

#include "app/edit/cage_graph.h"
#include "app/edit/selection.h"

#include <span>
#include <vector>

namespace cagewright::app {

/// The vertices that move when the selection does, ascending.
std::vector<Index> vertices_of(const Selection& selection, const CageGraph& graph);
/// The edges with both ends among the vertices, ascending.
std::vector<EdgeVertices> edges_within(std::span<const Index> vertices, const CageGraph& graph);
/// The faces with all corners among the vertices, ascending.
std::vector<Index> faces_within(std::span<const Index> vertices, const CageGraph& graph);

/// The same part of the cage in another mode. To smaller elements: all that the selected ones
/// consist of. To larger ones: those of which all vertices are selected.
Selection converted(const Selection& selection, SelectionMode mode, const CageGraph& graph);

Selection select_all(SelectionMode mode, const CageGraph& graph);
Selection inverted(const Selection& selection, const CageGraph& graph);

/// With the neighbors: vertices joined by an edge, edges and faces that share a vertex.
Selection grown(const Selection& selection, const CageGraph& graph);
/// Without those that have a neighbor that is not selected.
Selection shrunk(const Selection& selection, const CageGraph& graph);

/// With all that hangs together with the selected.
Selection linked(const Selection& selection, const CageGraph& graph);

/// The edges that go on straight from one, both ways, as far as it is clear what is straight:
/// through vertices of 4 edges, or of 6. Edge numbers, in order along the loop.
std::vector<Index> edge_loop(Index edge, const CageGraph& graph);
/// The edges opposite to one another in a run of quads. Edge numbers, in order along the ring.
std::vector<Index> edge_ring(Index edge, const CageGraph& graph);
/// The quads, or faces, between the edges of a ring.
std::vector<Index> face_ring(Index edge, const CageGraph& graph);

/// For each selected edge its loop, or its ring; in other modes the loops or rings of the edges
/// between selected elements.
Selection loops(const Selection& selection, const CageGraph& graph);
Selection rings(const Selection& selection, const CageGraph& graph);

/// With the mirror images, or only these.
/// \param partner  for each vertex its mirror image, itself on the mirror plane, or a number that
///                 is no vertex: elements with such vertices have no image
Selection mirrored(const Selection& selection, std::span<const Index> partner,
                   const CageGraph& graph, bool keep);

enum class Combine { replace, add, subtract, toggle };

/// Two selections of the same mode made one; of different modes: `found`.
Selection combined(const Selection& selection, const Selection& found, Combine how);

/// What is left of a selection when the cage's vertices are renumbered: elements of vertices that
/// all live, if the new cage has such an element.
/// \param new_of_old  for each old vertex its new number, or one that is no vertex
Selection carried_over(const Selection& selection, const CageGraph& before,
                       std::span<const Index> new_of_old, const CageGraph& after);

} // namespace cagewright::app
