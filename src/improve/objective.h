/// \file
/// What makes one cage better than another, in one number.
#pragma once

#include "improve/guard.h"

#include <limits>
#include <span>
#include <vector>

namespace cagewright {

/// How the parts of the objective are weighted. The objective of a cage is its volume, plus the
/// integral over its faces of d + square * d^2 / D (d the distance to the model, D the model's
/// diagonal), plus shape * D * area * x^2 for each face, x = (a^2 + b^2 + c^2) / (4 sqrt(3) A) - 1
/// for a face of sides a, b, c and area A: zero when equilateral, about 6 when 2 r / R = 0.15,
/// large for needles.
struct ObjectiveWeights {
  double square = 40;      ///< large gaps count more than small ones: no spikes
  double shape = 7e-4;     ///< a distance in diagonals that a better shape is worth
  double typical_area = 0; ///< `area` above, in the model's units: that of a typical face
};

class Objective {
public:
  Objective(const ModelSurface& model, const ObjectiveWeights& weights)
      : model_(&model), weights_(weights) {}

  [[nodiscard]] const ModelSurface& model() const { return *model_; }
  [[nodiscard]] double diagonal() const { return model_->diagonal; }

  /// d + square d^2 / D
  [[nodiscard]] double gap(double d) const { return d + weights_.square * d * d / diagonal(); }
  /// Its derivative, and its second.
  [[nodiscard]] double gap_slope(double d) const { return 1 + gap_curvature() * d; }
  [[nodiscard]] double gap_curvature() const { return 2 * weights_.square / diagonal(); }

  /// What multiplies x^2.
  [[nodiscard]] double shape_weight() const {
    return weights_.shape * diagonal() * weights_.typical_area;
  }

  /// The point of the model nearest to p, or one nearly as near.
  [[nodiscard]] SurfaceTree::Nearest nearest(const Vec3& p) const {
    constexpr double error = 0.03;
    return model_->tree.nearest(p, std::numeric_limits<double>::infinity(), error);
  }

  /// A face's own part: the integral of the gap, by six nearest points, and the shape.
  [[nodiscard]] double face(const Corners& t) const;

  /// The change of the whole objective by a patch, given the parts of the present faces.
  [[nodiscard]] double change(const CageMesh& cage, std::span<const double> face_values,
                              const Patch& patch) const;

  /// The parts of all faces, by number; 0 for those that are not there.
  [[nodiscard]] std::vector<double> face_values(const CageMesh& cage) const;

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

/// The cosine of the angle between the normals of two faces: -1 when one is folded onto the other.
double bend(const Corners& s, const Corners& t);

/// A point from which the tetrahedra over all faces add up to the cage's volume: near the one
/// given, but for a half on its plane, from where what closes it is not seen.
Vec3 volume_origin(const CageMesh& cage, const Vec3& near);

} // namespace cagewright
