// Numbers side by side in a vector register that can be written like one number, so that a formula
// is written once, for a point in plain doubles and for several at a time. Included once for each
// instruction set by *_simd.cpp, behind hwy/foreach_target.h and hwy/highway.h. Internal to this
// module.

#if defined(CAGEWRIGHT_COORDINATES_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_LANES_INL_H_
#undef CAGEWRIGHT_COORDINATES_LANES_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_LANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using LaneTag = hn::CappedTag<double, 16>;
constexpr std::size_t lanes = hn::MaxLanes(LaneTag());

struct Mask {
  hn::Mask<LaneTag> m;
};

struct Lanes {
  hn::VFromD<LaneTag> v;

  Lanes() = default;
  HWY_INLINE explicit Lanes(hn::VFromD<LaneTag> value) : v(value) {}
  HWY_INLINE Lanes(double value) : v(hn::Set(LaneTag(), value)) {}

  HWY_INLINE static Lanes load(const double* from) { return Lanes(hn::Load(LaneTag(), from)); }
  HWY_INLINE void store(double* to) const { hn::Store(v, LaneTag(), to); }
  HWY_INLINE void store_unaligned(double* to) const { hn::StoreU(v, LaneTag(), to); }

  HWY_INLINE Lanes& operator+=(Lanes b) {
    v = hn::Add(v, b.v);
    return *this;
  }
  HWY_INLINE Lanes& operator-=(Lanes b) {
    v = hn::Sub(v, b.v);
    return *this;
  }
  HWY_INLINE Lanes& operator*=(Lanes b) {
    v = hn::Mul(v, b.v);
    return *this;
  }
};

HWY_INLINE Lanes operator+(Lanes a, Lanes b) {
  return Lanes(hn::Add(a.v, b.v));
}
HWY_INLINE Lanes operator-(Lanes a, Lanes b) {
  return Lanes(hn::Sub(a.v, b.v));
}
HWY_INLINE Lanes operator*(Lanes a, Lanes b) {
  return Lanes(hn::Mul(a.v, b.v));
}
HWY_INLINE Lanes operator/(Lanes a, Lanes b) {
  return Lanes(hn::Div(a.v, b.v));
}
HWY_INLINE Lanes operator-(Lanes a) {
  return Lanes(hn::Neg(a.v));
}
HWY_INLINE Mask operator<(Lanes a, Lanes b) {
  return {hn::Lt(a.v, b.v)};
}
HWY_INLINE Mask operator>(Lanes a, Lanes b) {
  return {hn::Gt(a.v, b.v)};
}
HWY_INLINE Mask operator&(Mask a, Mask b) {
  return {hn::And(a.m, b.m)};
}
HWY_INLINE Mask operator|(Mask a, Mask b) {
  return {hn::Or(a.m, b.m)};
}

/// a b + c
HWY_INLINE Lanes fma(Lanes a, Lanes b, Lanes c) {
  return Lanes(hn::MulAdd(a.v, b.v, c.v));
}
HWY_INLINE double fma(double a, double b, double c) {
  return a * b + c;
}
HWY_INLINE Lanes root(Lanes a) {
  return Lanes(hn::Sqrt(a.v));
}
HWY_INLINE double root(double a) {
  return std::sqrt(a);
}
HWY_INLINE Lanes absolute(Lanes a) {
  return Lanes(hn::Abs(a.v));
}
HWY_INLINE double absolute(double a) {
  return std::abs(a);
}
HWY_INLINE Lanes larger(Lanes a, Lanes b) {
  return Lanes(hn::Max(a.v, b.v));
}
HWY_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
HWY_INLINE Lanes smaller(Lanes a, Lanes b) {
  return Lanes(hn::Min(a.v, b.v));
}
HWY_INLINE double smaller(double a, double b) {
  return a < b ? a : b;
}
HWY_INLINE Lanes select(Mask choose, Lanes yes, Lanes no) {
  return Lanes(hn::IfThenElse(choose.m, yes.v, no.v));
}
HWY_INLINE double select(bool choose, double yes, double no) {
  return choose ? yes : no;
}
HWY_INLINE bool none_of(Mask m) {
  return hn::AllFalse(LaneTag(), m.m);
}
HWY_INLINE bool none_of(bool m) {
  return !m;
}

/// One for each lane of the mask, for code lane by lane.
struct LaneFlags {
  alignas(64) std::array<double, lanes> flag;
  HWY_INLINE explicit LaneFlags(Mask m) {
    hn::Store(hn::IfThenElseZero(m.m, hn::Set(LaneTag(), 1.0)), LaneTag(), flag.data());
  }
  HWY_INLINE bool operator[](std::size_t i) const { return flag[i] != 0; }
};

/// Horner's rule in two chains, for the coefficients of x^0, x^1, ...
template <class V, std::size_t n> HWY_INLINE V polynomial(const std::array<double, n>& c, V x) {
  const V x2 = x * x;
  V even(c[(n - 1) / 2 * 2]);
  V odd(c[(n - 2) / 2 * 2 + 1]);
  for (std::size_t k = (n - 1) / 2; k-- > 0;) {
    even = fma(even, x2, V(c[2 * k]));
  }
  for (std::size_t k = (n - 2) / 2; k-- > 0;) {
    odd = fma(odd, x2, V(c[2 * k + 1]));
  }
  return fma(odd, x, even);
}

/// atanh(x) for |x| <= 0.1716 = (sqrt 2 - 1) / (sqrt 2 + 1).
template <class V> HWY_INLINE V small_atanh(V x) {
  constexpr std::array<double, 11> c = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13,
                                        1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23};
  const V z = x * x;
  return fma(x * z, polynomial(c, z), x);
}

/// x = 2^exponent * mantissa with the mantissa in [sqrt 1/2, sqrt 2), for normal x > 0.
HWY_INLINE void split(Lanes x, Lanes& mantissa, Lanes& exponent) {
  const LaneTag d;
  const hn::Rebind<std::int64_t, LaneTag> di;
  const auto bits = hn::BitCast(di, x.v);
  // Adding the difference of 1 and sqrt 1/2 carries into the exponent from sqrt 2 on.
  const auto offset = hn::Set(di, 0x3ff0000000000000LL - 0x3fe6a09e667f3bcdLL);
  const auto shifted = hn::Add(bits, offset);
  const hn::Rebind<std::uint64_t, LaneTag> du;
  const auto power = hn::ShiftRight<52>(hn::BitCast(du, shifted));
  // To double without a conversion, which older processors lack: 2^52 + power, minus 2^52.
  const auto magic = hn::Set(du, 0x4330000000000000ULL);
  exponent = Lanes(hn::Sub(hn::BitCast(d, hn::Or(power, magic)), hn::Set(d, 0x1p52 + 1023.0)));
  const auto kept = hn::And(shifted, hn::Set(di, 0x000fffffffffffffLL));
  mantissa = Lanes(hn::BitCast(d, hn::Add(kept, hn::Set(di, 0x3fe6a09e667f3bcdLL))));
}
HWY_INLINE void split(double x, double& mantissa, double& exponent) {
  int power = 0;
  mantissa = std::frexp(x, &power); // in [1/2, 1)
  if (mantissa < 0.70710678118654752) {
    mantissa *= 2;
    power -= 1;
  }
  exponent = power;
}

/// The natural logarithm of normal x > 0, within about an ulp (absolutely 1e-16 near x = 1).
template <class V> HWY_INLINE V logarithm(V x) {
  V mantissa;
  V exponent;
  split(x, mantissa, exponent);
  const V ratio = (mantissa - V(1)) / (mantissa + V(1));
  constexpr double ln2_high = 0x1.62e42fefa3800p-1; // 42 bits: its multiples are exact
  constexpr double ln2_low = 0x1.ef35793c76730p-45;
  const V main = small_atanh(ratio);
  return fma(exponent, V(ln2_high), fma(exponent, V(ln2_low), main + main));
}

/// e^x for -700 < x < 700, within about an ulp; 0 below.
HWY_INLINE Lanes power_of_two(Lanes n) {
  const LaneTag d;
  const hn::Rebind<std::uint64_t, LaneTag> du;
  const auto bits = hn::BitCast(du, hn::Add(n.v, hn::Set(d, 0x1.8p52 + 1023.0)));
  return Lanes(hn::BitCast(d, hn::ShiftLeft<52>(bits)));
}
HWY_INLINE double power_of_two(double n) {
  return std::ldexp(1.0, static_cast<int>(n));
}
HWY_INLINE Lanes nearest_integer(Lanes x) {
  return Lanes(hn::Round(x.v));
}
HWY_INLINE double nearest_integer(double x) {
  return std::nearbyint(x);
}
template <class V> HWY_INLINE V exponential(V x) {
  constexpr std::array<double, 12> c = {1.0 / 2,        1.0 / 6,         1.0 / 24,
                                        1.0 / 120,      1.0 / 720,       1.0 / 5040,
                                        1.0 / 40320,    1.0 / 362880,    1.0 / 3628800,
                                        1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800.0};
  constexpr double ln2_high = 0x1.62e42fefa3800p-1;
  constexpr double ln2_low = 0x1.ef35793c76730p-45;
  const V clamped = larger(x, V(-708.0));
  const V n = nearest_integer(clamped * V(0x1.71547652b82fep+0));
  const V r = fma(n, V(-ln2_low), fma(n, V(-ln2_high), clamped));
  const V value = fma(r * r, polynomial(c, r), r + V(1)) * power_of_two(n);
  return select(x < V(-708.0), V(0.0), value);
}

/// The angle of (x, y) in [-pi, pi], within some 1e-16; 0 at (0, 0).
template <class V> HWY_INLINE V angle_of(V y, V x) {
  // atan t = t + t z P(z) / Q(z), z = t^2, for |t| <= 0.66 (S. Moshier's Cephes).
  constexpr std::array<double, 5> p = {-6.485021904942025371773E1, -1.228866684490136173410E2,
                                       -7.500855792314704667340E1, -1.615753718733365076637E1,
                                       -8.750608600031904122785E-1};
  constexpr std::array<double, 6> q = {1.945506571482613964425E2, 4.853903996359136964868E2,
                                       4.328810604912902668951E2, 1.650270098316988542046E2,
                                       2.485846490142306297962E1, 1.0};
  constexpr double quarter = 0.78539816339744830962;
  const V ay = absolute(y);
  const V ax = absolute(x);
  const V low = smaller(ax, ay);
  const V high = larger(larger(ax, ay), V(1e-300));
  // Up to tan(pi / 8) as it is, beyond that from the diagonal, with one division.
  const auto steep = low > high * V(0.41421356237309503);
  const V t = select(steep, low - high, low) / select(steep, low + high, high);
  const V z = t * t;
  V angle = fma(t * z, polynomial(p, z) / polynomial(q, z), t);
  angle = select(steep, angle + V(quarter), angle);
  angle = select(ay > ax, V(2 * quarter) - angle, angle);
  angle = select(x < V(0.0), V(4 * quarter) - angle, angle);
  return select(y < V(0.0), -angle, angle);
}

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
