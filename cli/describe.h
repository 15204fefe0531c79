/// \file
/// All commands with all their options, as they are declared, for what is made of them.
#pragma once

#include "session.h"

namespace cagewright::cli {

/// Declares the command describe, which --help does not list: it writes the table of commands and
/// options as JSON, of which tools/reference.py makes manual pages, completion and
/// docs/reference.md.
void add_describe(CLI::App& app, Session& session);

} // namespace cagewright::cli
