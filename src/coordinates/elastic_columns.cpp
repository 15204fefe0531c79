#include "coordinates/elastic_columns.h"

#include "coordinates/similarity.h"
#include "core/maths.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

Mat3 cayley(const Mat3& m) {
  return (Mat3::Identity() - m) * (Mat3::Identity() + m).inverse();
}

/// cay(M) of a rotation, of which the angle is taken as 170 degrees at most: at 180 it has none.
Mat3 cayley_of_rotation(const Mat3& turn) {
  constexpr double most = 170.0 / 180.0 * std::numbers::pi;
  const Vec3 twice_sine(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
  const double angle = maths::atan2(twice_sine.norm(), turn.trace() - 1);
  if (angle < most) {
    return cayley(turn);
  }
  // Near a half turn the axis shows in the symmetric part: (turn + turn^T) / 2 + Id ~ 2 a a^T.
  const Mat3 symmetric = (turn + turn.transpose()) / 2 + Mat3::Identity();
  Eigen::Index widest = 0;
  symmetric.diagonal().maxCoeff(&widest);
  Vec3 axis = symmetric.col(widest).normalized();
  axis = axis.dot(twice_sine) < 0 ? Vec3(-axis) : axis;
  Mat3 cross;
  cross << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  const double tangent = maths::sin(most / 2) / maths::cos(most / 2);
  return -tangent * cross; // (Id - R)(Id + R)^-1 = -tan(angle / 2) [axis]x
}

/// The signed solid angle of three directions.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double d = a.norm() * b.norm() * c.norm();
  return 2 * maths::atan2(a.dot(b.cross(c)),
                          d + a.dot(b) * c.norm() + b.dot(c) * a.norm() + c.dot(a) * b.norm());
}

class ElasticColumns : public ColumnRule {
public:
  ElasticColumns(std::span<const Vec3> cage_at_rest, const Surface& surface,
                 const SomiglianaOptions& options)
      : ColumnRule(cage_at_rest), options_(options), quads_(surface.quads),
        triangles_(surface.triangles()), unit_(surface.frame.diagonal),
        center_(surface.frame.center), rest_(with_middles(cage_at_rest, quads_)),
        bends_at_rest_(bends(rest_)) {
    for (const Index v : surface.used_vertices()) {
      if (v < cage_at_rest.size()) {
        used_.push_back(v);
      }
    }
  }

  [[nodiscard]] std::vector<ColumnGroup> groups() const override {
    return {
        {"vertex_matrices", 9 * rest_.size()}, {"tractions", 3 * triangles_.size()}, {"place", 4}};
  }

  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override {
    std::fill(moves.begin(), moves.end(), Vec3::Zero());
    if (std::equal(cage.begin(), cage.end(), cage_at_rest().begin(), cage_at_rest().end())) {
      return;
    }
    const Pose pose = pose_of(cage);
    const std::vector<Vec3> now = with_middles(cage, quads_);
    if (options_.local > 0) {
      move_locally(now, pose, moves);
    } else {
      move_globally(now, pose, moves);
    }
  }

  [[nodiscard]] std::optional<ColumnDivisor> divisor(std::span<const Vec3> cage) const override {
    if (!(options_.local > 0) ||
        std::equal(cage.begin(), cage.end(), cage_at_rest().begin(), cage_at_rest().end())) {
      return std::nullopt;
    }
    const Pose pose = pose_of(cage);
    ColumnDivisor divisor;
    divisor.center = center_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      divisor.moves[axis].assign(columns(), Vec3::Zero());
      for (std::size_t v = 0; v < rest_.size(); ++v) {
        for (std::size_t a = 0; a < 3; ++a) {
          for (std::size_t b = 0; b < 3; ++b) {
            // Column `axis` of r_a r_b^T - e_a e_b^T.
            const auto row = static_cast<Eigen::Index>(b);
            const auto column = static_cast<Eigen::Index>(a);
            const auto component = static_cast<Eigen::Index>(axis);
            divisor.moves[axis][9 * v + 3 * a + b] =
                pose.turns[v](component, row) * pose.turns[v].col(column) -
                (b == axis ? 1.0 : 0.0) * Vec3::Unit(column);
          }
        }
      }
    }
    return divisor;
  }

  /// x = sum of Phi_i c_i and of k times the traction at rest.
  [[nodiscard]] std::vector<Vec3> reproduced_from() const override {
    std::vector<Vec3> from(columns(), Vec3::Zero());
    for (std::size_t v = 0; v < rest_.size(); ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          from[9 * v + 3 * a + b] =
              rest_[v][static_cast<Eigen::Index>(b)] * Vec3::Unit(static_cast<Eigen::Index>(a));
        }
      }
    }
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t a = 0; a < 3; ++a) {
        from[traction(t) + a] =
            unit_ * traction_of(1, 1) * Vec3::Unit(static_cast<Eigen::Index>(a));
      }
    }
    return from;
  }

  void add_influence(Index vertex, std::span<double> factors) const override {
    const auto add = [&](std::size_t v, double share) {
      for (const std::size_t diagonal : {0U, 4U, 8U}) { // a third of the trace
        factors[9 * v + diagonal] += share / 3;
      }
    };
    add(vertex, 1);
    for (std::size_t q = 0; q < quads_.size(); ++q) {
      for (const Index corner : quads_[q]) {
        if (corner == vertex) {
          add(cage_at_rest().size() + q, 0.25);
        }
      }
    }
  }

private:
  struct Pose {
    Similarity whole;
    std::vector<double> tractions; ///< of each triangle
    std::vector<Mat3> face_turns;  ///< R_f; none unless local
    std::vector<Mat3> turns;       ///< R_v of vertices and middles; none unless local
  };

  [[nodiscard]] std::size_t traction(std::size_t t) const { return 9 * rest_.size() + 3 * t; }

  /// Of a stretch along the surface and one across.
  [[nodiscard]] double traction_of(double along, double across) const {
    const double nu = options_.poisson_ratio;
    return 2 * (across + nu / (1 - 2 * nu) * (2 * along + across));
  }

  [[nodiscard]] static Vec3 area_of(std::span<const Vec3> positions, const Triangle& t) {
    return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]) / 2;
  }

  /// omega_f: the solid angles of the normals at the corners of each triangle.
  [[nodiscard]] std::vector<double> bends(std::span<const Vec3> positions) const {
    std::vector<Vec3> normals(positions.size(), Vec3::Zero());
    for (const Triangle& t : triangles_) {
      for (const Index v : t) {
        normals[v] += area_of(positions, t);
      }
    }
    std::vector<double> angles;
    for (const Triangle& t : triangles_) {
      angles.push_back(solid_angle(normals[t[0]], normals[t[1]], normals[t[2]]));
    }
    return angles;
  }

  struct FaceMap {
    Mat3 turn;
    double stretch = 1; ///< the mean of the two along the face
  };

  /// What happens to a triangle, by itself.
  [[nodiscard]] FaceMap map_of(const Triangle& t, std::span<const Vec3> now,
                               const Similarity& whole) const {
    const Vec3 area = area_of(rest_, t);
    const Vec3 area_now = area_of(now, t);
    const double ratio = std::sqrt(area_now.norm() / area.norm());
    const auto frame = [&](std::span<const Vec3> p, const Vec3& normal) {
      Mat3 f;
      f << p[t[1]] - p[t[0]], p[t[2]] - p[t[0]], normal;
      return f;
    };
    const double length = std::sqrt(area.norm()); // so that the three columns are alike
    const Mat3 before = frame(rest_, length * area.normalized());
    const Vec3 normal_now = area_now.norm() > 0 ? Vec3(area_now.normalized()) : Vec3(Vec3::Zero());
    const Mat3 after = frame(now, length * ratio * normal_now);
    const Mat3 map = after * before.inverse();
    FaceMap result;
    result.turn = nearest_rotation(map, whole.turn);
    // In the plane: the singular values of [u' v'] [u v]^-1.
    const Vec3 e1 = (rest_[t[1]] - rest_[t[0]]).normalized();
    const Vec3 e2 = area.normalized().cross(e1);
    Eigen::Matrix<double, 3, 2> flat;
    flat << map * e1, map * e2;
    const double square = (flat.transpose() * flat).trace();
    const double det = (map * e1).cross(map * e2).norm();
    result.stretch = std::sqrt(std::max(0.0, square + 2 * det)) / 2; // (s1 + s2) / 2
    return result;
  }

  /// Vertices without faces may be anywhere.
  [[nodiscard]] std::vector<Vec3> used(std::span<const Vec3> positions) const {
    std::vector<Vec3> list;
    for (const Index v : used_) {
      list.push_back(positions[v]);
    }
    return list;
  }

  [[nodiscard]] Pose pose_of(std::span<const Vec3> cage) const {
    Pose pose;
    pose.whole = best_similarity(used(cage_at_rest()), used(cage));
    const std::vector<Vec3> now = with_middles(cage, quads_);
    const double beta = options_.local;
    std::vector<double> bends_now;
    if (options_.bulge > 0) {
      bends_now = bends(now);
    }
    std::vector<Vec3> directions;
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const Triangle& t = triangles_[f];
      double along = pose.whole.scale;
      Mat3 turn = pose.whole.turn;
      if (beta > 0) {
        const FaceMap map = map_of(t, now, pose.whole);
        turn = pose.whole.turn *
               cayley(beta * cayley_of_rotation(pose.whole.turn.transpose() * map.turn));
        along = beta * map.stretch + (1 - beta) * pose.whole.scale;
        pose.face_turns.push_back(turn);
      }
      const double more = options_.bulge > 0 ? maths::exp(options_.bulge * options_.bulge *
                                                          (bends_now[f] - bends_at_rest_[f]) /
                                                          (4 * std::numbers::pi))
                                             : 1.0;
      pose.tractions.push_back(traction_of(along, along * more));
      directions.push_back(turn * area_of(rest_, t).normalized());
    }
    remove_net_force(directions, pose);
    if (beta > 0) {
      find_vertex_turns(pose);
    }
    return pose;
  }

  void remove_net_force(std::span<const Vec3> directions, Pose& pose) const {
    Mat3 square = Mat3::Zero();
    Vec3 force = Vec3::Zero();
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const double area = area_of(rest_, triangles_[f]).norm();
      square += area * directions[f] * directions[f].transpose();
      force += area * pose.tractions[f] * directions[f];
    }
    const Vec3 z = square.partialPivLu().solve(force);
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      pose.tractions[f] -= directions[f].dot(z);
    }
  }

  void find_vertex_turns(Pose& pose) const {
    std::vector<Mat3> sums(rest_.size(), Mat3::Zero());
    std::vector<double> areas(rest_.size(), 0.0);
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const double area = area_of(rest_, triangles_[f]).norm();
      const Mat3 turn = cayley_of_rotation(pose.whole.turn.transpose() * pose.face_turns[f]);
      for (const Index v : triangles_[f]) {
        sums[v] += area * turn;
        areas[v] += area;
      }
    }
    for (std::size_t v = 0; v < rest_.size(); ++v) {
      pose.turns.push_back(areas[v] > 0 ? Mat3(pose.whole.turn * cayley(sums[v] / areas[v]))
                                        : pose.whole.turn);
    }
  }

  /// x' = sRx + t + R (sum of Phi R^T (c' - sRc - t) + sum of (tau - that of the similarity) k).
  /// \param now  vertices and middles
  void move_globally(std::span<const Vec3> now, const Pose& pose, std::span<Vec3> moves) const {
    const Mat3& turn = pose.whole.turn;
    for (std::size_t v = 0; v < now.size(); ++v) {
      const Vec3 off = turn.transpose() * (now[v] - pose.whole(rest_[v]));
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          moves[9 * v + 3 * a + b] =
              off[static_cast<Eigen::Index>(b)] * turn.col(static_cast<Eigen::Index>(a));
        }
      }
    }
    const double plain = traction_of(pose.whole.scale, pose.whole.scale);
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      for (std::size_t a = 0; a < 3; ++a) {
        moves[traction(f) + a] =
            unit_ * (pose.tractions[f] - plain) * turn.col(static_cast<Eigen::Index>(a));
      }
    }
    const std::size_t place = traction(triangles_.size());
    for (Eigen::Index a = 0; a < 3; ++a) {
      moves[place + static_cast<std::size_t>(a)] =
          unit_ * (pose.whole.scale * turn.col(a) - Vec3::Unit(a));
    }
    moves[place + 3] = pose.whole(center_) - center_;
  }

  /// What is to be divided: the sum of M (c' - o) and of tau R_f k, less that at rest.
  void move_locally(std::span<const Vec3> now, const Pose& pose, std::span<Vec3> moves) const {
    for (std::size_t v = 0; v < now.size(); ++v) {
      const Mat3& turn = pose.turns[v];
      const Vec3 after = turn.transpose() * (now[v] - center_);
      const Vec3 before = rest_[v] - center_;
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          const auto column = static_cast<Eigen::Index>(a);
          const auto row = static_cast<Eigen::Index>(b);
          moves[9 * v + 3 * a + b] =
              after[row] * turn.col(column) - before[row] * Vec3::Unit(column);
        }
      }
    }
    const double plain = traction_of(1, 1);
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      for (std::size_t a = 0; a < 3; ++a) {
        const auto column = static_cast<Eigen::Index>(a);
        moves[traction(f) + a] = unit_ * (pose.tractions[f] * pose.face_turns[f].col(column) -
                                          plain * Vec3::Unit(column));
      }
    }
  }

  SomiglianaOptions options_;
  std::vector<std::array<Index, 4>> quads_;
  std::vector<Triangle> triangles_;
  double unit_;
  Vec3 center_;
  std::vector<Vec3> rest_; // with middles
  std::vector<double> bends_at_rest_;
  std::vector<Index> used_;
};

} // namespace

std::shared_ptr<const ColumnRule> elastic_columns(std::span<const Vec3> cage_at_rest,
                                                  const Surface& surface,
                                                  const SomiglianaOptions& options) {
  return std::make_shared<ElasticColumns>(cage_at_rest, surface, options);
}

} // namespace cagewright
