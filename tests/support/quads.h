/// \file
/// Options for cages of quads that are made quickly.
#pragma once

#include <cagewright/cage/generate.h>

namespace cagewright::test {

/// At most so many vertices (0: no limit), not refined.
inline GenerateOptions quads_of(int vertices) {
  GenerateOptions options;
  options.vertices = vertices;
  options.rounds = 0;
  options.quads = true;
  options.symmetry = Symmetry::off;
  return options;
}

} // namespace cagewright::test
