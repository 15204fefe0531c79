/// \file
/// Small meshes to start from, in examples and in tests. All are closed, oriented outward, and
/// exactly reproducible.
#pragma once

#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

namespace cagewright {

/// The axis-aligned cube [-1, 1]^3: 8 vertices, 12 outward triangles. Vertex i has x > 0 when
/// i & 1, y > 0 when i & 2 and z > 0 when i & 4.
TriangleMesh make_cube();

/// The same cube of six quads.
PolygonMesh make_quad_cube();

/// The tetrahedron over the alternate corners of the cube [-1, 1]^3.
TriangleMesh make_tetrahedron();

/// A sphere of radius 1: an icosahedron whose triangles are split in four `subdivisions` times,
/// 20 * 4^subdivisions triangles.
TriangleMesh make_icosphere(int subdivisions);

/// A torus about the z axis: centre line of radius 1, tube of radius `tube`; `around` by `across`
/// quads, cut into triangles. around, across >= 3.
TriangleMesh make_torus(double tube, Index around, Index across);

/// The meshes side by side in one, vertices of `b` after those of `a`.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

} // namespace cagewright
