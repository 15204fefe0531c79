/// \file
/// Models from the command line's paths.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <string>

namespace cagewright::cli {

/// Reads a mesh and cuts its faces into triangles.
Result<TriangleMesh> load_triangles(const std::string& path);

/// The error, with the file it is about in front of the message.
Error in_file(const std::string& path, Error error);

/// Whether an output of that name can be written, asked before minutes are spent on making it: its
/// extension is that of a format we write, and its folder exists and may be written to.
Status can_write_mesh(const std::string& path);

} // namespace cagewright::cli
