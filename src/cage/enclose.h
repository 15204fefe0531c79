/// \file
/// A cage moved until a model is inside it, its faces left as they are. Internal to this module.
#pragma once

#include "quads/quad_guard.h"
#include <cagewright/core/progress.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <cstddef>
#include <optional>

namespace cagewright {

struct EncloseReport {
  bool encloses = false;        ///< with the clearance all round
  std::size_t outside = 0;      ///< places of the model that stayed outside or too near, if not
  std::optional<Vec3> farthest; ///< the worst of them
};

/// Moves the vertices of a cage until the model is inside it, the cage itself as little bent as
/// that takes: it is a net of springs at rest, pushed outward by the places of the model that are
/// outside it or too near. In each step these are half spaces, linear in the corners of the faces
/// that they are nearest to, of a quadratic program; points between the model's vertices join them
/// where a face still touches the model. What of a step would make faces cross is taken back, so
/// that a cage without self-intersections stays so; faces that cross already may part.
///
/// \param cage     closed and oriented outward
/// \param model    what the guard's surface was made of
/// \param guard    its clearance, in the model's units, is what is aimed at
/// Cost: up to 150 steps, each some sparse factorisations over the cage's vertices and a nearest
/// point for each vertex of the model that is not deep inside.
EncloseReport enclose(QuadCage& cage, const QuadGuard& guard, TriangleView model,
                      const Progress& progress = {});

} // namespace cagewright
