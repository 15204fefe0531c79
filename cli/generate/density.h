/// \file
/// Where the user wants the cage finer.
#pragma once

#include "core/result.h"
#include "mesh/polygon_mesh.h"

#include <string>
#include <vector>

namespace cagewright::cli {

/// The densities of --density, as ImproveOptions takes them: a weight above 0 for each vertex of
/// the model.
///
/// From a file: its numbers; 0 stands for a hundredth of the largest. From "colors", the vertex
/// colors of the model: 16^(red - blue), where red paint is max(0, R - max(G, B)) and blue paint
/// max(0, B - max(R, G)), from 0 to 1 each. White, grey and black are even; on red the edges of the
/// cage get a quarter as long, on blue four times as long.
///
/// Errors: those of read_vertex_weights(); unfit_model (no colors, or none of red or blue; no
/// number above 0).
Result<std::vector<double>> density_of(const std::string& source, const PolygonMesh& model);

} // namespace cagewright::cli
