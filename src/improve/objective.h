/// \file
/// What makes one cage better than another, in one number.
#pragma once

#include "core/maths.h"
#include "improve/guard.h"
#include "mesh/shape_limits.h"
#include <cagewright/core/progress.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

namespace cagewright {

/// How the parts of the objective are weighted. The objective of a cage is its volume, plus the
/// integral over its faces of d + square * d^2 / D (d the distance to the model, D the model's
/// diagonal), plus shape * D * area * x^2 for each face, x = (a^2 + b^2 + c^2) / (4 sqrt(3) A) - 1
/// for a face of sides a, b, c and area A: zero when equilateral, about 6 when 2 r / R = 0.15,
/// large for needles. Plus webbing * the volume of the space between limbs that is inside the cage,
/// counted in points: a web between two legs has hardly any volume. Plus tip * D * e^2 for each
/// corner of a face that is farther from the model than `near_tip`, by e.
///
/// Where the model has an emphasis w, at the nearest of its triangles, a gap counts w times: the
/// integrand there is (2 w - 1) d + w square d^2 / D, the volume having been counted once.
struct ObjectiveWeights {
  double square = 40;                ///< large gaps count more than small ones: no spikes
  double shape = 7e-4;               ///< a distance in diagonals that a better shape is worth
  double typical_area = 0;           ///< `area` above, in the model's units: that of a typical face
  std::vector<double> emphasis = {}; ///< of each triangle of the model, >= 1; none: 1 everywhere
  double typical_emphasis = 1;       ///< that of a typical place
  /// What is between limbs, or nothing; lives as long as the objective.
  const SpaceBetween* between = nullptr;
  double webbing = 30; ///< how many times its volume counts
  double tip = 0;      ///< the integrals above hardly feel a spike, however long
  double near_tip = 0.9 * shape_limits::far_tip; ///< in diagonals
  /// No step may leave a face of the cage farther than this from the model at any of a few samples,
  /// unless it brings it much nearer than it was: in the model's units.
  double most_gap = std::numeric_limits<double>::infinity();
};

/// The emphasis that makes the cage finer where the density is greater: (density / least)^2. For
/// small faces of side e the gap is about e^2 times the curvature, so that the least of
/// integral(w gap) at a given number of faces has e ~ w^(-1/4) = density^(-1/2).
///
/// \param density  for each vertex of the model, > 0; none: no emphasis
void set_emphasis(ObjectiveWeights& weights, TriangleView model, std::span<const double> density);

class Objective {
public:
  Objective(const ModelSurface& model, const ObjectiveWeights& weights)
      : model_(&model), weights_(weights) {}

  [[nodiscard]] const ObjectiveWeights& weights() const { return weights_; }
  [[nodiscard]] const ModelSurface& model() const { return *model_; }
  [[nodiscard]] double diagonal() const { return model_->diagonal; }

  /// What a place of the cage is taken times, by the place of the model that is nearest.
  [[nodiscard]] double emphasis(const SurfaceTree::Nearest& near) const {
    return weights_.emphasis.empty() ? 1 : weights_.emphasis[near.triangle];
  }

  /// With an emphasis of one d + square d^2 / D.
  [[nodiscard]] double gap(const SurfaceTree::Nearest& near) const {
    const double d = near.distance;
    return (2 * emphasis(near) - 1) * d + gap_curvature(near) / 2 * d * d;
  }
  /// Its derivative, and its second.
  [[nodiscard]] double gap_slope(const SurfaceTree::Nearest& near) const {
    return 2 * emphasis(near) - 1 + gap_curvature(near) * near.distance;
  }
  [[nodiscard]] double gap_curvature(const SurfaceTree::Nearest& near) const {
    return 2 * emphasis(near) * weights_.square / diagonal();
  }

  /// What multiplies e^2.
  [[nodiscard]] double tip_weight() const { return weights_.tip * diagonal(); }
  /// e: how much farther than is near a point is from the model.
  [[nodiscard]] double beyond_near(double distance) const {
    return std::max(0.0, distance - weights_.near_tip * diagonal());
  }

  /// What multiplies x^2.
  [[nodiscard]] double shape_weight() const {
    return weights_.shape * diagonal() * weights_.typical_area;
  }

  /// The point of the model nearest to p, or one nearly as near.
  [[nodiscard]] SurfaceTree::Nearest nearest(const Vec3& p) const {
    constexpr double error = 0.03;
    return model_->tree.nearest(p, std::numeric_limits<double>::infinity(), error);
  }

  /// A face's own part: the integral of the gap, by three nearest points, the shape, and its share
  /// of the webbing, which adds up over a closed surface.
  [[nodiscard]] double face(const Corners& t) const;

  /// What it pays for corners on tips.
  [[nodiscard]] double tips(const Corners& t) const;

  /// The greatest distance to the model at fifteen points of the triangle, its corners among them.
  [[nodiscard]] double sampled_gap(const Corners& t) const;

  /// Whether the patch breaks weights().most_gap.
  [[nodiscard]] bool widens_gap(const CageMesh& cage, const Patch& patch) const;

  /// The same for a face that moves.
  [[nodiscard]] bool widens_gap(const Corners& before, const Corners& after) const;

  /// Of the webbing.
  [[nodiscard]] double webbing(const Corners& t) const {
    return weights_.between == nullptr
               ? 0
               : weights_.webbing * maths::cube(weights_.between->voxel()) *
                     static_cast<double>(weights_.between->behind({t[0], t[1], t[2]}));
  }

  void allow_webs() { weights_.between = nullptr; }
  void limit_gap(double most_gap) { weights_.most_gap = most_gap; }
  void weigh_shape(double shape) { weights_.shape = shape; }
  void weigh_tips(double tip) { weights_.tip = tip; }

  /// The change of the whole objective by a patch, given the parts of the present faces.
  [[nodiscard]] double change(const CageMesh& cage, std::span<const double> face_values,
                              const Patch& patch) const;

  /// The parts of all faces, by number; 0 for those that are not there.
  [[nodiscard]] std::vector<double> face_values(const CageMesh& cage,
                                                const Progress& progress = {}) const;

  /// The change of the cage's volume by a patch; of a half, the change of the half's.
  static double volume_change(const CageMesh& cage, const Patch& patch);

  /// The objective of the cage; of a half, half that of the whole.
  [[nodiscard]] double total(const CageMesh& cage) const;

private:
  const ModelSurface* model_;
  ObjectiveWeights weights_;
};

/// (a^2 + b^2 + c^2) / (4 sqrt(3) A) of an equilateral triangle.
inline constexpr double good_shape = 1;

/// x of ObjectiveWeights: 0 for an equilateral triangle, at most 100.
double shape_defect(const Corners& t);

double triangle_area(const Corners& t);

/// 2 r / R: 1 for an equilateral triangle, 0 for one without area.
inline double shape_quality(const Corners& t) {
  return triangle_quality(t[0], t[1], t[2]);
}

/// The cosine of the angle between the normals of two faces: -1 when one is folded onto the other.
double bend(const Corners& s, const Corners& t);

/// A point from which the tetrahedra over all faces add up to the cage's volume: near the one
/// given, but for a half on its plane, from where what closes it is not seen.
Vec3 volume_origin(const CageMesh& cage, const Vec3& near);

} // namespace cagewright
