// Small symmetric systems, for Newton's method in three unknowns, for one point or several side by
// side. Included once for each instruction set by *_simd.cpp. Internal to this module.

#if defined(CAGEWRIGHT_COORDINATES_CONVEX_SOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAGEWRIGHT_COORDINATES_CONVEX_SOLVE_INL_H_
#undef CAGEWRIGHT_COORDINATES_CONVEX_SOLVE_INL_H_
#else
#define CAGEWRIGHT_COORDINATES_CONVEX_SOLVE_INL_H_
#endif

#include "coordinates/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {

template <class V> struct Three { V x, y, z; };

template <class V> HWY_INLINE V dot(const Three<V>& a, const Three<V>& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}

/// A symmetric matrix.
template <class V> struct Symmetric { V xx, xy, xz, yy, yz, zz; };

/// The solution of m s = b for a positive definite m; a pivot that is not positive is taken as a
/// tiny part of the largest.
template <class V> HWY_INLINE Three<V> solve(const Symmetric<V>& m, const Three<V>& b) {
  const V least = (m.xx + m.yy + m.zz) * V(1e-30) + V(1e-290);
  const V one(1.0);
  const V ix = one / larger(m.xx, least);
  const V lyx = m.xy * ix;
  const V lzx = m.xz * ix;
  const V iy = one / larger(m.yy - lyx * m.xy, least);
  const V zy = m.yz - lzx * m.xy;
  const V lzy = zy * iy;
  const V iz = one / larger(m.zz - lzx * m.xz - lzy * zy, least);
  const V fy = b.y - lyx * b.x;
  const V fz = b.z - lzx * b.x - lzy * fy;
  const V z = fz * iz;
  const V y = fy * iy - lzy * z;
  return {b.x * ix - lyx * y - lzx * z, y, z};
}

/// Loads a number for each lane; for one point, the number.
template <class V> HWY_INLINE V load_at(const double* values, std::size_t index);
template <> HWY_INLINE Lanes load_at<Lanes>(const double* values, std::size_t index) {
  return Lanes::load(values + index * lanes);
}
template <> HWY_INLINE double load_at<double>(const double* values, std::size_t index) {
  return values[index];
}
HWY_INLINE void store_at(Lanes v, double* values, std::size_t index) {
  v.store(values + index * lanes);
}
HWY_INLINE void store_at(double v, double* values, std::size_t index) {
  values[index] = v;
}

} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#endif
