/// \file
/// What a face adds to a quadratic program over the vertices of a cage.
#pragma once

#include "improve/block_program.h"
#include "improve/objective.h"
#include "improve/seam_band.h"

#include <array>
#include <limits>
#include <vector>

namespace cagewright {

/// A function of a face's three corners, to second order round the present ones. The blocks of the
/// Hessian are indexed by the corners, too.
struct FaceTerms {
  FaceTerms() {
    gradient.fill(Vec3::Zero());
    for (auto& row : hessian) {
      row.fill(Mat3::Zero());
    }
  }

  std::array<Vec3, 3> gradient;
  std::array<std::array<Mat3, 3>, 3> hessian;
};

/// The face's part of the objective but for its shape: the volume of the tetrahedron over it from
/// `origin`, the integral of the gap, by six nearest points, and what its corners on tips pay.
FaceTerms volume_and_gap(const Objective& objective, const Corners& t, const Vec3& origin);

/// Half spaces, linear in the corners of triangles, that keep these clear of the model while no
/// vertex moves further than `reach` along an axis.
struct KeepClear {
  const SurfaceTree& model;
  double keep = 0;      ///< the distance to keep from now on
  double clearance = 0; ///< the one that is kept already, or nearly: <= keep
  double reach = 0;
  /// No point next to the model is asked to go further than this in one step.
  double most = std::numeric_limits<double>::infinity();

  /// For the highest point of the model below each of cells^2 small triangles of the triangle t,
  /// and for the nearest to the triangle. \param vertices  the corners' numbers in the program
  void add_triangle(const Triangle& vertices, const Corners& t, int cells,
                    std::vector<BlockConstraint>& constraints) const;

  /// For the point of the model nearest to p = sum of share[k] * corner k.
  void add_point(const Triangle& vertices, const std::array<double, 3>& share, const Vec3& p,
                 std::vector<BlockConstraint>& constraints) const;
};

/// Half spaces that keep vertex v of a program, now at p, in the band, or let it go no further off
/// it. \param unit  the length that the program's steps are measured in
void add_band(const SeamBand& band, const Vec3& p, Index v, double unit,
              std::vector<BlockConstraint>& constraints);

/// The shares of the corners of t in the point of its plane below p.
std::array<double, 3> barycentric(const Vec3& p, const Corners& t);

} // namespace cagewright
