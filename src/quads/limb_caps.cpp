#include "quads/limb_caps.h"

#include "core/maths.h"
#include "quads/pairing.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t most_sides = 6; // of what closes a limb

/// The faces of a cap, its corners numbered 0, 1, ... `sides` - 1: all ways that have the fewest
/// triangles.
std::vector<std::vector<CageFace>> cap_tilings(std::size_t sides) {
  const auto n = static_cast<Index>(sides);
  switch (sides) {
  case 3:
    return {{CageFace::triangle(0, 1, 2)}};
  case 4:
    return {{CageFace::quad(0, 1, 2, 3)}};
  default: { // a quad, and the triangle or quad beside it
    std::vector<std::vector<CageFace>> all;
    for (Index i = 0; i < (sides == most_sides ? n / 2 : n); ++i) {
      const auto corner = [&](Index k) { return (i + k) % n; };
      const CageFace rest = sides == most_sides
                                ? CageFace::quad(corner(0), corner(3), corner(4), corner(5))
                                : CageFace::triangle(corner(0), corner(3), corner(4));
      all.push_back({CageFace::quad(corner(0), corner(1), corner(2), corner(3)), rest});
    }
    return all;
  }
  }
}

class LimbEnd {
public:
  LimbEnd(const QuadCage& cage, Index tip) : cage_(cage), tip_(tip) {
    if (cage.band_of(tip) != nullptr || cage.around(tip).empty()) {
      return;
    }
    faces_ = cage.around(tip);
    for (const Index f : faces_) {
      triangles_ += cage.face(f).is_quad() ? 0 : 1;
    }
    if (triangles_ >= 2 && is_pointed()) {
      find_ring();
    }
  }

  /// Whether something may be won by a cap.
  [[nodiscard]] bool may_be_capped() const {
    return ring_.size() >= 3 && ring_.size() <= most_sides &&
           triangles_ > static_cast<int>(ring_.size() % 2) &&
           std::all_of(ring_.begin(), ring_.end(), [&](Index v) {
             return cage_.band_of(v) == nullptr &&
                    faces_without_tip(v) >= (cage_.on_border(v) ? 2 : 3);
           });
  }

  /// The cage with a cap, moved so far beyond the ring, 1 is as far as the tip, and so many times
  /// as wide as the ring.
  [[nodiscard]] QuadCage capped(double far, double wide, const FaceWishes& wishes) const {
    QuadCage cage = cage_;
    std::vector<Vec3> x = cage.positions();
    Vec3 middle = Vec3::Zero();
    for (const Index v : ring_) {
      middle += x[v] / static_cast<double>(ring_.size());
    }
    if (cage_.on_border(tip_)) {
      middle.x() = 0; // of the whole ring
    }
    const Vec3 way = x[tip_] - middle;
    const double height = way.squaredNorm();
    for (const Index v : ring_) {
      const double own = (x[v] - middle).dot(way) / height; // of the way
      const Vec3 aside = x[v] - middle - own * way;
      x[v] = middle + std::max(far, own) * way + wide * aside;
      if (cage_.on_border(v)) {
        x[v].x() = 0;
      }
    }
    cage.set_positions(std::move(x));
    cage.replace(faces_, best_tiling(cage.positions(), wishes));
    return cage;
  }

  /// Whether the ring is on its side of the plane, if the cage is half of one.
  [[nodiscard]] bool stays_on_its_side(const QuadCage& capped, double least) const {
    return !cage_.has_border() || std::all_of(ring_.begin(), ring_.end(), [&](Index v) {
      const double side = cage_.positions()[v].x() < 0 ? -1 : 1;
      return cage_.on_border(v) || side * capped.positions()[v].x() > least;
    });
  }

  /// The faces that moved, or are new.
  [[nodiscard]] std::vector<Index> changed_in(const QuadCage& capped) const {
    std::vector<Index> faces;
    for (const Index v : ring_) {
      faces.insert(faces.end(), capped.around(v).begin(), capped.around(v).end());
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }

private:
  // Whether the angles at the tip leave so much to a full turn as at the end of a limb.
  [[nodiscard]] bool is_pointed() const {
    constexpr double most = 1.6 * std::numbers::pi;
    const std::vector<Vec3>& x = cage_.positions();
    double sum = 0;
    for (const Index f : faces_) {
      const CageFace& face = cage_.face(f);
      for (int i = 0; i < face.size; ++i) {
        if (face[i] == tip_) {
          const Vec3 a = x[face[i + 1]] - x[tip_];
          const Vec3 b = x[face[i + face.size - 1]] - x[tip_];
          sum += maths::atan2(a.cross(b).norm(), a.dot(b));
        }
      }
    }
    return (cage_.on_border(tip_) ? 2 : 1) * sum < most;
  }

  // The corners round the faces at the tip, counter-clockwise; of a tip on the border of half a
  // cage from border to border, which a cap joins, and else none of the border.
  void find_ring() {
    std::vector<std::array<Index, 2>> sides;
    for (const Index f : faces_) {
      const CageFace& face = cage_.face(f);
      if (face.part != cage_.face(faces_.front()).part) {
        return;
      }
      for (int i = 0; i < face.size; ++i) {
        if (face[i] != tip_ && face[i + 1] != tip_) {
          sides.push_back({face[i], face[i + 1]});
        }
      }
    }
    std::sort(sides.begin(), sides.end());
    const auto first = std::find_if(sides.begin(), sides.end(), [&](const auto& side) {
      return std::none_of(sides.begin(), sides.end(),
                          [&](const auto& other) { return other[1] == side[0]; });
    });
    const bool is_open = first != sides.end();
    std::vector<Index> ring{(is_open ? *first : sides.front())[0]};
    while (ring.size() <= sides.size()) {
      const auto next = std::find_if(sides.begin(), sides.end(),
                                     [&](const auto& side) { return side[0] == ring.back(); });
      if (next == sides.end() || (*next)[1] == ring.front()) {
        break;
      }
      ring.push_back((*next)[1]);
    }
    const auto on_border = static_cast<std::size_t>(
        std::count_if(ring.begin(), ring.end(), [&](Index v) { return cage_.on_border(v); }));
    const bool is_round = !is_open && ring.size() == sides.size() && on_border == 0;
    const bool is_across = is_open && ring.size() == sides.size() + 1 && on_border == 2 &&
                           cage_.on_border(ring.back()) &&
                           cage_.face_left_of(ring.front(), ring.back()) == no_index &&
                           cage_.face_left_of(ring.back(), ring.front()) == no_index;
    if (cage_.on_border(tip_) ? is_across : is_round) {
      ring_ = std::move(ring);
    }
  }

  [[nodiscard]] int faces_without_tip(Index v) const {
    const auto at_tip =
        std::count_if(faces_.begin(), faces_.end(), [&](Index f) { return cage_.face(f).has(v); });
    return static_cast<int>(cage_.around(v).size()) - static_cast<int>(at_tip) + 1;
  }

  [[nodiscard]] std::vector<CageFace> best_tiling(const std::vector<Vec3>& x,
                                                  const FaceWishes& wishes) const {
    std::vector<CageFace> best;
    double least = std::numeric_limits<double>::infinity();
    for (std::vector<CageFace> tiling : cap_tilings(ring_.size())) {
      double defect = 0;
      for (CageFace& face : tiling) {
        for (int i = 0; i < face.size; ++i) {
          face.corners[i] = ring_[face.corners[i]];
        }
        face = face.of_part(cage_.face(faces_.front()).part);
        defect += face_defect(x, face, wishes);
      }
      if (defect < least) {
        least = defect;
        best = std::move(tiling);
      }
    }
    return best;
  }

  const QuadCage& cage_;
  Index tip_;
  std::vector<Index> faces_;
  std::vector<Index> ring_;
  int triangles_ = 0;
};

bool may_all_stand(const QuadCage& cage, const std::vector<Index>& faces, const QuadGuard& guard) {
  const std::vector<Vec3>& x = cage.positions();
  const std::vector<Box3> boxes = face_boxes(cage, x);
  return std::all_of(faces.begin(), faces.end(), [&](Index f) {
    const CageFace& face = cage.face(f);
    const bool is_firm_quad = face.is_quad() && !face.tentative;
    return (!is_firm_quad || shape_of(corners_of(x, face)).within(guard.limits())) &&
           QuadGuard::keeps_halves_apart(cage, {&face, 1}) &&
           !guard.is_crossed(cage, x, boxes, face, f) && guard.is_clear(x, face);
  });
}

/// The cage with a cap in the place of the tip: the narrowest, and then the shortest, that is
/// valid.
std::optional<QuadCage> with_cap(const QuadCage& cage, Index tip, const QuadGuard& guard) {
  const LimbEnd end(cage, tip);
  if (!end.may_be_capped()) {
    return std::nullopt;
  }
  FaceWishes wishes;
  wishes.limits = guard.limits();
  for (const double width : {1.0, 1.3, 1.7}) { // a limb that bends needs more than its own
    for (const double far : {0.4, 0.55, 0.7, 0.85, 1.0}) {
      QuadCage capped = end.capped(far, width, wishes);
      if (end.stays_on_its_side(capped, guard.clearance()) &&
          may_all_stand(capped, end.changed_in(capped), guard) &&
          !loses_a_part(guard.model(), capped, capped.positions())) {
        return capped;
      }
    }
  }
  return std::nullopt;
}

} // namespace

std::size_t cap_limbs(QuadCage& cage, const QuadGuard& guard, double slack_degrees) {
  QuadLimits limits = guard.limits();
  limits.max_bend_degrees += slack_degrees;
  limits.min_angle_degrees = std::max(1.0, limits.min_angle_degrees - slack_degrees / 2);
  limits.max_angle_degrees = std::min(178.0, limits.max_angle_degrees + slack_degrees / 2);
  const QuadGuard wide(guard.model(), guard.clearance(), limits);
  std::size_t count = 0;
  for (Index v = 0; v < cage.vertex_end(); ++v) {
    if (std::optional<QuadCage> capped = with_cap(cage, v, wide)) {
      cage = std::move(*capped);
      ++count;
    }
  }
  return count;
}

} // namespace cagewright
