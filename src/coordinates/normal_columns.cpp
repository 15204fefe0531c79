#include "coordinates/normal_columns.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

class NormalColumns : public ColumnRule {
public:
  /// \param quads  of which the middles are vertices behind those of the cage
  NormalColumns(std::span<const Vec3> cage_at_rest, std::vector<std::array<Index, 4>> quads,
                std::vector<Triangle> triangles, double unit)
      : ColumnRule(cage_at_rest), quads_(std::move(quads)), triangles_(std::move(triangles)),
        unit_(unit) {
    const std::vector<Vec3> positions = with_middles(cage_at_rest, quads_);
    for (const Triangle& t : triangles_) {
      const Vec3 u = positions[t[1]] - positions[t[0]];
      const Vec3 v = positions[t[2]] - positions[t[0]];
      normals_.push_back(u.cross(v).normalized());
      edges_.emplace_back(u, v);
    }
  }

  [[nodiscard]] std::vector<ColumnGroup> groups() const override {
    return {{"vertices", cage_at_rest().size()}, {"normals", triangles_.size()}};
  }

  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override {
    const std::size_t count = cage_at_rest().size();
    assert(cage.size() == count && moves.size() == count + triangles_.size());
    for (std::size_t v = 0; v < count; ++v) {
      moves[v] = cage[v] - cage_at_rest()[v];
    }
    const std::vector<Vec3> positions = with_middles(cage, quads_);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& corners = triangles_[t];
      const auto& [u, v] = edges_[t];
      const Vec3 u_now = positions[corners[1]] - positions[corners[0]];
      const Vec3 v_now = positions[corners[2]] - positions[corners[0]];
      const bool is_at_rest = u_now == u && v_now == v;
      moves[count + t] =
          is_at_rest
              ? Vec3(Vec3::Zero())
              : Vec3(unit_ * (stretch(u, v, u_now, v_now) * normal_of(positions, t) - normals_[t]));
    }
  }

  [[nodiscard]] std::vector<Vec3> reproduced_from() const override {
    std::vector<Vec3> from(cage_at_rest().begin(), cage_at_rest().end());
    for (const Vec3& normal : normals_) {
      from.emplace_back(unit_ * normal);
    }
    return from;
  }

private:
  [[nodiscard]] Vec3 area_of(std::span<const Vec3> positions, const Triangle& t) const {
    return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
  }

  [[nodiscard]] Vec3 normal_of(std::span<const Vec3> positions, std::size_t index) const {
    // Thinner than this a triangle has no plane, and its normal would be noise.
    constexpr double collapsed = 1e-12;
    const Triangle& corners = triangles_[index];
    const Vec3 area = area_of(positions, corners);
    double longest2 = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      longest2 = std::max(longest2,
                          (positions[corners[(i + 1) % 3]] - positions[corners[i]]).squaredNorm());
    }
    if (area.norm() > collapsed * longest2) {
      return area.normalized();
    }
    Vec3 around = Vec3::Zero();
    for (const Triangle& other : triangles_) {
      const bool shares = std::any_of(other.begin(), other.end(), [&](Index v) {
        return std::find(corners.begin(), corners.end(), v) != corners.end();
      });
      around += shares ? area_of(positions, other) : Vec3(Vec3::Zero());
    }
    return around.norm() > 0 ? Vec3(around.normalized()) : normals_[index];
  }

  std::vector<std::array<Index, 4>> quads_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3> normals_;
  std::vector<std::pair<Vec3, Vec3>> edges_;
  double unit_;
};

} // namespace

double stretch(const Vec3& u, const Vec3& v, const Vec3& u_now, const Vec3& v_now) {
  const double square = (u_now.squaredNorm() * v.squaredNorm() - 2 * u_now.dot(v_now) * u.dot(v) +
                         v_now.squaredNorm() * u.squaredNorm()) /
                        2;
  return std::sqrt(std::max(square, 0.0)) / u.cross(v).norm();
}

std::shared_ptr<const ColumnRule> normal_columns(std::span<const Vec3> cage_at_rest,
                                                 const Surface& surface) {
  return std::make_shared<NormalColumns>(cage_at_rest, surface.quads, surface.triangles(),
                                         surface.frame.diagonal);
}

std::shared_ptr<const ColumnRule> triangle_columns(std::span<const Vec3> cage_at_rest,
                                                   std::vector<Triangle> triangles, double unit) {
  return std::make_shared<NormalColumns>(cage_at_rest, std::vector<std::array<Index, 4>>(),
                                         std::move(triangles), unit);
}

} // namespace cagewright
