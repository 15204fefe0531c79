/// \file
/// Joints from a file: a model's own, or a list of points.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>
#include <cagewright/io/read_skeleton.h>

#include <filesystem>

namespace cagewright {

/// Reads the joints of a glTF or GLB file as read_skeleton() does, or of a text file:
///
///     # x y z, in the coordinates of the model, and the joint above it
///     0    1.4  0    0      # joint 1: none is above it
///     0.2  1.4  0    1      # joint 2 hangs on joint 1
///     0.5  1.4  0    2
///
/// A line for each joint: three numbers, and the number of its parent, counted from 1 in the order
/// of the file; 0 or nothing: it has none. Parents may come after their children; what is returned
/// has the order of the file. Empty lines, and what follows a #, are skipped.
///
/// Errors: cannot_read, malformed (with the line), unsupported (no joints in a glTF file, or a mesh
/// in another format).
Result<Skeleton> read_joints(const std::filesystem::path& path, Pose pose = Pose::shown);

} // namespace cagewright
