/// \file
/// A cage in another unit, turned to another up axis, or beside its model: what would make it fit.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <optional>
#include <string>

namespace cagewright {

/// A change of a cage as a whole: scaled and turned about the origin, then shifted.
struct CageFit {
  double scale = 1;
  Mat3 turn = Mat3::Identity(); ///< a rotation by right angles
  Vec3 shift = Vec3::Zero();
  double inside =
      0; ///< share of the model's vertices, in [0, 1], inside the cage once it is changed
  /// What to do, such as "scaled by 0.01 (another unit)" or "turned by 90 degrees about the x axis
  /// (y up to z up) and shifted by (0, 2, 0)".
  std::string description;

  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return scale * (turn * p) + shift; }
  [[nodiscard]] PolygonMesh operator()(PolygonMesh cage) const;
};

/// The simplest change that makes a cage enclose its model, if it does not as it is, or is several
/// times as large as the model: a scale of units (10, 100, 1000, inches, feet), a turn that makes
/// another axis the upward one, a shift, or what of these must be combined. None when the cage fits
/// about as it is, or when nothing of the kind would help: it is then another cage.
///
/// It is an estimate, from some of the model's vertices and the winding number of the cage: whether
/// the changed cage is valid, validate_cage() decides.
///
/// \param cage   need not be valid
/// \param model  V vertices, T triangles
/// Cost: O(V + F) and some hundred winding numbers for each change that the sizes allow; some
/// thousand for a shift.
std::optional<CageFit> fit_cage(const PolygonMesh& cage, TriangleView model);

/// The diagonal of the cage's box divided by that of the model's; 0 where one has none.
double relative_size(const PolygonMesh& cage, TriangleView model);

} // namespace cagewright
