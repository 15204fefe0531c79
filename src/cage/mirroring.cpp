#include "cage/mirroring.h"

#include "symmetry/mirror_plane.h"

namespace cagewright {
namespace {

/// Of the diagonal. A model further off its mirror image, in the mean, is mirrored only if that is
/// insisted on: a cage round both is looser by about half of it.
constexpr double nearly = 0.001;

} // namespace

Mirroring choose_mirroring(TriangleView model, const GenerateOptions& options, const Vec3& origin,
                           const Progress& progress) {
  switch (options.symmetry) {
  case Symmetry::off:
    return {};
  case Symmetry::topology:
    if (const auto plane = detect_mirror_plane(model, {.origin = origin}, progress);
        plane && plane->mean_error <= nearly) {
      return {plane, false, ""};
    }
    return {std::nullopt, false, "", true};
  case Symmetry::automatic:
    // It would count on both sides: that is for those who insist on the symmetry.
    if (!options.density.empty()) {
      return {std::nullopt, false, "a density need not be the same on both sides"};
    }
    if (const auto plane = detect_mirror_plane(model, {.origin = origin}, progress)) {
      if (plane->mean_error <= nearly) {
        return {plane, false, ""};
      }
      return {std::nullopt, false,
              "the model is only roughly its own mirror image, and a cage round both would be "
              "looser"};
    }
    return {std::nullopt, false, "the model is not its own mirror image in any plane"};
  case Symmetry::x:
  case Symmetry::y:
  case Symmetry::z:
    break;
  }
  const int axis = options.symmetry == Symmetry::x ? 0 : options.symmetry == Symmetry::y ? 1 : 2;
  if (const auto plane = best_mirror_plane(model, axis, origin, progress)) {
    return {plane, true, ""};
  }
  return {std::nullopt, true, "the model has no surface to mirror"};
}

} // namespace cagewright
