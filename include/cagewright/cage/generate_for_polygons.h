/// \file
/// A cage round a model of polygons, whichever way these are cut into triangles.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

namespace cagewright {

/// generate() for a model of polygons. Bent ones are enclosed along every way to cut them that
/// every_cutting() knows: renderers choose as they like. Models of triangles and of flat polygons
/// get the same cage as from generate().
///
/// \param model  V vertices, F faces; figures of the result are those of its to_triangle_mesh()
/// Errors: those of generate().
/// Cost: that of generate(), and of judging the cage; twice that where the cage of one cutting does
/// not hold for the others, which is rare.
Result<GeneratedCage> generate_for_polygons(const PolygonMesh& model,
                                            const GenerateOptions& options = {},
                                            const Progress& progress = {});

} // namespace cagewright
