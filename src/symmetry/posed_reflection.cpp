#include "symmetry/posed_reflection.h"

#include "core/parallel.h"
#include "spatial/bvh.h"
#include "symmetry/limb_tips.h"
#include "symmetry/mirror_plane.h"
#include "symmetry/rigid_net.h"
#include "symmetry/surface_distances.h"
#include "symmetry/tip_pairings.h"
#include <cagewright/mesh/measures.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace cagewright {
namespace {

constexpr std::size_t most_tips = 10;
constexpr std::size_t most_pairings = 4;

/// What a map may differ from a symmetry by.
constexpr double most_stretch = 0.1;
constexpr double most_return_error = 0.03;
constexpr double most_uncovered = 0.02;

/// Of the diagonal: images farther along the surface are not near.
constexpr double near_image = 0.06;

using Sparse = Eigen::SparseMatrix<double>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Where a vertex is drawn to.
struct Draw {
  Vec3 to = Vec3::Zero();
  double weight = 0;
};

std::vector<Vec3> vertex_normals(std::span<const Vec3> positions,
                                 std::span<const Triangle> triangles) {
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Vec3 n = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
    for (const Index v : {a, b, c}) {
      normals[v] += n;
    }
  }
  return normals;
}

/// A mirror plane, and ends of limbs that are drawn together.
struct Guess {
  MirrorPlane plane;
  std::vector<std::array<Index, 2>> pairs; ///< of vertices: the first goes to the second
};

/// Lays the mirror image of a surface onto the surface.
class Laying {
public:
  Laying(const TriangleMesh& surface, const TriangleBvh& tree, const Guess& guess)
      : surface_(surface), tree_(tree), guess_(guess), image_(mirror_of(surface, guess.plane)),
        net_(image_), at_(image_.positions) {
    net_.add_matrix(matrix_);
  }

  std::vector<Vec3> run(const Progress& progress) {
    constexpr int pulled = 25;
    if (!guess_.pairs.empty()) {
      for (int k = 0; k < pulled && !progress.cancelled(); ++k) {
        draw(ends(drawing));
      }
    }
    // Where the weights are small the image slides along the surface to where it is bent least.
    struct Stage {
      double weight = 0;
      int rounds = 0;
    };
    constexpr std::array stages = {Stage{0.01, 10}, Stage{0.03, 10}, Stage{0.1, 10}, Stage{0.3, 4},
                                   Stage{1, 4}};
    double tips = drawing;
    for (const auto& [weight, rounds] : stages) {
      for (int round = 0; round < rounds && !progress.cancelled(); ++round) {
        std::vector<Draw> draws = ends(tips);
        add_nearest(draws, weight);
        draw(draws);
      }
      tips /= 4; // ends of limbs are where they are only roughly
    }
    return std::move(at_);
  }

private:
  static constexpr double drawing = 5; ///< the weight of a limb's end

  static TriangleMesh mirror_of(const TriangleMesh& surface, const MirrorPlane& plane) {
    TriangleMesh image = surface;
    for (Vec3& p : image.positions) {
      p = plane.mirrored(p);
    }
    for (Triangle& t : image.triangles) {
      std::swap(t[1], t[2]);
    }
    return image;
  }

  [[nodiscard]] std::vector<Draw> ends(double weight) const {
    std::vector<Draw> draws(at_.size());
    for (const auto& [from, to] : guess_.pairs) {
      draws[from] = {surface_.positions[to], weight};
    }
    return draws;
  }

  void add_nearest(std::vector<Draw>& draws, double weight) const {
    const std::vector<Vec3> normals = vertex_normals(at_, image_.triangles);
    parallel_for(0, at_.size(), 32, [&](std::size_t v) {
      const NearestPoint nearest = tree_.nearest(at_[v]);
      const Vec3(&t)[3] = tree_.corners(nearest.triangle);
      const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
      const double alike =
          normal.dot(normals[v]) / std::max(1e-300, normal.norm() * normals[v].norm());
      constexpr double facing_alike = 0.3;
      if (alike > facing_alike) {
        Draw& d = draws[v];
        const double both = d.weight + weight * alike;
        d.to = (d.weight * d.to + weight * alike * nearest.point) / both;
        d.weight = both;
      }
    });
  }

  void draw(const std::vector<Draw>& draws) {
    const std::vector<Vec3> pulls = net_.pulls(net_.turns(at_));
    const auto count = static_cast<Eigen::Index>(at_.size());
    constexpr double hold = 1e-6; // where nothing draws
    std::vector<Eigen::Triplet<double>> terms = matrix_;
    Rows right(count, 3);
    for (int v = 0; v < count; ++v) {
      const auto i = static_cast<std::size_t>(v);
      terms.emplace_back(v, v, draws[i].weight + hold);
      right.row(v) = (pulls[i] + draws[i].weight * draws[i].to + hold * at_[i]).transpose();
    }
    Sparse matrix(count, count);
    matrix.setFromTriplets(terms.begin(), terms.end());
    const Eigen::SimplicialLDLT<Sparse> solver(matrix);
    if (solver.info() != Eigen::Success) {
      return;
    }
    const Rows solved = solver.solve(right);
    for (std::size_t v = 0; v < at_.size(); ++v) {
      at_[v] = solved.row(static_cast<Eigen::Index>(v)).transpose();
    }
  }

  const TriangleMesh& surface_;
  const TriangleBvh& tree_;
  const Guess& guess_;
  TriangleMesh image_;
  RigidNet net_;
  std::vector<Eigen::Triplet<double>> matrix_;
  std::vector<Vec3> at_;
};

/// The plane that mirrors pairs best: its normal n makes the sum of (n . p) (n . q) least, with p
/// and q taken from the middle.
MirrorPlane plane_of(std::span<const std::array<Index, 2>> pairs, std::span<const Vec3> positions) {
  Vec3 middle = Vec3::Zero();
  for (const auto& [a, b] : pairs) {
    middle += (positions[a] + positions[b]) / (2.0 * static_cast<double>(pairs.size()));
  }
  Mat3 products = Mat3::Zero();
  for (const auto& [a, b] : pairs) {
    const Vec3 p = positions[a] - middle;
    const Vec3 q = positions[b] - middle;
    products += p * q.transpose() + q * p.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(products);
  MirrorPlane plane;
  plane.normal = solver.eigenvectors().col(0);
  Eigen::Index largest = 0;
  plane.normal.cwiseAbs().maxCoeff(&largest);
  plane.normal *= plane.normal[largest] < 0 ? -1 : 1;
  plane.offset = plane.normal.dot(middle);
  return plane;
}

std::vector<Guess> guesses(const TriangleMesh& surface, const SurfaceDistances& distances) {
  std::vector<Guess> result;
  const std::vector<Index> tips = limb_tips(surface, distances, most_tips);
  for (const TipPairing& pairing : tip_pairings(tips, distances, most_pairings)) {
    Guess guess;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      if (pairing.partners[i] != TipPairing::none) {
        guess.pairs.push_back({tips[i], tips[pairing.partners[i]]});
      }
    }
    guess.plane = plane_of(guess.pairs, surface.positions);
    result.push_back(std::move(guess));
  }
  for (int axis = 0; axis < 3; ++axis) { // bodies without limbs
    if (const auto plane = best_mirror_plane(surface, axis)) {
      result.push_back({*plane, {}});
    }
  }
  return result;
}

/// Between two points within triangles, from those between their corners.
double distance(const SurfacePoint& a, const SurfacePoint& b, std::span<const Triangle> triangles,
                const SurfaceDistances& distances) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      sum += a.weights[i] * b.weights[j] *
             distances(triangles[a.triangle][i], triangles[b.triangle][j]);
    }
  }
  return sum;
}

double share_uncovered(const PosedReflection& map, const TriangleMesh& surface,
                       const SurfaceDistances& distances) {
  std::vector<char> has_image(surface.positions.size(), 0);
  for (const SurfacePoint& image : map.images) {
    for (const Index v : surface.triangles[image.triangle]) {
      has_image[v] = 1;
    }
  }
  const double near = near_image * diagonal(surface.positions);
  std::size_t uncovered = 0;
  for (Index v = 0; v < has_image.size(); ++v) {
    bool is_covered = false;
    for (Index u = 0; u < has_image.size() && !is_covered; ++u) {
      is_covered = has_image[u] != 0 && distances(u, v) < near;
    }
    uncovered += is_covered ? 0 : 1;
  }
  return static_cast<double>(uncovered) / static_cast<double>(has_image.size());
}

void judge(PosedReflection& map, const TriangleMesh& surface, const SurfaceDistances& distances) {
  constexpr std::size_t most_samples = 200;
  const std::size_t count = surface.positions.size();
  const std::size_t every = 1 + count / most_samples;
  double off = 0;
  double all = 0;
  for (std::size_t i = 0; i < count; i += every) {
    for (std::size_t j = 0; j < i; j += every) {
      const double here = distances(static_cast<Index>(i), static_cast<Index>(j));
      off += std::abs(here - distance(map.images[i], map.images[j], surface.triangles, distances));
      all += here;
    }
  }
  map.stretch = all > 0 ? off / all : 1;
  std::vector<Vec3> once;
  for (const SurfacePoint& image : map.images) {
    once.push_back(image.in(surface.positions, surface.triangles));
  }
  double error = 0;
  for (std::size_t v = 0; v < count; ++v) {
    error += (map.images[v].in(once, surface.triangles) - surface.positions[v]).norm();
  }
  map.uncovered = share_uncovered(map, surface, distances);
  map.return_error = error / static_cast<double>(count) / diagonal(surface.positions);
}

/// What is the better map; less is better.
double doubt(const PosedReflection& map) {
  return map.stretch / most_stretch + map.return_error / most_return_error +
         map.uncovered / most_uncovered;
}

} // namespace

SurfacePoint surface_point_of(const Vec3& p, Index triangle, const Vec3 (&at)[3]) {
  const Vec3 n = (at[1] - at[0]).cross(at[2] - at[0]);
  const double area = n.squaredNorm();
  SurfacePoint result{triangle, {1, 0, 0}};
  if (area > 0) {
    const double b = (p - at[0]).cross(at[2] - at[0]).dot(n) / area;
    const double c = (at[1] - at[0]).cross(p - at[0]).dot(n) / area;
    const double second = std::clamp(b, 0.0, 1.0);
    const double third = std::clamp(c, 0.0, 1 - second);
    result.weights = {1 - second - third, second, third};
  }
  return result;
}

std::string PosedReflection::why_not() const {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  if (!(uncovered <= most_uncovered)) {
    return percent(uncovered) + " of its surface has no partner";
  }
  if (!(stretch <= most_stretch)) {
    return "distances along it differ by " + percent(stretch) +
           " from those between the best partners";
  }
  if (!(return_error <= most_return_error)) {
    return "partners of the best partners are places " + percent(return_error) +
           " of its diagonal away";
  }
  return "";
}

std::optional<PosedReflection> find_posed_reflection(const TriangleMesh& surface,
                                                     const Progress& progress) {
  const SurfaceDistances distances(surface, progress);
  if (progress.cancelled()) {
    return std::nullopt;
  }
  const TriangleBvh tree(surface);
  const std::vector<Guess> tried = guesses(surface, distances);
  std::vector<PosedReflection> maps(tried.size());
  parallel_for(0, tried.size(), 1, progress, [&](std::size_t i) {
    PosedReflection& map = maps[i];
    map.plane = tried[i].plane;
    for (const Vec3& p : Laying(surface, tree, tried[i]).run(progress.quiet())) {
      const NearestPoint nearest = tree.nearest(p);
      map.images.push_back(
          surface_point_of(nearest.point, nearest.triangle, tree.corners(nearest.triangle)));
    }
    judge(map, surface, distances);
  });
  if (progress.cancelled() || maps.empty()) {
    return std::nullopt;
  }
  return *std::min_element(
      maps.begin(), maps.end(),
      [](const PosedReflection& a, const PosedReflection& b) { return doubt(a) < doubt(b); });
}

} // namespace cagewright
