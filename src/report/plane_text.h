/// \file
/// Planes for people, the same in every command.
#pragma once

#include "symmetry/mirror_plane.h"

#include <string>

namespace cagewright {

/// "x = 0.5", or "0.6 x + 0.8 z = 0.5"
std::string text_of(const MirrorPlane& plane);

} // namespace cagewright
