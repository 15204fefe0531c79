#include "quads/grid_quads.h"

#include "core/maths.h"
#include "quads/exchange_loops.h"
#include "quads/grid_layout.h"
#include "quads/quad_weights.h"
#include "quads/relax_quads.h"
#include "quads/settle_shapes.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace cagewright {
namespace {

/// The second moments of the surface, about its center.
Mat3 moments_of(TriangleView model) {
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  double area = 0;
  for (const Triangle& t : model.triangles) {
    const Corners c{model.positions[t[0]], model.positions[t[1]], model.positions[t[2]]};
    const double a = triangle_area(c);
    for (const Vec3& p : c) {
      first += a / 3 * p;
      second += a / 3 * p * p.transpose();
    }
    area += a;
  }
  if (!(area > 0)) {
    return Mat3::Identity();
  }
  first /= area;
  return second / area - first * first.transpose();
}

/// Along the model's principal axes; of a half, turned about the x axis only.
Mat3 principal_axes(TriangleView model, bool half) {
  const Mat3 moments = moments_of(model);
  Mat3 axes = Mat3::Identity();
  if (half) {
    const Eigen::Matrix2d m = moments.bottomRightCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(m);
    axes.bottomRightCorner<2, 2>() = solver.eigenvectors();
  } else {
    axes = Eigen::SelfAdjointEigenSolver<Mat3>(moments).eigenvectors();
  }
  if (axes.determinant() < 0) {
    axes.col(2) *= -1;
  }
  return axes;
}

struct Blocks {
  PolygonMesh surface;
  double volume = 0;
};

Result<Blocks> blocks(TriangleView model, const SolidGridOptions& fine,
                      const GridLayoutOptions& coarse, const Progress& progress) {
  const Result<SolidGrid> solid = solid_grid(model, fine, progress);
  if (!solid) {
    return solid.error();
  }
  const GridLayout layout = grid_layout(*solid, coarse, progress);
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return Blocks{surface_of(layout, *solid, fine.half), layout.volume * maths::cube(solid->size())};
}

/// In the axes that need less volume: the model's own, or if they are much better the principal
/// ones.
Result<Blocks> best_blocks(TriangleView model, const GridQuadOptions& options, double clearance,
                           int vertices, const Progress& progress) {
  SolidGridOptions fine;
  fine.clearance = clearance;
  fine.half = options.half;
  fine.resolution = vertices > 250 ? 80 : 56;
  const GridLayoutOptions coarse{.vertices = vertices, .half = options.half};
  Result<Blocks> own = blocks(model, fine, coarse, progress.part(0, 0.5));
  if (!own || progress.cancelled()) {
    return own;
  }
  fine.axes = principal_axes(model, options.half);
  Result<Blocks> turned = blocks(model, fine, coarse, progress.part(0.5, 1));
  constexpr double much = 0.93;
  return turned && turned->volume < much * own->volume ? std::move(turned) : std::move(own);
}

bool is_valid(const QuadCage& cage, const QuadGuard& guard) {
  const std::vector<Box3> boxes = face_boxes(cage, cage.positions());
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (!guard.may_stand(cage, boxes, f)) {
      return false;
    }
  }
  return !loses_a_part(guard.model(), cage, cage.positions());
}

} // namespace

Result<Quadrangulated> make_grid_quads(TriangleView model, const GridQuadOptions& options,
                                       const Progress& progress) {
  return make_grid_quads(ModelSurface(model, options.quads.diagonal), options, progress);
}

Result<Quadrangulated> make_grid_quads(const ModelSurface& surface, const GridQuadOptions& options,
                                       const Progress& progress) {
  // A closed surface of quads has two vertices more than faces.
  const int most = options.vertices > 0 ? options.vertices : options.faces + 2;
  constexpr int fewest = 8;
  if (most < fewest) {
    return Error{ErrorCode::invalid_option, "blocks have eight vertices at least"};
  }
  const TriangleMesh& all = surface.mesh;
  const double clearance = options.quads.clearance * surface.diagonal;
  const Result<Blocks> start = best_blocks(all, options, clearance, most, progress.part(0, 0.1));
  if (!start) {
    return start.error();
  }
  QuadCage cage(start->surface);
  const QuadGuard guard(surface, clearance, options.quads.limits);
  if (!is_valid(cage, guard)) {
    return Error{ErrorCode::no_valid_cage, "the blocks round the model are no valid cage"};
  }
  const double face_area = surface_area(all) / (2.0 * most) * (options.half ? 2 : 1);
  const Objective objective(surface, weights_for(all, options.quads, face_area));
  RelaxQuadsOptions settle;
  settle.steps = 20;
  settle.keep = options.quads.clearance;
  settle.first_step = 0.1;
  settle.slender = 1;
  relax_quads(cage, guard, objective, settle, progress.part(0.1, 0.3));
  if (options.loosest > 0 &&
      looseness(cage.to_polygons(), surface, options.quads) > options.loosest) {
    return Error{ErrorCode::no_valid_cage, "blocks do not fit the model"};
  }
  ExchangeLoopsOptions loops;
  loops.vertices = static_cast<std::size_t>(options.vertices);
  loops.faces = static_cast<std::size_t>(options.faces);
  loops.relax = settle;
  loops.relax.first_step = 0.05;
  // Each round takes as long as there are vertices, and more.
  constexpr int work = 800;
  loops.rounds = std::clamp(work / most, 1, 8);
  loops.tries = std::clamp(work / most, 1, 3);
  constexpr double most_gain = 1.3; // of all rounds
  loops.dearest = most_gain * options.dearest;
  const double value = exchange_loops(cage, guard, objective, loops, progress.part(0.3, 0.95));
  if (loops.dearest > 0 && value > loops.dearest) {
    return Error{ErrorCode::no_valid_cage, "blocks do not fit the model"};
  }
  split_unfit(cage, options.quads.limits);
  settle_shapes(cage, guard, objective, settle, progress.part(0.95, 1));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  Quadrangulated result;
  result.cage = cage.to_polygons();
  result.report = report_of(result.cage);
  return result;
}

double looseness(const PolygonMesh& cage, const ModelSurface& model, const QuadOptions& options) {
  const Objective objective(model, weights_for(model.mesh, options, 0));
  const TriangleMesh triangles = to_triangle_mesh(cage);
  double sum = 0;
  for (const Triangle& t : triangles.triangles) {
    sum += objective.face(
        {triangles.positions[t[0]], triangles.positions[t[1]], triangles.positions[t[2]]});
  }
  return sum;
}

} // namespace cagewright
