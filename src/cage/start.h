/// \file
/// The surfaces that cages are made from. Internal to this module.
///
/// A new start is a file with one function, and a line in maker_of() of start.cpp.
#pragma once

#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

class Ground;

/// How an envelope is made.
struct EnvelopeSetting {
  int resolution = 0; ///< voxels along the model's diagonal; 0: chosen
  double closing = 0; ///< gaps narrower than twice this, in diagonals, are filled
  double fill = 0;    ///< handles narrower than this, in diagonals, are filled: see EnvelopeOptions
};

/// Of EnvelopeSetting::fill: handles so narrow are filled in any case, as between fingers; those up
/// to the other width, as between an arm and the trunk, where that makes the better cage.
inline constexpr double narrow_handle = 0.05;
inline constexpr double wide_handle = 0.3;

/// What may differ between several starts of one cage.
struct StartTry {
  Method method = Method::envelope; ///< or boxes_improved
  EnvelopeSetting envelope = {};
  /// How many vertices an envelope is made for: the fewer, the more of the model's handles are
  /// filled. 0: those of the budget.
  int envelope_vertices = 0;
};

/// A valid cage that may have any number of vertices, or half of one.
struct Start {
  TriangleMesh surface; ///< in the ground's coordinates
  double clearance = 0; ///< that it keeps: no more than asked for
  Method method = Method::envelope;
  int resolution = 0;                     ///< of an envelope
  int genus = 0;                          ///< of an envelope
  int known = 0;                          ///< handles that the model has itself, as far as is known
  int bridges = 0;                        ///< of an envelope
  std::optional<StartTry> rival;          ///< a start that promised about as much
  std::shared_ptr<const BoxesMade> boxes; ///< of boxes
  std::string why_not_boxes;              ///< if an envelope was taken where boxes were asked for
};

/// The start that is tried first for a closed surface with these options.
StartTry first_start(const GenerateOptions& options);

/// Whether an envelope is to be chosen among several. Which start makes good quads drafts of
/// triangles do not tell.
bool is_open(const GenerateOptions& options, const StartTry& how);

/// Those that are tried if it did not lead to a cage within the budget: each fills more handles
/// than the one before, and is of use for nothing else.
std::vector<StartTry> starts_of_fewer_handles(const GenerateOptions& options);

/// Those that are tried, one after another, as long as limbs that are apart come out joined: voxels
/// of an envelope so coarse that they join them leave a web that nothing opens again. Finer than
/// an envelope of a resolution; what becomes of one of few vertices is partly luck, so the next
/// may free what the one before did not.
std::vector<StartTry> starts_of_finer_voxels(const GenerateOptions& options, int resolution);

/// Makes a start. Where boxes give none, an envelope is taken, and `why_not_boxes` says so.
/// Errors: those of envelope() and make_box_cage().
Result<Start> make_start(const Ground& ground, const GenerateOptions& options, const StartTry& how,
                         const Progress& progress = {});

/// The outer boundary of the voxels near the model. Unless the options say how it is to be made it
/// is the best of several: see promising_envelope().
Result<Start> start_from_envelope(const Ground& ground, const GenerateOptions& options,
                                  const StartTry& how, const Progress& progress);

/// The union of boxes. On half a ground: that of the model and its mirror image, cut by the plane;
/// what it has on one side takes the place of the other side.
Result<Start> start_from_boxes(const Ground& ground, const GenerateOptions& options,
                               const StartTry& how, const Progress& progress);

} // namespace cagewright
