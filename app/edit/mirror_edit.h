/// \file
/// Changes of topology that are the same on both sides of a mirror plane.
#pragma once

#include "app/edit/edit_cage.h"
#include "app/edit/transform.h"

namespace cagewright::app {

/// Whether every vertex of the cage has an image, and every face a face of the images of its
/// corners.
bool is_mirrored(const PolygonMesh& cage, const Symmetry& symmetry);

/// A change of a mirrored cage, made exactly its own mirror image: what it did on one side is done
/// on the other, too. Where the tools decide by chance, as when they cut a face, the two sides
/// differ otherwise. Vertices that are new lie exactly in the images of each other, or on the
/// plane.
///
/// \param before     mirrored: is_mirrored()
/// \param edited     of `before`, on both sides
/// \param side       above 0: the side that the plane's normal points to leads; below 0: the other
/// \param tolerance  how far from an image its vertex may lie, in the positions' unit
/// Errors: invalid_cage, where the change cannot be the same on both sides: a face across the plane
/// that was cut otherwise than its image, for example.
Result<EditedCage> mirrored_edit(const PolygonMesh& before, const Symmetry& symmetry,
                                 EditedCage edited, double side, double tolerance);

} // namespace cagewright::app
