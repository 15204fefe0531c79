/// \file
/// How a part of a model that is apart gets its cage. Internal to this module.
#pragma once

#include "symmetry/half.h"
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <optional>

namespace cagewright {

/// What the least cage has: a box, of triangles.
inline constexpr int vertices_for_a_piece = 8;
inline constexpr int faces_for_a_piece = 2 * vertices_for_a_piece - 4;

/// One or several closed surfaces of the same shape.
struct AlikeSurfaces {
  TriangleMesh model; ///< what one of them is to enclose
  int count = 1;
};

/// Makes the cages of parts. If there is a mirror plane the parts are their own mirror images, and
/// so are their cages: a part that keeps off the plane gets two, one the other's mirror image; any
/// other gets one, which the plane cuts.
class PartMaker {
public:
  /// \param model  the whole
  PartMaker(TriangleView model, const GenerateOptions& options,
            const std::optional<MirrorPlane>& plane);
  virtual ~PartMaker() = default;

  /// Of the cage that is made of a part.
  [[nodiscard]] AlikeSurfaces surfaces(TriangleView part) const;

  /// \param options  lengths in diagonals of the part
  /// Errors: those of make_surface().
  [[nodiscard]] virtual Result<GeneratedCage>
  make(TriangleView part, const GenerateOptions& options, const Progress& progress = {}) const;

private:
  [[nodiscard]] Result<GeneratedCage> make_two(TriangleView part, const GenerateOptions& options,
                                               const Progress& progress) const;
  [[nodiscard]] Result<GeneratedCage>
  make_two_once(TriangleView part, const GenerateOptions& options, const Progress& progress) const;

  std::optional<MirrorPlane> plane_;
  MirrorFrame frame_;
  double keep_off_ = 0;
  bool may_be_two_ = false;
};

} // namespace cagewright
