/// \file
/// Elementary functions that give the same bits everywhere.
///
/// Those of the C library are free to differ in the last places: between libraries, and with one
/// library between processors, for it picks other code where multiplications and additions fuse. A
/// cage is made by thousands of comparisons, and one that turns out the other way makes another
/// cage. These are made of additions, multiplications and divisions alone, which IEEE 754 rounds
/// one way only. (So it does square roots, and std::sqrt, floor, ldexp and lround are used freely.)
///
/// Errors are bounded in units of the last place of the result (ulp); tests/core/maths_test.cpp
/// holds the bounds.
#pragma once

namespace cagewright::maths {

/// e^x, within 1 ulp; 0 and infinity beyond the range of double, at denormal results within one of
/// them.
double exp(double x);

/// The natural logarithm, within 1 ulp; -infinity at 0, NaN below.
double log(double x);

/// x^y for x >= 0, within 1 ulp where the result lies in [1e-6, 1e6], within 20 elsewhere; NaN for
/// x < 0, 1 for y = 0.
double pow(double x, double y);

/// Within 1 ulp for |x| <= 1e5 (absolutely within 1e-16 near the zeros); NaN where that is not
/// known.
double sin(double x);
double cos(double x);

/// The angle of (x, y) in [-pi, pi], within 2 ulp; signs at zeros and infinities as IEEE 754 has
/// them.
double atan2(double y, double x);

inline double square(double x) {
  return x * x;
}
inline double cube(double x) {
  return x * x * x;
}

} // namespace cagewright::maths
