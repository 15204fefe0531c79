// Bounded biharmonic weights. With K the stiffness matrix of linear elements and M the masses, of
// the rows of all vertices, those on the cage included (which is what makes the weights flat across
// it), each weight minimises w . K M^-1 K w between 0 and 1, with its hat on the cage.
//
// The bounds are kept by alternating directions (Boyd et al. 2011): a linear system, the same for
// all weights and steps, and clipping. What a violation costs falls with the fourth power of the
// distance from the cage, as the system itself does, so that thin limbs and the trunk converge
// alike.

#include <cagewright/coordinates/bounded_biharmonic.h>

#include "coordinates/inside_mesh.h"
#include "coordinates/similarity_columns.h"
#include "coordinates/surface_coordinates.h"
#include "core/maths.h"
#include "core/parallel.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <hwy/highway.h>

#include "coordinates/triangle_integrals-inl.h"

namespace cagewright {
namespace {

namespace scalar = HWY_NAMESPACE;

using Sparse = Eigen::SparseMatrix<double>;

constexpr std::size_t lanes = 16; ///< weights that are solved for side by side

/// n rows of sixteen numbers.
using Block = std::vector<std::array<double, lanes>>;

/// A Cholesky factor applied to sixteen right sides at once.
class BlockSolver {
public:
  /// Errors: none; a matrix that is not positive gives numbers that are none.
  explicit BlockSolver(const Sparse& matrix) {
    const Eigen::SimplicialLDLT<Sparse, Eigen::Lower> factor(matrix);
    lower_ = factor.matrixL();
    lower_.makeCompressed();
    inverse_diagonal_ = factor.vectorD().cwiseInverse();
    order_ = factor.permutationP().indices();
  }

  void solve(Block& sides, Block& room) const {
    const auto count = static_cast<std::size_t>(lower_.cols());
    room.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      room[static_cast<std::size_t>(order_[static_cast<Eigen::Index>(i)])] = sides[i];
    }
    const int* const starts = lower_.outerIndexPtr();
    const int* const rows = lower_.innerIndexPtr();
    const double* const values = lower_.valuePtr();
    for (std::size_t j = 0; j < count; ++j) {
      const std::array<double, lanes> own = room[j];
      for (int p = starts[j]; p < starts[j + 1]; ++p) {
        const auto row = static_cast<std::size_t>(rows[p]);
        if (row > j) {
          for (std::size_t k = 0; k < lanes; ++k) {
            room[row][k] -= values[p] * own[k];
          }
        }
      }
    }
    for (std::size_t j = count; j-- > 0;) {
      std::array<double, lanes> own = room[j];
      for (double& x : own) {
        x *= inverse_diagonal_[static_cast<Eigen::Index>(j)];
      }
      for (int p = starts[j]; p < starts[j + 1]; ++p) {
        const auto row = static_cast<std::size_t>(rows[p]);
        if (row > j) {
          for (std::size_t k = 0; k < lanes; ++k) {
            own[k] -= values[p] * room[row][k];
          }
        }
      }
      room[j] = own;
    }
    for (std::size_t i = 0; i < count; ++i) {
      sides[i] = room[static_cast<std::size_t>(order_[static_cast<Eigen::Index>(i)])];
    }
  }

private:
  Sparse lower_; // ones on the diagonal
  Eigen::VectorXd inverse_diagonal_;
  Eigen::VectorXi order_;
};

/// The weights of every point of a mesh: those of C vertices at [p * C + c].
class WeightSolver {
public:
  WeightSolver(const Surface& surface, const InsideMesh& mesh)
      : surface_(surface), mesh_(mesh), on_cage_(mesh.on_cage.size()),
        inner_(mesh.positions.size() - on_cage_), masses_(mesh.positions.size(), 0.0),
        weights_(mesh.positions.size() * surface.cage_vertices, 0.0) {}

  /// Errors: cancelled, invalid_cage.
  Result<std::vector<double>> solve(const Progress& progress) {
    put_hats();
    if (inner_ == 0) {
      return std::move(weights_);
    }
    assemble();
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    const std::size_t blocks = (surface_.cage_vertices + lanes - 1) / lanes;
    const BlockSolver solver(with_costs());
    progress(0.3, "bind");
    std::mutex reporting;
    std::size_t finished = 0;
    parallel_for(0, blocks, 1, [&](std::size_t b) {
      solve_block(b * lanes, solver, progress);
      const std::scoped_lock lock(reporting);
      progress(0.3 + 0.7 * static_cast<double>(++finished) / static_cast<double>(blocks), "bind");
    });
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    if (!std::all_of(weights_.begin(), weights_.end(), [](double w) { return std::isfinite(w); })) {
      return Error{
          ErrorCode::invalid_cage,
          "bounded biharmonic weights of this cage do not come out: its faces are too thin "
          "or too sharply folded; make its triangles rounder, or take mean_value "
          "coordinates"};
    }
    normalize();
    return std::move(weights_);
  }

private:
  [[nodiscard]] double* row(std::size_t point) {
    return weights_.data() + point * surface_.cage_vertices;
  }

  void put_hats() {
    std::vector<double> all(surface_.positions.size());
    for (std::size_t p = 0; p < on_cage_; ++p) {
      std::fill(all.begin(), all.end(), 0.0);
      const CagePlace& place = mesh_.on_cage[p];
      for (std::size_t i = 0; i < 3; ++i) {
        all[surface_.faces[place.face].vertices[i]] += place.hats[i];
      }
      surface_.share_middles(std::span(all));
      std::copy_n(all.begin(), surface_.cage_vertices, row(p));
    }
  }

  /// K and M.
  void assemble() {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(16 * mesh_.cells.size());
    for (const std::array<Index, 4>& cell : mesh_.cells) {
      Mat3 edges;
      for (int k = 0; k < 3; ++k) {
        edges.col(k) =
            mesh_.positions[cell[static_cast<std::size_t>(k) + 1]] - mesh_.positions[cell[0]];
      }
      const double volume = std::abs(edges.determinant()) / 6;
      const Mat3 inverse = edges.inverse(); // rows: the gradients of corners 1, 2, 3
      std::array<Vec3, 4> gradient;
      gradient[0] = Vec3::Zero();
      for (int k = 0; k < 3; ++k) {
        gradient[static_cast<std::size_t>(k) + 1] = inverse.row(k).transpose();
        gradient[0] -= inverse.row(k).transpose();
      }
      for (std::size_t i = 0; i < 4; ++i) {
        masses_[cell[i]] += volume / 4;
        for (std::size_t j = 0; j < 4; ++j) {
          entries.emplace_back(static_cast<int>(cell[i]), static_cast<int>(cell[j]),
                               volume * gradient[i].dot(gradient[j]));
        }
      }
    }
    const auto count = static_cast<int>(mesh_.positions.size());
    stiffness_ = Sparse(count, count);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Of inner points K M^-1 K, and what a violation of the bounds costs.
  Sparse with_costs() {
    const auto first = static_cast<Eigen::Index>(on_cage_);
    const auto count = static_cast<Eigen::Index>(inner_);
    Sparse scaled = stiffness_.middleCols(first, count);
    for (Eigen::Index c = 0; c < count; ++c) {
      for (Sparse::InnerIterator it(scaled, c); it; ++it) {
        it.valueRef() /= masses_[static_cast<std::size_t>(it.row())];
      }
    }
    Sparse energy = Sparse(stiffness_.middleCols(first, count).transpose()) * scaled;
    const std::vector<Triangle> triangles = surface_.triangles();
    const TriangleBvh bvh(TriangleView{surface_.positions, triangles});
    costs_.resize(inner_);
    parallel_for(0, inner_, 64, [&](std::size_t i) {
      constexpr double cost = 16;
      const double depth = bvh.nearest(mesh_.positions[on_cage_ + i]).distance;
      costs_[i] = cost * masses_[on_cage_ + i] / maths::square(maths::square(depth));
    });
    for (Eigen::Index c = 0; c < count; ++c) {
      energy.coeffRef(c, c) += costs_[static_cast<std::size_t>(c)];
    }
    return energy;
  }

  /// -K M^-1 K (the hats on the cage), of inner points.
  [[nodiscard]] Block sides(std::size_t first, std::size_t count) {
    Block laplacian(mesh_.positions.size(), std::array<double, lanes>{});
    for (std::size_t c = 0; c < on_cage_; ++c) {
      const double* const hats = row(c) + first;
      for (Sparse::InnerIterator it(stiffness_, static_cast<Eigen::Index>(c)); it; ++it) {
        std::array<double, lanes>& to = laplacian[static_cast<std::size_t>(it.row())];
        for (std::size_t k = 0; k < count; ++k) {
          to[k] += it.value() * hats[k];
        }
      }
    }
    Block result(inner_, std::array<double, lanes>{});
    for (std::size_t i = 0; i < inner_; ++i) {
      for (Sparse::InnerIterator it(stiffness_, static_cast<Eigen::Index>(on_cage_ + i)); it;
           ++it) {
        const auto r = static_cast<std::size_t>(it.row());
        for (std::size_t k = 0; k < lanes; ++k) {
          result[i][k] -= it.value() / masses_[r] * laplacian[r][k];
        }
      }
    }
    return result;
  }

  void solve_block(std::size_t first, const BlockSolver& solver, const Progress& progress) {
    constexpr int most_steps = 500;
    constexpr double close = 1e-4;
    constexpr double relaxed = 1.6;
    const std::size_t count = std::min(lanes, surface_.cage_vertices - first);
    const Block side = sides(first, count);
    Block bounded(inner_, std::array<double, lanes>{});
    Block pull = bounded; // what the bounds have asked for so far
    Block free = side;
    Block room;
    for (int step = 0; step < most_steps && !progress.cancelled(); ++step) {
      for (std::size_t i = 0; i < inner_; ++i) {
        for (std::size_t k = 0; k < lanes; ++k) {
          free[i][k] = side[i][k] + costs_[i] * (bounded[i][k] - pull[i][k]);
        }
      }
      solver.solve(free, room);
      double off = 0;
      for (std::size_t i = 0; i < inner_; ++i) {
        for (std::size_t k = 0; k < lanes; ++k) {
          const double before = bounded[i][k];
          const double ahead = relaxed * free[i][k] + (1 - relaxed) * before + pull[i][k];
          bounded[i][k] = std::clamp(ahead, 0.0, 1.0);
          pull[i][k] = ahead - bounded[i][k];
          off = std::max(
              {off, std::abs(free[i][k] - bounded[i][k]), std::abs(bounded[i][k] - before)});
        }
      }
      if (off < close) {
        break;
      }
    }
    for (std::size_t i = 0; i < inner_; ++i) {
      std::copy_n(bounded[i].begin(), count, row(on_cage_ + i) + first);
    }
  }

  void normalize() {
    for (std::size_t p = 0; p < mesh_.positions.size(); ++p) {
      const double sum = std::accumulate(row(p), row(p) + surface_.cage_vertices, 0.0);
      for (std::size_t c = 0; c < surface_.cage_vertices; ++c) {
        row(p)[c] /= sum;
      }
    }
  }

  const Surface& surface_;
  const InsideMesh& mesh_;
  std::size_t on_cage_;
  std::size_t inner_;
  std::vector<double> masses_;
  Sparse stiffness_;
  std::vector<double> costs_;
  std::vector<double> weights_;
};

/// In which tetrahedron a point is.
class CellFinder {
public:
  /// Corners of the mesh and what they weigh; unused ones weigh 0.
  struct Place {
    std::array<Index, 4> corners{};
    std::array<double, 4> shares{};
    double distance = 0; ///< beside the mesh
  };

  CellFinder(const InsideMesh& mesh, double spacing) : mesh_(&mesh), step_(1.5 * spacing) {
    box_ = bounding_box(mesh.positions);
    for (int axis = 0; axis < 3; ++axis) {
      count_[static_cast<std::size_t>(axis)] =
          static_cast<std::size_t>(box_.sizes()[axis] / step_) + 1;
    }
    starts_.assign(count_[0] * count_[1] * count_[2] + 1, 0);
    each_bin([&](std::size_t bin, std::size_t) { ++starts_[bin + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    cells_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    each_bin(
        [&](std::size_t bin, std::size_t cell) { cells_[next[bin]++] = static_cast<Index>(cell); });
    find_faces();
  }

  [[nodiscard]] Place find(const Vec3& x) const {
    constexpr double rounding = 1e-12;
    const std::array<std::size_t, 3> at = bin_of(x);
    const std::size_t bin = (at[0] * count_[1] + at[1]) * count_[2] + at[2];
    for (std::size_t i = starts_[bin]; i < starts_[bin + 1]; ++i) {
      const std::array<Index, 4>& cell = mesh_->cells[cells_[i]];
      const Vec3& origin = mesh_->positions[cell[0]];
      const Vec3 a = mesh_->positions[cell[1]] - origin;
      const Vec3 b = mesh_->positions[cell[2]] - origin;
      const Vec3 c = mesh_->positions[cell[3]] - origin;
      const Vec3 p = x - origin;
      const double whole = a.cross(b).dot(c);
      Place place{cell, {}, 0};
      place.shares[1] = p.cross(b).dot(c) / whole;
      place.shares[2] = a.cross(p).dot(c) / whole;
      place.shares[3] = a.cross(b).dot(p) / whole;
      place.shares[0] = 1 - place.shares[1] - place.shares[2] - place.shares[3];
      if (*std::min_element(place.shares.begin(), place.shares.end()) >= -rounding) {
        return clamped(place);
      }
    }
    return beside(x);
  }

private:
  [[nodiscard]] std::array<std::size_t, 3> bin_of(const Vec3& x) const {
    std::array<std::size_t, 3> bin{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double place =
          std::clamp((x[axis] - box_.min()[axis]) / step_, 0.0, static_cast<double>(count_[a] - 1));
      bin[a] = static_cast<std::size_t>(place);
    }
    return bin;
  }

  template <class Visit> void each_bin(const Visit& visit) const {
    for (std::size_t c = 0; c < mesh_->cells.size(); ++c) {
      Box3 box;
      for (const Index v : mesh_->cells[c]) {
        box.extend(mesh_->positions[v]);
      }
      const auto low = bin_of(box.min());
      const auto high = bin_of(box.max());
      for (std::size_t i = low[0]; i <= high[0]; ++i) {
        for (std::size_t j = low[1]; j <= high[1]; ++j) {
          for (std::size_t k = low[2]; k <= high[2]; ++k) {
            visit((i * count_[1] + j) * count_[2] + k, c);
          }
        }
      }
    }
  }

  /// Those of one tetrahedron only.
  void find_faces() {
    std::vector<Triangle> faces;
    for (const std::array<Index, 4>& cell : mesh_->cells) {
      for (std::size_t i = 0; i < 4; ++i) {
        Triangle face = {cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
        std::sort(face.begin(), face.end());
        faces.push_back(face);
      }
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (i + 1 < faces.size() && faces[i] == faces[i + 1]) {
        ++i;
      } else {
        faces_.push_back(faces[i]);
      }
    }
    bvh_ = TriangleBvh(TriangleView{mesh_->positions, faces_});
  }

  [[nodiscard]] Place beside(const Vec3& x) const {
    const NearestPoint nearest = bvh_.nearest(x);
    const Triangle& face = faces_[nearest.triangle];
    Place place{{face[0], face[1], face[2], face[0]}, {}, nearest.distance};
    const Vec3 a = mesh_->positions[face[1]] - mesh_->positions[face[0]];
    const Vec3 b = mesh_->positions[face[2]] - mesh_->positions[face[0]];
    const Vec3 p = nearest.point - mesh_->positions[face[0]];
    const Vec3 normal = a.cross(b);
    place.shares[1] = p.cross(b).dot(normal) / normal.squaredNorm();
    place.shares[2] = a.cross(p).dot(normal) / normal.squaredNorm();
    place.shares[0] = 1 - place.shares[1] - place.shares[2];
    return clamped(place);
  }

  static Place clamped(Place place) {
    double sum = 0;
    for (double& share : place.shares) {
      share = std::max(share, 0.0);
      sum += share;
    }
    for (double& share : place.shares) {
      share /= sum;
    }
    return place;
  }

  const InsideMesh* mesh_;
  double step_;
  Box3 box_;
  std::array<std::size_t, 3> count_{};
  std::vector<std::size_t> starts_; // of each bin in cells_
  std::vector<Index> cells_;
  std::vector<Triangle> faces_; // the boundary of the mesh
  TriangleBvh bvh_;
};

class BoundedBiharmonicCoordinates : public SurfaceCoordinates {
public:
  BoundedBiharmonicCoordinates(std::shared_ptr<const SimilarityColumns> rule, Surface surface,
                               OutsideTreatment outside, InsideMesh mesh, double spacing,
                               std::vector<double> weights)
      : SurfaceCoordinates(rule, std::move(surface), outside), columns_(std::move(rule)),
        mesh_(std::move(mesh)), finder_(mesh_, spacing), weights_(std::move(weights)) {}

  [[nodiscard]] double error_estimate() const override { return estimate_; }
  void set_estimate(double estimate) { estimate_ = estimate; }

  /// The weights of the cage's vertices at a point of the frame that is inside.
  /// \returns how far beside the tetrahedra it is
  double weights_inside(const Vec3& x, std::span<double> weights) const {
    const CellFinder::Place place = finder_.find(x);
    for (std::size_t k = 0; k < 4; ++k) {
      const double* const of_corner = weights_.data() + place.corners[k] * weights.size();
      for (std::size_t c = 0; c < weights.size(); ++c) {
        weights[c] += place.shares[k] * of_corner[c];
      }
    }
    return place.distance;
  }

  [[nodiscard]] const InsideMesh& mesh() const { return mesh_; }

  [[nodiscard]] const double* weights_of(std::size_t point) const {
    return weights_.data() + point * surface().cage_vertices;
  }

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    TileReport report;
    for (std::size_t i = 0; i < points.size(); ++i) {
      std::vector<double> own = scalar::weights_with_care(
          surface(), points[i], i, scalar::on_cage, report,
          [&](const scalar::PointTerms& point, std::vector<double>& of_vertices) {
            fill_inside(points[i], point, of_vertices);
            return true;
          });
      scalar::put_vertices_of(surface(), own, weights, stride, i);
      const bool has_weights = ((report.undefined | report.outside) >> i & 1U) == 0;
      const Vec3 x = points[i] / surface().frame.scale + surface().frame.center;
      const Vec3 position = has_weights ? columns_->of_point(x) : Vec3(Vec3::Zero());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        weights[(surface().cage_vertices + axis) * stride + i] =
            position[static_cast<Eigen::Index>(axis)];
      }
    }
    return report;
  }

  void fill_inside(const Vec3& x, const scalar::PointTerms& point,
                   std::vector<double>& weights) const {
    const double beside = weights_inside(x, std::span(weights).first(surface().cage_vertices));
    if (beside > 0) {
      lead_to_cage(point, beside, weights);
    }
  }

  /// Between the tetrahedra and the cage, from the ones to the other.
  void lead_to_cage(const scalar::PointTerms& point, double beside,
                    std::vector<double>& weights) const {
    std::size_t nearest = 0;
    for (std::size_t f = 0; f < surface().faces.size(); ++f) {
      nearest = point.face_distance(f) < point.face_distance(nearest) ? f : nearest;
    }
    const double share = beside / (beside + point.face_distance(nearest));
    std::vector<double> there(surface().positions.size(), 0.0);
    const std::array<double, 3> hats = scalar::hats_on(point, nearest);
    for (std::size_t i = 0; i < 3; ++i) {
      there[surface().faces[nearest].vertices[i]] = hats[i];
    }
    surface().share_middles(std::span(there));
    for (std::size_t c = 0; c < surface().cage_vertices; ++c) {
      weights[c] += share * (there[c] - weights[c]);
    }
  }

  std::shared_ptr<const SimilarityColumns> columns_;
  InsideMesh mesh_;
  CellFinder finder_;
  std::vector<double> weights_;
  double estimate_ = 0;
};

constexpr std::size_t usual_points = 7000;
constexpr std::size_t first_points = 1000; ///< where an accuracy says when they suffice
constexpr std::size_t most_points = 20000;
/// Of the points of one mesh and those of the next coarser.
constexpr double coarser = 2.5;

Result<std::shared_ptr<BoundedBiharmonicCoordinates>>
made_of(const PolygonMesh& cage, const Surface& surface, OutsideTreatment outside,
        std::size_t points, const Progress& progress) {
  const double spacing = spacing_for(surface, points);
  Result<InsideMesh> mesh = inside_mesh(surface, spacing, progress.part(0, 0.3));
  if (!mesh) {
    return mesh.error();
  }
  Result<std::vector<double>> weights = WeightSolver(surface, *mesh).solve(progress.part(0.3, 1));
  if (!weights) {
    return weights.error();
  }
  return std::make_shared<BoundedBiharmonicCoordinates>(
      std::make_shared<SimilarityColumns>(cage.positions), surface, outside, *std::move(mesh),
      spacing, *std::move(weights));
}

/// The greatest difference of weights at the points of the finer mesh.
double difference(const BoundedBiharmonicCoordinates& coarse,
                  const BoundedBiharmonicCoordinates& fine, std::size_t vertices) {
  const std::vector<Vec3>& points = fine.mesh().positions;
  const std::size_t first = fine.mesh().on_cage.size();
  return parallel_reduce_ordered(
      first, points.size(), 64, 0.0,
      [&](std::size_t begin, std::size_t end) {
        double most = 0;
        std::vector<double> other(vertices);
        for (std::size_t p = begin; p < end; ++p) {
          std::fill(other.begin(), other.end(), 0.0);
          coarse.weights_inside(points[p], other);
          for (std::size_t c = 0; c < vertices; ++c) {
            most = std::max(most, std::abs(other[c] - fine.weights_of(p)[c]));
          }
        }
        return most;
      },
      [](double& a, double b) { a = std::max(a, b); });
}

constexpr std::array<const CoordinateOption*, 3> kind_options = {&quads_option, &outside_option,
                                                                 &accuracy_option};

Result<std::shared_ptr<const Coordinates>> prepare_kind(const PolygonMesh& cage,
                                                        const CoordinateSettings& settings,
                                                        const Progress& progress) {
  Result<BoundedBiharmonicOptions> options = options_inside<BoundedBiharmonicOptions>(settings);
  if (!options) {
    return options.error();
  }
  options->accuracy = settings.number(accuracy_option);
  return bounded_biharmonic_coordinates(cage, *options, progress);
}

Result<std::shared_ptr<const ColumnRule>> rule_of_kind(const PolygonMesh& cage,
                                                       const CoordinateSettings&) {
  return std::shared_ptr<const ColumnRule>(std::make_shared<SimilarityColumns>(cage.positions));
}

} // namespace

Result<std::shared_ptr<const Coordinates>>
bounded_biharmonic_coordinates(const PolygonMesh& cage, const BoundedBiharmonicOptions& options,
                               const Progress& progress) {
  const Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  std::size_t points = options.points > 0     ? options.points
                       : options.accuracy > 0 ? first_points
                                              : usual_points;
  const auto made_at = [&](std::size_t count, const Progress& share) {
    return made_of(cage, *surface, options.outside, count, share);
  };
  const auto fewer = static_cast<std::size_t>(static_cast<double>(points) / coarser);
  Result<std::shared_ptr<BoundedBiharmonicCoordinates>> coarse =
      made_at(fewer, progress.part(0, 0.2));
  for (double done = 0.2;; done = 1 - (1 - done) / 4) {
    if (!coarse) {
      return coarse.error();
    }
    const bool is_last = options.accuracy <= 0 ||
                         static_cast<double>(points) * coarser > static_cast<double>(most_points);
    Result<std::shared_ptr<BoundedBiharmonicCoordinates>> fine =
        made_at(points, progress.part(done, is_last ? 1 : 1 - (1 - done) / 4));
    if (!fine) {
      return fine.error();
    }
    (*fine)->set_estimate(difference(**coarse, **fine, surface->cage_vertices));
    if (is_last || (*fine)->error_estimate() <= options.accuracy) {
      progress(1, "bind");
      return std::shared_ptr<const Coordinates>(*std::move(fine));
    }
    points = static_cast<std::size_t>(static_cast<double>(points) * coarser);
    coarse = std::move(fine);
  }
}

constinit const CoordinateKind bounded_biharmonic_kind = {
    .name = "bounded_biharmonic",
    .idea = "smooth, between 0 and 1, and flat at the cage: parts of the model near a vertex go "
            "with it as they are",
    .quads = "center or diagonal",
    .sign = "from 0 to 1",
    .reproduces = "similarities",
    .on_cage = "interpolates, and is flat across it",
    .outside = "refused, or at rest",
    .locality = "local",
    .made_by = "tetrahedra, least energy within bounds",
    .cost = "some seconds for the cage, then 100 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = rule_of_kind,
};

} // namespace cagewright
