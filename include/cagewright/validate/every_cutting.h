/// \file
/// Polygons of a model cut in all the ways in which other programs may cut them.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>

namespace cagewright {

/// The triangles of triangulate() and, behind them, those of all other ways to cut a face that is
/// not flat: renderers choose as they like, and a cage of the model must enclose the choice of any.
/// A concave quad counts as not flat, for some programs cut it along its wrong diagonal.
///
///  - Quads: the triangles along both diagonals.
///  - Up to 8 corners: every triangle of three of them.
///  - More: fans round every corner, up to 32 corners; beyond, that round the first.
///
/// The list is for asking what is enclosed. As a surface it is not that of the model: bent faces
/// are in it several times.
///
/// Cost: as triangulate(); memory for up to 56 triangles a face of 8 corners.
Triangulation every_cutting(const PolygonMesh& mesh);

} // namespace cagewright
