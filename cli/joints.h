/// \file
/// Where limbs bend, from the file of --joints.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/core/result.h>
#include <cagewright/io/pose.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace cagewright::cli {

/// Declares --joints.
CLI::Option* add_joints_option(CLI::App& command, std::string& file, const std::string& purpose);

/// Of a skeleton, the joints between a parent and a child, which is where the limb goes on; of mere
/// points all of them. None if no file is given.
/// Errors: those of read_joints(); invalid_option (no joint of the skeleton is between two others).
Result<std::vector<LimbJoint>> limb_joints(const std::string& file, Pose pose);

} // namespace cagewright::cli
