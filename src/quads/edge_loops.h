/// \file
/// Whole strips of quads put in and taken out: the edge loops of a rigger.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>

#include <array>
#include <optional>
#include <vector>

namespace cagewright {

/// Quads, each the neighbour of the next across opposite sides: the rungs. Rung i is the side
/// before quad i; of a closed strip the last quad is followed by the first rung, an open one ends
/// with one rung more, at a border.
struct QuadStrip {
  std::vector<std::array<Index, 2>> rungs; ///< all from the same side of the strip to the other
  std::vector<Index> faces;
  bool closed = false;
};

/// The strips that are closed or run from border to border, and cross no quad twice.
std::vector<QuadStrip> strips_of(const PolygonMesh& mesh);

/// A loop of edges more, through the middle of all quads of the strip.
PolygonMesh split_strip(const PolygonMesh& mesh, const QuadStrip& strip);

/// The mesh without the quads of the strip, each rung drawn together in one vertex: rung i in
/// places[i], which is vertex drawn[i] of the result. None if that is no manifold surface.
std::optional<PolygonMesh> collapse_strip(const PolygonMesh& mesh, const QuadStrip& strip,
                                          const std::vector<Vec3>& places,
                                          std::vector<Index>& drawn);

/// Closed strips of quads, those that cross a quad twice among them.
std::size_t closed_strips(const PolygonMesh& mesh);

/// Closed loops of edges that go straight on at every vertex: four quads meet there.
std::size_t closed_loops(const PolygonMesh& mesh);

} // namespace cagewright
