// Integrals over bilinear patches that are nearly singular close by: the parameter square is split
// until each piece is small as seen from the point, and Gauss's rule does the rest, its nodes side
// by side. Included once for each instruction set by *_simd.cpp. Internal to this module.

#if defined(CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#undef CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_PATCH_QUADRATURE_INL_H_
#endif

#include "coordinates/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

/// Integrals of functions times 1, u, v, u v.
struct PatchMoments {
  std::array<double, 4> of = {};

  /// Of the four hats times the functions.
  [[nodiscard]] std::array<double, 4> with_hats() const {
    const auto& [one, u, v, uv] = of;
    return {one - u - v + uv, u - uv, uv, v - uv};
  }
};

/// Where a point lies on a patch.
struct PatchPlace {
  bool is_on = false;
  double u = 0;
  double v = 0;
};

/// Splits the parameter square of a patch, and calls `integrate` for each piece.
class PatchPieces {
public:
  /// \param touching  nearer than this a point lies on the patch
  PatchPieces(const Patch& patch, const Vec3& x, double touching)
      : patch_(patch), x_(x), touching_(touching) {}

  /// \param integrate  called with the corner (u, v) and the side of a piece
  /// \returns where the point lies on the patch; then not all pieces were called
  template <class Integrate> PatchPlace for_each(const Integrate& integrate) {
    struct Piece {
      double u, v, side;
    };
    constexpr double seen_under = 0.5; // radius over distance
    std::array<Piece, 128> stack;
    std::size_t count = 0;
    stack[count++] = {0, 0, 1};
    while (count > 0) {
      const Piece piece = stack[--count];
      const double half = piece.side / 2;
      const Vec3 middle = at(piece.u + half, piece.v + half);
      double radius2 = 0;
      for (const double u : {piece.u, piece.u + piece.side}) {
        for (const double v : {piece.v, piece.v + piece.side}) {
          radius2 = std::max(radius2, (at(u, v) - middle).squaredNorm());
        }
      }
      const double distance2 = middle.squaredNorm();
      if (radius2 < seen_under * seen_under * distance2) {
        integrate(piece.u, piece.v, piece.side);
      } else if (distance2 < touching_ * touching_ && radius2 < touching_ * touching_) {
        return refined(piece.u + half, piece.v + half);
      } else if (count + 4 <= stack.size()) {
        for (const double u : {piece.u, piece.u + half}) {
          for (const double v : {piece.v, piece.v + half}) {
            stack[count++] = {u, v, half};
          }
        }
      }
    }
    return {};
  }

private:
  [[nodiscard]] Vec3 at(double u, double v) const {
    const std::array<Vec3, 4>& c = patch_.position;
    return (c[0] - x_) + u * c[1] + v * c[2] + u * v * c[3];
  }

  /// The nearest place, by Gauss and Newton's steps.
  [[nodiscard]] PatchPlace refined(double u, double v) const {
    const std::array<Vec3, 4>& c = patch_.position;
    for (int step = 0; step < 4; ++step) {
      const Vec3 along_u = c[1] + v * c[3];
      const Vec3 along_v = c[2] + u * c[3];
      const Vec3 off = at(u, v);
      const double uu = along_u.squaredNorm();
      const double uv = along_u.dot(along_v);
      const double vv = along_v.squaredNorm();
      const double det = uu * vv - uv * uv;
      if (!(det > 1e-20 * uu * vv)) {
        break;
      }
      const double a = along_u.dot(off);
      const double b = along_v.dot(off);
      u = std::clamp(u - (vv * a - uv * b) / det, 0.0, 1.0);
      v = std::clamp(v - (uu * b - uv * a) / det, 0.0, 1.0);
    }
    return {true, u, v};
  }

  const Patch& patch_;
  Vec3 x_;
  double touching_;
};

/// What a node of a piece contributes: P - x and N there.
struct PatchNode {
  Lanes x, y, z;    ///< P - x
  Lanes nx, ny, nz; ///< N
};

/// Adds the integrals of `count` functions over a piece. `value(node, values)` gives the functions.
template <std::size_t count, class Value>
HWY_INLINE void integrate_piece(const Patch& patch, const Vec3& x, const SquareRule& rule,
                                double u0, double v0, double side, const Value& value,
                                std::array<PatchMoments, count>& moments) {
  const std::array<Vec3, 4>& c = patch.position;
  const std::array<Vec3, 3>& n = patch.normal;
  const Vec3 origin = c[0] - x;
  Lanes sums[count][4];
  for (auto& of : sums) {
    for (Lanes& sum : of) {
      sum = Lanes(0.0);
    }
  }
  for (std::size_t i = 0; i < rule.weight.size(); i += lanes) {
    const Lanes u = fma(Lanes(side), Lanes(hn::LoadU(LaneTag(), &rule.u[i])), Lanes(u0));
    const Lanes v = fma(Lanes(side), Lanes(hn::LoadU(LaneTag(), &rule.v[i])), Lanes(v0));
    const Lanes uv = u * v;
    const auto bilinear = [&](Eigen::Index k) HWY_ATTR {
      return fma(uv, Lanes(c[3][k]),
                 fma(v, Lanes(c[2][k]), fma(u, Lanes(c[1][k]), Lanes(origin[k]))));
    };
    const auto affine = [&](Eigen::Index k) HWY_ATTR {
      return fma(v, Lanes(n[2][k]), fma(u, Lanes(n[1][k]), Lanes(n[0][k])));
    };
    const PatchNode node{bilinear(0), bilinear(1), bilinear(2), affine(0), affine(1), affine(2)};
    const Lanes weight(hn::LoadU(LaneTag(), &rule.weight[i]));
    Lanes values[count];
    value(node, values);
    for (std::size_t f = 0; f < count; ++f) {
      const Lanes here = values[f] * weight;
      sums[f][0] += here;
      sums[f][1] = fma(here, u, sums[f][1]);
      sums[f][2] = fma(here, v, sums[f][2]);
      sums[f][3] = fma(here, uv, sums[f][3]);
    }
  }
  for (std::size_t f = 0; f < count; ++f) {
    for (std::size_t k = 0; k < 4; ++k) {
      moments[f].of[k] += side * side * hn::GetLane(hn::SumOfLanes(LaneTag(), sums[f][k].v));
    }
  }
}

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
