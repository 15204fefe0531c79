// Integrals over bilinear patches that are nearly singular close by: the parameter square is split
// until each piece is small as seen from the point, and Gauss's rule does the rest. Pieces lie side
// by side in vector registers, whichever of the points they belong to: so no lane is idle, however
// differently the points see the patch, and what one of them gets does not hang on the others.
// Included once for each instruction set by *_simd.cpp. Internal to this module.

#if defined(CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#undef CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#endif

#include "coordinates/lanes-inl.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

/// Of three coordinates each.
struct LaneVector {
  Lanes x, y, z;

  LaneVector() = default;
  HWY_INLINE LaneVector(Lanes vx, Lanes vy, Lanes vz) : x(vx), y(vy), z(vz) {}
  HWY_INLINE explicit LaneVector(const Vec3& v) : x(v.x()), y(v.y()), z(v.z()) {}
};
HWY_INLINE LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE LaneVector operator*(Lanes a, const LaneVector& b) {
  return {a * b.x, a * b.y, a * b.z};
}
/// a b + c
HWY_INLINE LaneVector fma(Lanes a, const LaneVector& b, const LaneVector& c) {
  return {fma(a, b.x, c.x), fma(a, b.y, c.y), fma(a, b.z, c.z)};
}
HWY_INLINE Lanes dot(const LaneVector& a, const LaneVector& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
HWY_INLINE LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A piece of the parameter square of a patch, and the point from which it is seen.
struct alignas(64) Piece {
  double u, v, du, dv; ///< a corner and the sides
  double x, y, z;
  std::size_t point;
};

/// A vector of them that grows, but never shrinks.
class PieceList {
public:
  void clear() { count_ = 0; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t size() const { return count_; }
  const Piece& operator[](std::size_t i) const { return pieces_[i]; }
  HWY_INLINE void push_back(const Piece& piece) {
    if (HWY_UNLIKELY(count_ == pieces_.size())) {
      pieces_.resize(2 * count_ + 64);
    }
    pieces_[count_++] = piece;
  }

private:
  std::size_t count_ = 0;
  std::vector<Piece> pieces_;
};

/// Several side by side.
struct LanePieces {
  Lanes u, v, du, dv;
  LaneVector x;

  /// \param count  of pieces, at least one; behind the last one comes the last one again
  HWY_INLINE LanePieces(const Piece* pieces, std::size_t count) {
    alignas(64) double rows[7][lanes];
    for (std::size_t k = 0; k < lanes; ++k) {
      const Piece& piece = pieces[std::min(k, count - 1)];
      rows[0][k] = piece.u;
      rows[1][k] = piece.v;
      rows[2][k] = piece.du;
      rows[3][k] = piece.dv;
      rows[4][k] = piece.x;
      rows[5][k] = piece.y;
      rows[6][k] = piece.z;
    }
    u = Lanes::load(rows[0]);
    v = Lanes::load(rows[1]);
    du = Lanes::load(rows[2]);
    dv = Lanes::load(rows[3]);
    x = {Lanes::load(rows[4]), Lanes::load(rows[5]), Lanes::load(rows[6])};
  }
};

/// Where a point lies on a patch.
struct PatchPlace {
  bool is_on = false;
  double u = 0;
  double v = 0;
};

/// Integrals of `count` functions times 1, u, v, u v over a patch, from sixteen points or fewer.
template <std::size_t count> class PatchIntegrals {
public:
  /// \param touching  nearer than this a point lies on the patch
  PatchIntegrals(const PatchRule& rule, double touching)
      : rule_(rule), touching_(touching), seen_(rule.choices.size()) {}

  /// \param value  (square, along, values): gives the functions of |P - x|^2 and (P - x) . N at one
  ///               or two nodes, which may share a division
  /// \param wanted which points; of others all is 0
  template <class Value>
  void run(const Patch& patch, std::span<const Vec3> points, std::uint32_t wanted,
           const Value& value) {
    moments_ = {};
    touched_ = 0;
    next_.clear();
    for (PieceList& list : seen_) {
      list.clear();
    }
    start(patch, points, wanted);
    while (!now_.empty()) {
      next_.clear();
      for (std::size_t i = 0; i < now_.size(); i += lanes) {
        sort_out(patch, i);
      }
      std::swap(now_, next_);
    }
    for (std::size_t c = 0; c < seen_.size(); ++c) {
      for (std::size_t i = 0; i < seen_[c].size(); i += lanes) {
        integrate(patch, rule_.choices[c].line, seen_[c], i, value);
      }
    }
  }

  /// One bit for each point that lies on the patch; its integrals mean nothing.
  [[nodiscard]] std::uint32_t touched() const { return touched_; }
  /// The nearest place there.
  [[nodiscard]] PatchPlace place(const Patch& patch, const Vec3& x, std::size_t i) const {
    return refined(patch, x, place_[i]);
  }

  /// Of the four hats times function f, for points from `first` on.
  HWY_INLINE void with_hats(std::size_t f, std::size_t first, Lanes (&hats)[4]) const {
    const auto of = [&](std::size_t m)
                        HWY_ATTR { return Lanes::load(&moments_[4 * f + m].of[first]); };
    hats[2] = of(3);
    hats[1] = of(1) - hats[2];
    hats[3] = of(2) - hats[2];
    hats[0] = of(0) - of(1) - hats[3];
  }
  /// The same for point i alone.
  [[nodiscard]] std::array<double, 4> with_hats(std::size_t f, std::size_t i) const {
    const auto of = [&](std::size_t m) { return moments_[4 * f + m].of[i]; };
    return {of(0) - of(1) - (of(2) - of(3)), of(1) - of(3), of(3), of(2) - of(3)};
  }

private:
  struct Sixteen {
    alignas(64) std::array<double, 16> of{};
  };

  /// The patch as a whole, whose radius is the same for all points.
  void start(const Patch& patch, std::span<const Vec3> points, std::uint32_t wanted) {
    const Vec3 middle =
        (patch.corners[0] + patch.corners[1] + patch.corners[2] + patch.corners[3]) / 4;
    double radius2 = 0;
    for (const Vec3& corner : patch.corners) {
      radius2 = std::max(radius2, (corner - middle).squaredNorm());
    }
    const std::array<Vec3, 4>& p = patch.corners;
    const bool along_u = std::max((p[1] - p[0]).squaredNorm(), (p[2] - p[3]).squaredNorm()) >=
                         std::max((p[3] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((wanted >> i & 1U) != 0) {
        const Vec3& x = points[i];
        place_piece({0, 0, 1, 1, x.x(), x.y(), x.z(), i}, radius2, (middle - x).squaredNorm(),
                    along_u);
      }
    }
    std::swap(now_, next_);
    next_.clear();
  }

  /// Pieces i to i + lanes of `now_`: to those that are seen small enough, or in halves to `next_`.
  void sort_out(const Patch& patch, std::size_t i) {
    const std::size_t end = std::min(lanes, now_.size() - i);
    const LanePieces p(&now_[i], end);
    const LaneVector twist(patch.position[3]);
    const Lanes half_u = p.du * Lanes(0.5);
    const Lanes half_v = p.dv * Lanes(0.5);
    const Lanes u = p.u + half_u;
    const Lanes v = p.v + half_v;
    const LaneVector across = fma(u, twist, LaneVector(patch.position[2])); // P_v in the middle
    const LaneVector middle =
        fma(v, across, fma(u, LaneVector(patch.position[1]), LaneVector(patch.position[0]) - p.x));
    // The corners are at +-a +-b +-c from there.
    const LaneVector a = half_u * fma(v, twist, LaneVector(patch.position[1]));
    const LaneVector b = half_v * across;
    const LaneVector c = half_u * half_v * twist;
    const LaneVector sum = a + b;
    const LaneVector difference = a - b;
    const Lanes sum_c = absolute(dot(sum, c));
    const Lanes difference_c = absolute(dot(difference, c));
    const Lanes radius2 =
        dot(c, c) + larger(fma(Lanes(2.0), sum_c, dot(sum, sum)),
                           fma(Lanes(2.0), difference_c, dot(difference, difference)));
    const Lanes distance2 = dot(middle, middle);
    // The longer side of the two that run along u, and along v.
    const Lanes long_u = dot(a, a) + dot(c, c) + Lanes(2.0) * absolute(dot(a, c));
    const Lanes long_v = dot(b, b) + dot(c, c) + Lanes(2.0) * absolute(dot(b, c));
    alignas(64) std::array<double, lanes> radii;
    alignas(64) std::array<double, lanes> distances;
    alignas(64) std::array<double, lanes> which;
    radius2.store(radii.data());
    distance2.store(distances.data());
    (long_u - long_v).store(which.data());
    for (std::size_t k = 0; k < end; ++k) {
      place_piece(now_[i + k], radii[k], distances[k], which[k] >= 0);
    }
  }

  HWY_INLINE void place_piece(const Piece& piece, double radius2, double distance2, bool along_u) {
    for (std::size_t c = 0; c < seen_.size(); ++c) {
      if (radius2 < rule_.choices[c].seen_under2 * distance2) {
        seen_[c].push_back(piece);
        return;
      }
    }
    if ((touched_ >> piece.point & 1U) != 0) {
      return;
    }
    Piece half = piece;
    if (distance2 < touching_ * touching_ && radius2 < touching_ * touching_) {
      touched_ |= 1U << piece.point;
      place_[piece.point] = {true, piece.u + piece.du / 2, piece.v + piece.dv / 2};
    } else if (along_u) {
      half.du /= 2;
      next_.push_back(half);
      half.u += half.du;
      next_.push_back(half);
    } else {
      half.dv /= 2;
      next_.push_back(half);
      half.v += half.dv;
      next_.push_back(half);
    }
  }

  template <class Value>
  HWY_INLINE void integrate(const Patch& patch, const LineRule& line, const PieceList& list,
                            std::size_t i, const Value& value) {
    const std::size_t end = std::min(lanes, list.size() - i);
    const LanePieces p(&list[i], end);
    // The piece is a patch by itself: q0 + s q1 + t q2 + s t q3 - x, with normal m0 + s m1 + t m2.
    const LaneVector c1(patch.position[1]);
    const LaneVector c2(patch.position[2]);
    const LaneVector twist(patch.position[3]);
    const LaneVector across = fma(p.u, twist, c2);
    const LaneVector q0 = fma(p.v, across, fma(p.u, c1, LaneVector(patch.position[0]) - p.x));
    const LaneVector q1 = p.du * fma(p.v, twist, c1);
    const LaneVector q2 = p.dv * across;
    const LaneVector q3 = p.du * p.dv * twist;
    const LaneVector n1(patch.normal[1]);
    const LaneVector n2(patch.normal[2]);
    const LaneVector m0 = fma(p.v, n2, fma(p.u, n1, LaneVector(patch.normal[0])));
    const LaneVector m1 = p.du * n1;
    const LaneVector m2 = p.dv * n2;
    Lanes sums[count][4];
    for (auto& of : sums) {
      of[0] = of[1] = of[2] = of[3] = Lanes(0.0);
    }
    const std::size_t nodes = line.at.size();
    for (std::size_t k = 0; k < nodes; ++k) {
      const Lanes s(line.at[k]);
      const LaneVector start = fma(s, q1, q0);
      const LaneVector slope = fma(s, q3, q2);
      const LaneVector normal = fma(s, m1, m0);
      Lanes row[count][2];
      for (auto& of : row) {
        of[0] = of[1] = Lanes(0.0);
      }
      const auto add_nodes =
          [&]<std::size_t together>(std::size_t l, std::integral_constant<std::size_t, together>)
              HWY_ATTR {
                Lanes square[together];
                Lanes along[together];
                Lanes values[together][count];
                for (std::size_t m = 0; m < together; ++m) {
                  const Lanes t(line.at[l + m]);
                  const LaneVector off = fma(t, slope, start);
                  square[m] = dot(off, off);
                  along[m] = dot(off, fma(t, m2, normal));
                }
                value(square, along, values);
                for (std::size_t m = 0; m < together; ++m) {
                  for (std::size_t f = 0; f < count; ++f) {
                    const Lanes here = values[m][f] * Lanes(line.weight[l + m]);
                    row[f][0] += here;
                    row[f][1] = fma(here, Lanes(line.at[l + m]), row[f][1]);
                  }
                }
              };
      std::size_t l = 0;
      for (; l + 2 <= nodes; l += 2) {
        add_nodes(l, std::integral_constant<std::size_t, 2>());
      }
      if (l < nodes) {
        add_nodes(l, std::integral_constant<std::size_t, 1>());
      }
      const Lanes weight(line.weight[k]);
      for (std::size_t f = 0; f < count; ++f) {
        const Lanes one = weight * row[f][0];
        const Lanes along = weight * row[f][1];
        sums[f][0] += one;
        sums[f][1] = fma(s, one, sums[f][1]);
        sums[f][2] += along;
        sums[f][3] = fma(s, along, sums[f][3]);
      }
    }
    const Lanes area = p.du * p.dv;
    for (std::size_t f = 0; f < count; ++f) {
      const Lanes one = area * sums[f][0];
      const Lanes s = area * p.du * sums[f][1];
      const Lanes t = area * p.dv * sums[f][2];
      const Lanes st = area * area * sums[f][3];
      const Lanes u = fma(p.u, one, s);
      const Lanes v = fma(p.v, one, t);
      add(&list[i], end, 4 * f, one);
      add(&list[i], end, 4 * f + 1, u);
      add(&list[i], end, 4 * f + 2, v);
      add(&list[i], end, 4 * f + 3, fma(p.u, v, fma(p.v, s, st))); // (u0 + s)(v0 + t)
    }
  }

  HWY_INLINE void add(const Piece* pieces, std::size_t end, std::size_t moment, Lanes what) {
    alignas(64) std::array<double, lanes> values;
    what.store(values.data());
    for (std::size_t k = 0; k < end; ++k) {
      moments_[moment].of[pieces[k].point] += values[k];
    }
  }

  /// By Gauss and Newton's steps.
  static PatchPlace refined(const Patch& patch, const Vec3& x, PatchPlace place) {
    const std::array<Vec3, 4>& c = patch.position;
    for (int step = 0; step < 4; ++step) {
      const Vec3 along_u = c[1] + place.v * c[3];
      const Vec3 along_v = c[2] + place.u * c[3];
      const Vec3 off = (c[0] - x) + place.u * c[1] + place.v * along_v;
      const double uu = along_u.squaredNorm();
      const double uv = along_u.dot(along_v);
      const double vv = along_v.squaredNorm();
      const double det = uu * vv - uv * uv;
      if (!(det > 1e-20 * uu * vv)) {
        break;
      }
      const double a = along_u.dot(off);
      const double b = along_v.dot(off);
      place.u = std::clamp(place.u - (vv * a - uv * b) / det, 0.0, 1.0);
      place.v = std::clamp(place.v - (uu * b - uv * a) / det, 0.0, 1.0);
    }
    return place;
  }

  const PatchRule& rule_;
  double touching_;
  PieceList now_, next_;
  std::vector<PieceList> seen_; // for each choice of the rule
  std::array<Sixteen, 4 * count> moments_;
  std::uint32_t touched_ = 0;
  std::array<PatchPlace, 16> place_;
};

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
