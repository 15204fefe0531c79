#include "mesh/turn.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <cmath>

namespace cagewright {

int turn(const Vec3& a, const Vec3& b, const Vec3& c, const PlaneView& view) {
  const int u = view.axis == 2 ? 0 : view.axis + 1;
  const int v = view.axis == 0 ? 2 : view.axis - 1;
  const int side = view.flipped ? -1 : 1;
  const double left = (b[u] - a[u]) * (c[v] - a[v]);
  const double right = (b[v] - a[v]) * (c[u] - a[u]);
  // Shewchuk's first filter; the constant covers what underflow may have cost.
  const double bound = 3.4e-16 * (std::abs(left) + std::abs(right)) + 1e-200;
  if (left - right > bound) {
    return side;
  }
  if (left - right < -bound) {
    return -side;
  }
  using Exact = boost::multiprecision::cpp_rational;
  const Exact x = a[u];
  const Exact y = a[v];
  const Exact det = (Exact(b[u]) - x) * (Exact(c[v]) - y) - (Exact(b[v]) - y) * (Exact(c[u]) - x);
  return side * det.sign();
}

} // namespace cagewright
