/// \file
/// How well a cage bends each limb of its model.
#pragma once

#include "cage/limb_rings.h"
#include "spatial/bvh.h"
#include <cagewright/coordinates/coordinates.h>
#include <cagewright/core/geometry.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cagewright {

/// The limbs of a model, and which points follow them: the same for all cages that are compared.
///
/// Limbs are those that rings of edges would go round (see limb_rings()), on an envelope of the
/// model. At its joint a limb of width w bends within w, half of it on either side: with s the
/// distance beyond the joint along the limb and t = clamp(s / w + 1/2, 0, 1), a point of the limb
/// is turned about an axis through the joint by 45 degrees times t^2 (3 - 2 t). All other points
/// rest. A point belongs to the limb if the point of the envelope nearest to it does, or if it is
/// within 3/4 w of the joint.
class BendableLimbs {
public:
  /// \param joints  where limbs bend; empty: found from the shape
  /// Errors: those of envelope().
  static Result<BendableLimbs> of(TriangleView model, std::span<const LimbJoint> joints,
                                  const Progress& progress);

  [[nodiscard]] std::size_t count() const { return limbs_.size(); }
  [[nodiscard]] const Limb& limb(std::size_t number) const { return limbs_[number]; }

  /// How far each point is turned when a limb bends, of 45 degrees: 0 to 1.
  [[nodiscard]] std::vector<double> shares(std::size_t number, std::span<const Vec3> points) const;

  /// Where a point goes that is turned by a share of 45 degrees, in one of four directions.
  [[nodiscard]] Vec3 bent(std::size_t number, int direction, const Vec3& p, double share) const;

  static constexpr int directions = 4;

  /// What the limb is turned about, of length one, when it bends in a direction.
  [[nodiscard]] Vec3 axis(std::size_t number, int direction) const;

private:
  TriangleBvh envelope_;
  std::vector<Limb> limbs_;
  std::vector<std::vector<std::uint8_t>> is_of_limb_; // faces of the envelope, by limb
};

/// What becomes of a limb, in all four directions. Lengths are in diagonals of the model's box.
struct LimbBendError {
  double mean = 0;       ///< distance from where the limb's vertices should be
  double max = 0;        ///< the greatest
  double drag = 0;       ///< how far vertices go that should rest, in the mean
  double max_drag = 0;   ///< the greatest
  double reached = 0;    ///< of the 45 degrees: by how much the end of the limb turns, in degrees
  double left = 0;       ///< share of the limb's vertices that leave the bent cage
  std::size_t moved = 0; ///< vertices of the limb
};

/// Bends the vertices of the cage at each joint, lets the model follow, and compares it with the
/// model bent itself.
///
/// \param coordinates  of the cage
/// \param cage         its faces
/// Errors: cancelled.
/// Cost: that of binding, and four poses for each limb.
Result<std::vector<LimbBendError>> limb_bend_errors(const Coordinates& coordinates,
                                                    TriangleView cage, std::span<const Vec3> model,
                                                    const BendableLimbs& limbs,
                                                    const Progress& progress);

/// Joints, errors, and their means over the limbs.
nlohmann::json json_of(const BendableLimbs& limbs, std::span<const LimbBendError> errors);

/// Over all limbs: the mean of the means, and the greatest of the greatest.
LimbBendError summed(std::span<const LimbBendError> errors);

} // namespace cagewright
