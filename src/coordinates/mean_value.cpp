#include <cagewright/coordinates/mean_value.h>

#include "coordinates/mean_value_tables.h"
#include "core/parallel.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

using Real = long double; // the tables are rounded once, when they are stored
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

/// An edge of a triangle as it is looked up: smaller index first.
struct EdgeUse {
  Index from, to;
  std::size_t triangle;
  unsigned opposite; ///< which corner of the triangle
  int direction;     ///< +1 when the triangle runs from -> to

  [[nodiscard]] bool same_edge(const EdgeUse& other) const {
    return from == other.from && to == other.to;
  }
};

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = triangles[t][(i + 1) % 3];
      const Index b = triangles[t][(i + 2) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, i, a < b ? 1 : -1});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.from, a.to, a.triangle, a.opposite) <
           std::tie(b.from, b.to, b.triangle, b.opposite);
  });
  return uses;
}

/// Edges whose triangles do not run along it as often one way as the other.
std::size_t count_open(const std::vector<EdgeUse>& uses) {
  std::size_t open = 0;
  for (std::size_t i = 0; i < uses.size();) {
    int balance = 0;
    std::size_t j = i;
    for (; j < uses.size() && uses[j].same_edge(uses[i]); ++j) {
      balance += uses[j].direction;
    }
    open += balance != 0 && uses[i].from != uses[i].to ? 1 : 0;
    i = j;
  }
  return open;
}

Status check(TriangleView cage, const MeanValueOptions& options) {
  const auto invalid = [](std::string message) {
    return Error{ErrorCode::invalid_cage, std::move(message)};
  };
  if (cage.triangles.empty()) {
    return invalid("the cage has no faces");
  }
  for (std::size_t t = 0; t < cage.triangles.size(); ++t) {
    for (const Index v : cage.triangles[t]) {
      if (v >= cage.positions.size()) {
        return invalid("triangle " + std::to_string(t) + " of the cage refers to vertex " +
                       std::to_string(v) + ", but there are " +
                       std::to_string(cage.positions.size()));
      }
      if (!cage.positions[v].allFinite()) {
        return invalid("vertex " + std::to_string(v) + " of the cage is not finite");
      }
    }
  }
  if (!options.allow_open) {
    const std::size_t open = count_open(edge_uses(cage.triangles));
    if (open > 0) {
      return invalid("the cage has " + std::to_string(open) + " open or inconsistent edge" +
                     (open == 1 ? "" : "s"));
    }
  }
  return success();
}

/// Triangles without area see nothing, and a triangle this thin has no plane to speak of: the
/// faces beside it meet across its edges as if it were not there.
bool is_degenerate(const RealVec3& a, const RealVec3& b, const RealVec3& c) {
  const Real longest2 =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return (b - a).cross(c - a).norm() <= 1e-13L * longest2;
}

template <class T>
typename MeanValueTables<T>::Affine affine(const RealVec3& gradient, const RealVec3& zero_at) {
  return {static_cast<T>(gradient.x()), static_cast<T>(gradient.y()), static_cast<T>(gradient.z()),
          static_cast<T>(-gradient.dot(zero_at))};
}

template <class T> typename MeanValueTables<T>::Vertex make_vertex(const RealVec3& p) {
  return {static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z()),
          static_cast<T>(p.squaredNorm())};
}

template <class T>
typename MeanValueTables<T>::Face make_face(const Triangle& t, std::span<const Vec3> positions) {
  const RealVec3 a = positions[t[0]].cast<Real>();
  const RealVec3 b = positions[t[1]].cast<Real>();
  const RealVec3 c = positions[t[2]].cast<Real>();
  const RealVec3 normal = (b - a).cross(c - a);
  const Real square = normal.squaredNorm();
  typename MeanValueTables<T>::Face face;
  face.vertices = t;
  face.lambda_0 = affine<T>(normal.cross(c - b) / square, b);
  face.lambda_1 = affine<T>(normal.cross(a - c) / square, c);
  face.delta = affine<T>(-normal / square, a);
  face.kappa = {static_cast<T>((b - a).dot(c - a)), static_cast<T>((a - b).dot(c - b)),
                static_cast<T>((a - c).dot(b - c))};
  face.area2 = static_cast<T>(std::sqrt(square));
  const RealVec3 center = (a + b + c) / 3;
  face.center = make_vertex<T>(center);
  face.radius2 = static_cast<T>(std::max(
      {(a - center).squaredNorm(), (b - center).squaredNorm(), (c - center).squaredNorm()}));
  face.length2 = {static_cast<T>((c - b).squaredNorm()), static_cast<T>((a - c).squaredNorm()),
                  static_cast<T>((b - a).squaredNorm())};
  return face;
}

/// Nodes and weights of Gauss and Legendre on [0, 1].
struct GaussRule {
  std::vector<Real> nodes, weights;

  explicit GaussRule(int count) {
    constexpr Real pi = 3.14159265358979323846264338327950288L;
    for (int i = 0; i < count; ++i) {
      Real x = std::cos(pi * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(count) + 0.5L));
      Real slope = 1;
      for (int step = 0; step < 10; ++step) { // Newton's method; four or five steps suffice
        Real last = 1;
        Real value = x;
        for (int k = 2; k <= count; ++k) {
          last = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * last) / k);
        }
        slope = count * (x * value - last) / (x * x - 1);
        x -= value / slope;
      }
      nodes.push_back((1 + x) / 2);
      weights.push_back(1 / ((1 - x * x) * slope * slope));
    }
  }
};

/// count x count nodes: those of a square, of which one side is drawn together to a corner.
template <class T> typename MeanValueTables<T>::Rule make_rule(int count, double least_ratio) {
  const GaussRule gauss(count);
  typename MeanValueTables<T>::Rule rule;
  rule.least_ratio2 = static_cast<T>(least_ratio * least_ratio);
  for (std::size_t i = 0; i < gauss.nodes.size(); ++i) {
    for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
      const Real u = gauss.nodes[i];
      const Real a = 1 - u;
      const Real b = u * (1 - gauss.nodes[k]);
      const Real c = u * gauss.nodes[k];
      const Real w = 2 * u * gauss.weights[i] * gauss.weights[k];
      rule.nodes.push_back({{static_cast<T>(a), static_cast<T>(b), static_cast<T>(c)},
                            {static_cast<T>(b * c), static_cast<T>(c * a), static_cast<T>(a * b)},
                            {static_cast<T>(w * a), static_cast<T>(w * b), static_cast<T>(w * c)}});
    }
  }
  return rule;
}

/// The distances were measured: in each case the worst of 90 triangles, slivers among them, errs by
/// 1e-16 (double) or 3e-8 (float) at most.
template <class T> std::vector<typename MeanValueTables<T>::Rule> make_rules();

template <> std::vector<MeanValueTables<double>::Rule> make_rules<double>() {
  return {make_rule<double>(4, 1000), make_rule<double>(5, 100), make_rule<double>(6, 35),
          make_rule<double>(7, 16),   make_rule<double>(8, 10),  make_rule<double>(10, 6),
          make_rule<double>(12, 4),   make_rule<double>(13, 3)};
}
template <> std::vector<MeanValueTables<float>::Rule> make_rules<float>() {
  return {make_rule<float>(3, 50), make_rule<float>(4, 15), make_rule<float>(5, 7),
          make_rule<float>(7, 3.5)};
}

/// What the kernel needs to know of the cage as a whole for points far outside.
template <class T> void prepare_outside(MeanValueTables<T>& tables) {
  tables.rules = make_rules<T>();
  Real largest2 = 0;
  for (const auto& vertex : tables.vertices) {
    largest2 = std::max<Real>(largest2, vertex.square);
  }
  tables.outside2 = static_cast<T>(largest2);
  std::array<Real, 4> flux{};
  Real area = 0;
  for (const auto& face : tables.faces) {
    const Real area2 = face.area2;
    for (std::size_t i = 0; i < 4; ++i) {
      flux[i] += face.delta[i] * area2 * area2 / 2;
    }
    area += area2 / 2;
  }
  for (std::size_t i = 0; i < 3; ++i) { // no flux but for the volume through a closed surface
    flux[i] = std::abs(flux[i]) < 1e-13L * area ? 0 : flux[i];
  }
  std::ranges::transform(flux, tables.flux.begin(), [](Real x) { return static_cast<T>(x); });
  tables.least_flux = static_cast<T>(1e-11L * area * std::sqrt(largest2));
}

template <class T>
typename MeanValueTables<T>::Edge make_edge(Index from, Index to, std::span<const Vec3> positions) {
  const RealVec3 edge = positions[to].cast<Real>() - positions[from].cast<Real>();
  return {from,
          to,
          static_cast<T>(edge.norm()),
          static_cast<T>(edge.x()),
          static_cast<T>(edge.y()),
          static_cast<T>(edge.z())};
}

template <class T>
MeanValueTables<T> make_tables(std::span<const Vec3> positions,
                               std::span<const Triangle> triangles) {
  MeanValueTables<T> tables;
  for (const Vec3& p : positions) {
    const Eigen::Matrix<T, 3, 1> stored = p.cast<T>();
    tables.vertices.push_back(make_vertex<T>(stored.template cast<Real>()));
  }
  // The rounded corners are the cage: planes must be those of the corners as they are stored.
  std::vector<Vec3> rounded;
  for (const auto& v : tables.vertices) {
    rounded.emplace_back(v.x, v.y, v.z);
  }
  std::vector<Triangle> kept;
  for (const Triangle& t : triangles) {
    if (!is_degenerate(rounded[t[0]].cast<Real>(), rounded[t[1]].cast<Real>(),
                       rounded[t[2]].cast<Real>())) {
      kept.push_back(t);
      tables.faces.push_back(make_face<T>(t, rounded));
    }
  }
  const std::vector<EdgeUse> uses = edge_uses(kept);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == 0 || !uses[i].same_edge(uses[i - 1])) {
      tables.edges.push_back(make_edge<T>(uses[i].from, uses[i].to, rounded));
    }
    tables.faces[uses[i].triangle].edges[uses[i].opposite] =
        static_cast<Index>(tables.edges.size() - 1);
  }
  prepare_outside(tables);
  return tables;
}

std::vector<std::uint8_t> used_vertices(TriangleView cage) {
  std::vector<std::uint8_t> used(cage.positions.size(), 0);
  for (const Triangle& t : cage.triangles) {
    for (const Index v : t) {
      used[v] = 1;
    }
  }
  return used;
}

/// A cage whose quads are cut into four triangles round a vertex in their middle.
struct CageWithMiddles {
  TriangleMesh mesh;
  std::vector<std::array<Index, 4>> quads;
};

CageWithMiddles add_middles(const PolygonMesh& cage) {
  CageWithMiddles result;
  result.mesh.positions = cage.positions;
  const Triangulation triangulation = triangulate(cage);
  for (std::size_t t = 0; t < triangulation.triangles.size(); ++t) {
    if (cage.face(triangulation.face_of[t]).size() != 4) {
      result.mesh.triangles.push_back(triangulation.triangles[t]);
    }
  }
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    const std::span<const Index> corners = cage.face(f);
    if (corners.size() != 4) {
      continue;
    }
    const auto middle = static_cast<Index>(result.mesh.positions.size());
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      sum += cage.positions[corners[i]];
      result.mesh.triangles.push_back({corners[i], corners[(i + 1) % 4], middle});
    }
    result.mesh.positions.emplace_back(sum / 4);
    result.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
  }
  return result;
}

Result<std::shared_ptr<const MeanValueSolver::Tables>>
prepare(TriangleView cage, std::size_t cage_vertices, std::vector<std::array<Index, 4>> quads,
        const MeanValueOptions& options) {
  if (Status status = check(cage, options); !status) {
    return status.error();
  }
  const Box3 box = bounding_box(cage);
  if (!(box.diagonal().norm() > 0) || !std::isfinite(box.diagonal().norm())) {
    return Error{ErrorCode::invalid_cage, "the cage has no extent"};
  }
  auto tables = std::make_shared<MeanValueSolver::Tables>();
  tables->center = box.center();
  tables->scale = std::ldexp(1.0, -std::ilogb(box.diagonal().norm()) - 1);
  tables->cage_vertices = cage_vertices;
  tables->quads = std::move(quads);
  tables->used = used_vertices(cage);
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < cage.positions.size(); ++v) {
    // A vertex without faces may be anywhere, even at infinity.
    positions.emplace_back(tables->used[v] != 0
                               ? Vec3((cage.positions[v] - tables->center) * tables->scale)
                               : Vec3::Zero());
  }
  tables->in_double = make_tables<double>(positions, cage.triangles);
  tables->in_float = make_tables<float>(positions, cage.triangles);
  if (tables->in_double.faces.empty()) {
    return Error{ErrorCode::invalid_cage, "the faces of the cage have no area"};
  }
  return std::shared_ptr<const MeanValueSolver::Tables>(std::move(tables));
}

/// Up to 16 points in the cage's frame; the last one is repeated to fill the tile.
template <class T>
PointTile<T> load_points(const MeanValueSolver::Tables& cage, std::span<const Vec3> points) {
  PointTile<T> tile;
  for (std::size_t i = 0; i < 16; ++i) {
    const Vec3 p = (points[std::min(i, points.size() - 1)] - cage.center) * cage.scale;
    tile.x[i] = static_cast<T>(p.x());
    tile.y[i] = static_cast<T>(p.y());
    tile.z[i] = static_cast<T>(p.z());
  }
  return tile;
}

/// The weights of sixteen points, of which only so many count: the others become 0.
template <class T, class Out>
TileReport solve_some(const MeanValueSolver::Tables& cage, std::span<const Vec3> points,
                      std::span<Out> weights, std::size_t stride) {
  assert(points.size() <= 16 && stride >= 16);
  assert(weights.size() >= (cage.cage_vertices - 1) * stride + 16);
  TileReport report;
  if (!points.empty()) {
    report = mean_value_tile(cage, load_points<T>(cage, points),
                             WeightsOut<Out>{weights.data(), stride});
  }
  if (points.size() < 16) {
    for (std::size_t c = 0; c < cage.cage_vertices; ++c) {
      const std::span<Out> all = weights.subspan(c * stride, 16);
      std::ranges::fill(all.subspan(points.size()), Out(0));
    }
    const unsigned kept = (1U << points.size()) - 1;
    report.on_surface = static_cast<std::uint16_t>(report.on_surface & kept);
    report.undefined = static_cast<std::uint16_t>(report.undefined & kept);
  }
  return report;
}

} // namespace

Result<MeanValueSolver> MeanValueSolver::create(TriangleView cage,
                                                const MeanValueOptions& options) {
  auto tables = prepare(cage, cage.positions.size(), {}, options);
  if (!tables) {
    return tables.error();
  }
  return MeanValueSolver(*tables);
}

Result<MeanValueSolver> MeanValueSolver::create(const PolygonMesh& cage,
                                                const MeanValueOptions& options) {
  if (options.quads == QuadTreatment::diagonal) {
    return create(TriangleView(to_triangle_mesh(cage)), options);
  }
  CageWithMiddles cut = add_middles(cage);
  auto tables = prepare(cut.mesh, cage.positions.size(), std::move(cut.quads), options);
  if (!tables) {
    return tables.error();
  }
  return MeanValueSolver(*tables);
}

std::size_t MeanValueSolver::cage_vertices() const {
  return tables_->cage_vertices;
}

TileReport MeanValueSolver::solve(std::span<const Vec3> points, std::span<double> weights,
                                  std::size_t stride) const {
  return solve_some<double>(*tables_, points, weights, stride);
}

TileReport MeanValueSolver::solve(std::span<const Vec3> points, std::span<float> weights,
                                  std::size_t stride) const {
  return solve_some<double>(*tables_, points, weights, stride);
}

TileReport MeanValueSolver::preview(std::span<const Vec3> points, std::span<float> weights,
                                    std::size_t stride) const {
  return solve_some<float>(*tables_, points, weights, stride);
}

template <class T>
Result<SolvedWeights<T>> solve_all(const MeanValueSolver& solver, std::span<const Vec3> points,
                                   const Progress& progress) {
  SolvedWeights<T> solved{{points.size(), solver.cage_vertices()}};
  std::mutex reporting;
  std::size_t finished = 0;
  // A few hundred microseconds between two looks at the stop token.
  constexpr std::size_t block = 128;
  static_assert(WeightTiles<T>::tile_points % block == 0);
  const std::size_t blocks = (points.size() + block - 1) / block;
  parallel_for(0, blocks, 1, [&](std::size_t b) {
    if (progress.cancelled()) {
      return;
    }
    int on_surface = 0;
    int undefined = 0;
    const std::size_t end = std::min((b + 1) * block, points.size());
    for (std::size_t first = b * block; first < end; first += 16) {
      const TileReport report =
          solver.solve(points.subspan(first, std::min<std::size_t>(16, end - first)),
                       solved.weights.from(first), WeightTiles<T>::tile_points);
      on_surface += std::popcount(report.on_surface);
      undefined += std::popcount(report.undefined);
    }
    const std::scoped_lock lock(reporting);
    solved.on_surface += static_cast<std::size_t>(on_surface);
    solved.undefined += static_cast<std::size_t>(undefined);
    progress(static_cast<double>(++finished) / static_cast<double>(blocks), "bind");
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  solved.weights.fill_up();
  return solved;
}

template Result<SolvedWeights<double>> solve_all(const MeanValueSolver&, std::span<const Vec3>,
                                                 const Progress&);
template Result<SolvedWeights<float>> solve_all(const MeanValueSolver&, std::span<const Vec3>,
                                                const Progress&);

namespace {

template <class Cage>
Result<Weights> coordinates_in(const Cage& cage, std::span<const Vec3> points,
                               const MeanValueOptions& options, const Progress& progress) {
  const Result<MeanValueSolver> solver = MeanValueSolver::create(cage, options);
  if (!solver) {
    return solver.error();
  }
  Result<SolvedWeights<double>> solved = solve_all<double>(*solver, points, progress);
  if (!solved) {
    return solved.error();
  }
  return std::move(solved->weights);
}

} // namespace

Result<Weights> mean_value_coordinates(TriangleView cage, std::span<const Vec3> points,
                                       const MeanValueOptions& options, const Progress& progress) {
  return coordinates_in(cage, points, options, progress);
}

Result<Weights> mean_value_coordinates(const PolygonMesh& cage, std::span<const Vec3> points,
                                       const MeanValueOptions& options, const Progress& progress) {
  return coordinates_in(cage, points, options, progress);
}

} // namespace cagewright
