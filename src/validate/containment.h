/// \file
/// How often a surface winds round a point.
#pragma once

#include "validate/cage_parts.h"

#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// Where a point lies.
enum class Location { inside, outside, on_surface };

/// What kind of surface the parts of one cutting make up.
enum class Closure {
  oriented, ///< every edge is used as often one way as the other: the winding number is a whole
            ///< number
  even,     ///< every edge is used an even number of times: crossings tell inside from outside
  open,     ///< neither
};

/// Judged by the vertex indices.
Closure closure_of(std::span<const Triangle> triangles);

/// Tells where points lie with respect to a cage, exactly if it is not open.
///
/// For each point a segment is drawn to beyond the cage's box, and the signs of its crossings are
/// summed by exact predicates; where it meets an edge or a vertex another one is drawn, in a fixed
/// order. Inside means a sum of at least 1 (oriented) or an odd number of crossings (even); of an
/// open cage, a generalized winding number of at least a half (Jacobson, Kavan and Sorkine-Hornung
/// 2013), in doubles.
class Containment {
public:
  /// \param weights  for each part, how much a crossing counts: 1, -1 where its orientation is to
  /// be
  ///                 turned, 0 to leave it out
  Containment(const CageParts& cage, Closure closure, std::vector<int> weights);

  /// Inside means inside under both cuttings of the cage. \returns with on_surface also a face, in
  /// `face`.
  [[nodiscard]] Location locate(const Vec3& p, Index* face = nullptr) const;

private:
  struct Crossings {
    int sum = 0;
    int count = 0;
  };

  [[nodiscard]] bool is_inside(const Vec3& p, unsigned cutting) const;
  [[nodiscard]] std::optional<Crossings> crossings(const Vec3& p, const Vec3& q,
                                                   unsigned cutting) const;
  [[nodiscard]] double solid_angle(const Vec3& p, unsigned cutting) const;

  const CageParts& cage_;
  Closure closure_;
  std::vector<int> weights_;
  Box3 box_;
};

} // namespace cagewright
