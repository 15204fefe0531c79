#include "cage/unit_frame.h"

#include "mesh/reach.h"
#include <cagewright/mesh/measures.h>

#include <string>

namespace cagewright {
namespace {

/// A model whose coordinates resolve less than this part of its diagonal cannot be told from noise.
constexpr double least_resolution = 1e-6;
/// Relative spacing of doubles.
constexpr double unit_round_off = 0x1.0p-52;
/// Points this near to a line (as a fraction of the diagonal) lie on it.
constexpr double line_width = 1e-12;

Error unfit(std::string message) {
  return {ErrorCode::unfit_model, std::move(message)};
}

bool on_one_line(std::span<const Vec3> positions, double diagonal) {
  const Vec3& origin = positions[0];
  Vec3 furthest = origin;
  for (const Vec3& p : positions) {
    if ((p - origin).squaredNorm() > (furthest - origin).squaredNorm()) {
      furthest = p;
    }
  }
  const Vec3 direction = (furthest - origin).normalized();
  for (const Vec3& p : positions) {
    if ((p - origin).cross(direction).norm() > line_width * diagonal) {
      return false;
    }
  }
  return true;
}

} // namespace

Result<UnitFrame> unit_frame(TriangleView model) {
  if (model.triangles.empty()) {
    return unfit("the model has no faces; export it as a surface, not as points or curves");
  }
  for (std::size_t v = 0; v < model.positions.size(); ++v) {
    if (!is_within_reach(model.positions[v])) {
      return unfit("vertex " + std::to_string(v) +
                   " of the model has a coordinate that is not a finite number, or beyond 1e100; "
                   "repair the model, or scale it down");
    }
  }
  const Box3 box = bounding_box(model.positions);
  const double diag = box.diagonal().norm();
  if (!(diag > 0)) {
    return unfit("all vertices of the model coincide; check the scale it was exported with");
  }
  if (box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff() * unit_round_off >
      least_resolution * diag) {
    return unfit("the model lies so far from the origin that its coordinates have fewer than six "
                 "digits left; move it nearer to the origin before exporting");
  }
  if (on_one_line(model.positions, diag)) {
    return unfit("all vertices of the model lie on one line; a cage needs a surface");
  }
  return UnitFrame{box.center(), diag};
}

std::vector<Vec3> to_unit(const UnitFrame& frame, std::span<const Vec3> positions) {
  std::vector<Vec3> unit;
  unit.reserve(positions.size());
  for (const Vec3& p : positions) {
    unit.push_back(frame.to_unit(p));
  }
  return unit;
}

} // namespace cagewright
