#include <cagewright/coordinates/mean_value.h>

#include "coordinates/mean_value_tables.h"
#include "coordinates/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

using Real = long double; // the tables are rounded once, when they are stored
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

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
  std::transform(flux.begin(), flux.end(), tables.flux.begin(),
                 [](Real x) { return static_cast<T>(x); });
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
    if (!is_degenerate<RealVec3>(rounded[t[0]].cast<Real>(), rounded[t[1]].cast<Real>(),
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

Result<std::shared_ptr<const MeanValueSolver::Tables>>
prepare(TriangleView cage, std::size_t cage_vertices, std::vector<std::array<Index, 4>> quads,
        const MeanValueOptions& options) {
  if (Status status = check_surface(cage, options.allow_open); !status) {
    return status.error();
  }
  const Result<CageFrame> frame = frame_of(cage);
  if (!frame) {
    return frame.error();
  }
  auto tables = std::make_shared<MeanValueSolver::Tables>();
  tables->center = frame->center;
  tables->scale = frame->scale;
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
      std::fill(all.subspan(points.size()).begin(), all.subspan(points.size()).end(), Out(0));
    }
    const unsigned kept = (1U << points.size()) - 1;
    report.on_surface = static_cast<std::uint16_t>(report.on_surface & kept);
    report.undefined = static_cast<std::uint16_t>(report.undefined & kept);
  }
  return report;
}

} // namespace

MeanValueSolver::MeanValueSolver(std::shared_ptr<const Tables> tables, std::span<const Vec3> cage)
    : Coordinates(vertex_columns(cage)), tables_(std::move(tables)) {}

Result<MeanValueSolver> MeanValueSolver::create(TriangleView cage,
                                                const MeanValueOptions& options) {
  auto tables = prepare(cage, cage.positions.size(), {}, options);
  if (!tables) {
    return tables.error();
  }
  return MeanValueSolver(*tables, cage.positions);
}

Result<MeanValueSolver> MeanValueSolver::create(const PolygonMesh& cage,
                                                const MeanValueOptions& options) {
  TriangulatedCage cut = triangulated(cage, options.quads);
  auto tables = prepare(cut.mesh, cage.positions.size(), std::move(cut.quads), options);
  if (!tables) {
    return tables.error();
  }
  return MeanValueSolver(*tables, cage.positions);
}

TileReport MeanValueSolver::solve_tile(std::span<const Vec3> points, std::span<double> weights,
                                       std::size_t stride) const {
  return solve_some<double>(*tables_, points, weights, stride);
}

TileReport MeanValueSolver::solve_tile(std::span<const Vec3> points, std::span<float> weights,
                                       std::size_t stride) const {
  return solve_some<double>(*tables_, points, weights, stride);
}

TileReport MeanValueSolver::preview(std::span<const Vec3> points, std::span<float> weights,
                                    std::size_t stride) const {
  return solve_some<float>(*tables_, points, weights, stride);
}

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

namespace {

constexpr std::array<const CoordinateOption*, 1> kind_options = {&quads_option};

Result<std::shared_ptr<const Coordinates>>
prepare_kind(const PolygonMesh& cage, const CoordinateSettings& settings, const Progress&) {
  Result<MeanValueSolver> solver = MeanValueSolver::create(
      cage, {.quads = static_cast<QuadTreatment>(settings.choice(quads_option)),
             .allow_open = settings.allow_open});
  if (!solver) {
    return solver.error();
  }
  return std::shared_ptr<const Coordinates>(
      std::make_shared<const MeanValueSolver>(*std::move(solver)));
}

Result<std::shared_ptr<const ColumnRule>> kind_rule(const PolygonMesh& cage,
                                                    const CoordinateSettings&) {
  return vertex_columns(cage.positions);
}

} // namespace

constinit const CoordinateKind mean_value_kind = {
    .name = "mean_value",
    .idea = "each vertex counts by how much of the view from the point it fills, near ones more",
    .quads = "center or diagonal",
    .sign = "positive and negative",
    .reproduces = "affine maps",
    .on_cage = "interpolates",
    .outside = "everywhere",
    .locality = "global",
    .made_by = "closed form",
    .cost = "5 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
