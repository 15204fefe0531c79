#include "coordinates/patch_columns.h"

#include "coordinates/normal_columns.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

namespace cagewright {
namespace {

class PatchColumns : public ColumnRule {
public:
  PatchColumns(std::span<const Vec3> cage_at_rest, const PatchedSurface& surface)
      : ColumnRule(cage_at_rest), unit_(surface.surface.frame.diagonal) {
    for (const std::size_t f : surface.triangles) {
      triangles_.push_back(surface.surface.faces[f].vertices);
    }
    triangle_rule_ = triangle_columns(cage_at_rest, triangles_, unit_);
    for (const CagePatch& patch : surface.patches) {
      patches_.push_back(patch_of(patch.patch.vertices, cage_at_rest));
    }
  }

  [[nodiscard]] std::vector<ColumnGroup> groups() const override {
    return {{"vertices", cage_at_rest().size()},
            {"normals", triangles_.size()},
            {"corner_normals", 4 * patches_.size()}};
  }

  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override {
    const std::size_t first = cage.size() + triangles_.size();
    assert(moves.size() == first + 4 * patches_.size());
    triangle_rule_->move(cage, moves.first(first));
    for (std::size_t q = 0; q < patches_.size(); ++q) {
      const Patch& rest = patches_[q];
      const Patch now = patch_of(rest.vertices, cage);
      const bool is_at_rest = now.corners == rest.corners;
      const std::array<double, 4> sigma =
          is_at_rest ? std::array<double, 4>{} : stretches(rest, now);
      for (std::size_t k = 0; k < 4; ++k) {
        moves[first + 4 * q + k] =
            is_at_rest ? Vec3(Vec3::Zero())
                       : Vec3((sigma[k] * now.normals[k] - rest.normals[k]) / unit_);
      }
    }
  }

  [[nodiscard]] std::vector<Vec3> reproduced_from() const override {
    std::vector<Vec3> from = triangle_rule_->reproduced_from();
    for (const Patch& patch : patches_) {
      for (const Vec3& normal : patch.normals) {
        from.emplace_back(normal / unit_);
      }
    }
    return from;
  }

private:
  static Patch patch_of(const std::array<Index, 4>& vertices, std::span<const Vec3> positions) {
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = positions[vertices[k]];
    }
    Patch patch = make_patch(corners);
    patch.vertices = vertices;
    return patch;
  }

  static std::array<double, 4> stretches(const Patch& rest, const Patch& now) {
    static const LineRule rule(4);
    std::array<double, 4> above{};
    std::array<double, 4> below{};
    for (std::size_t i = 0; i < 16; ++i) {
      const double u = rule.at[i / 4];
      const double v = rule.at[i % 4];
      const double weight = rule.weight[i / 4] * rule.weight[i % 4];
      const auto along_u = [&](const Patch& p) { return Vec3(p.position[1] + v * p.position[3]); };
      const auto along_v = [&](const Patch& p) { return Vec3(p.position[2] + u * p.position[3]); };
      const auto normal = [&](const Patch& p) {
        return Vec3(p.normal[0] + u * p.normal[1] + v * p.normal[2]).norm();
      };
      const double before = normal(rest);
      // stretch() divides by this area, which may vanish at a corner alone.
      const double stretched =
          before > 0 ? stretch(along_u(rest), along_v(rest), along_u(now), along_v(now)) * before
                     : 0;
      const double after = normal(now);
      const std::array<double, 4> hats = hats_at(u, v);
      for (std::size_t k = 0; k < 4; ++k) {
        above[k] += weight * hats[k] * stretched;
        below[k] += weight * hats[k] * after;
      }
    }
    std::array<double, 4> sigma{};
    for (std::size_t k = 0; k < 4; ++k) {
      sigma[k] = below[k] > 0 ? above[k] / below[k] : 0;
    }
    return sigma;
  }

  double unit_;
  std::vector<Triangle> triangles_;
  std::shared_ptr<const ColumnRule> triangle_rule_;
  std::vector<Patch> patches_; // in the cage's units
};

} // namespace

std::shared_ptr<const ColumnRule> patch_columns(std::span<const Vec3> cage_at_rest,
                                                const PatchedSurface& surface) {
  return std::make_shared<PatchColumns>(cage_at_rest, surface);
}

} // namespace cagewright
