#include "cage/merit.h"

#include "quads/quads.h"
#include <cagewright/mesh/polygon_mesh.h>

namespace cagewright {
namespace {

QuadReport report_of_triangles(TriangleView cage) {
  QuadReport report =
      report_of(PolygonMesh(TriangleMesh{{cage.positions.begin(), cage.positions.end()},
                                         {cage.triangles.begin(), cage.triangles.end()}}));
  report.share = shape_limits::enough_quads; // none were asked for
  return report;
}

} // namespace

double dearer_by(double webbing, int genus, int known) {
  constexpr double for_a_handle = 0.04;
  return (1 + webbing) * (1 + for_a_handle * std::max(0, genus - known));
}

Merit::Merit(bool has_reached, TriangleView cage) : Merit(has_reached, report_of_triangles(cage)) {}

} // namespace cagewright
