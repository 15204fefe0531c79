/// \file
/// What `generate` does once its command line is understood.
#pragma once

#include "generate/arguments.h"
#include "session.h"

namespace cagewright::cli {

/// Reads the model, makes what was asked for (the voxels or boxes, the union of the boxes, or a
/// cage within a budget), writes it and its description, and prints the summary.
/// \returns the exit code
int run_generate(const GenerateArguments& arguments, const Session& session);

} // namespace cagewright::cli
