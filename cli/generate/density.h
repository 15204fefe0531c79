/// \file
/// Where the user wants the cage finer.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <string>
#include <vector>

namespace cagewright::cli {

/// The densities of --density, as GenerateOptions takes them: the numbers of a file, or, of
/// "colors", what the vertex colors of the model paint. See density.h.
///
/// Errors: those of read_vertex_weights(), density_of_weights() and painted_density().
Result<std::vector<double>> density_of(const std::string& source, const PolygonMesh& model);

} // namespace cagewright::cli
