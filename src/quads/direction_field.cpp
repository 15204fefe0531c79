#include "quads/direction_field.h"

#include "core/maths.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace cagewright {
namespace {

using Complex = std::complex<double>;

struct Tangents {
  Vec3 x;
  Vec3 y;
};

/// A frame of the plane at right angles to the normal.
Tangents tangents(const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Vec3 x = normal.cross(Vec3::Unit(axis)).normalized();
  return {x, normal.cross(x)};
}

// Not std::abs, which is the C library's hypot.
double length(const Complex& z) {
  return std::sqrt(z.real() * z.real() + z.imag() * z.imag());
}

Complex in_plane(const Tangents& frame, const Vec3& v) {
  const Complex z(frame.x.dot(v), frame.y.dot(v));
  const double size = length(z);
  return size > 0 ? z / size : Complex(0);
}

Vec3 area_of(std::span<const Vec3> x, const Triangle& t) {
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

Complex fourth_power(const Complex& z) {
  return z * z * z * z;
}

} // namespace

DirectionField::DirectionField(TriangleView cage)
    : normals_(cage.positions.size(), Vec3::Zero()),
      directions_(cage.positions.size(), Vec3::UnitX()), clarity_(cage.positions.size(), 0) {
  const std::span<const Vec3> x = cage.positions;
  const QuadCage mesh(cage);
  const std::size_t count = x.size();
  for (const Triangle& t : cage.triangles) {
    const Vec3 area = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
    for (const Index v : t) {
      normals_[v] += area;
    }
  }
  for (Vec3& n : normals_) {
    n = n.squaredNorm() > 0 ? Vec3(n.normalized()) : Vec3::UnitZ();
  }
  // Each edge bends the surface about its own direction.
  std::vector<std::vector<Index>> neighbors(count);
  std::vector<Mat3> own(count, Mat3::Zero());
  for (const Triangle& t : cage.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Index a = t[i];
      const Index b = t[(i + 1) % 3];
      neighbors[a].push_back(b);
      const Index other = mesh.face_left_of(b, a);
      if (other == no_index) {
        neighbors[b].push_back(a); // the border: no face runs from b to a
        continue;
      }
      if (b < a) {
        continue;
      }
      const Vec3 m = area_of(x, t);
      const CageFace& face = mesh.face(other);
      const Vec3 n = area_of(x, {face[0], face[1], face[2]});
      const Vec3 edge = x[b] - x[a];
      const double bend = maths::atan2(m.cross(n).dot(edge.normalized()), m.dot(n));
      const Mat3 part = bend / std::max(edge.norm(), 1e-300) * edge * edge.transpose();
      own[a] += part;
      own[b] += part;
    }
  }
  std::vector<Mat3> wide = own;
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<Mat3> before = wide;
    for (std::size_t v = 0; v < count; ++v) {
      for (const Index w : neighbors[v]) {
        wide[v] += 0.5 * before[w];
      }
    }
  }
  std::vector<Tangents> frames(count);
  std::vector<Complex> seen(count, 0);
  for (std::size_t v = 0; v < count; ++v) {
    frames[v] = tangents(normals_[v]);
    const auto entry = [&](const Vec3& a, const Vec3& b) { return a.dot(wide[v] * b); };
    const double xx = entry(frames[v].x, frames[v].x);
    const double yy = entry(frames[v].y, frames[v].y);
    const double xy = entry(frames[v].x, frames[v].y);
    const double mean = (xx + yy) / 2;
    const Complex twice((xx - yy) / 2, xy); // turns by twice the angle
    const double size = length(twice);
    clarity_[v] = size > 0 ? size / (size + std::abs(mean)) : 0;
    seen[v] = size > 0 ? clarity_[v] * (twice / size) * (twice / size) : Complex(0);
  }
  // Of four directions only the fourth power counts. A neighbour's turns with the edge.
  std::vector<Complex> field = seen;
  constexpr int sweeps = 20;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    const std::vector<Complex> before = field;
    for (Index v = 0; v < count; ++v) {
      Complex sum = 0;
      for (const Index w : neighbors[v]) {
        const Complex here = fourth_power(in_plane(frames[v], x[w] - x[v]));
        const Complex there = fourth_power(in_plane(frames[w], x[w] - x[v]));
        sum += before[w] * here * std::conj(there);
      }
      sum /= static_cast<double>(std::max<std::size_t>(1, neighbors[v].size()));
      field[v] = seen[v] + sum;
      const double size = length(field[v]);
      field[v] = size > 1 ? field[v] / size : field[v];
    }
  }
  for (std::size_t v = 0; v < count; ++v) {
    const double angle = maths::atan2(field[v].imag(), field[v].real()) / 4;
    directions_[v] = maths::cos(angle) * frames[v].x + maths::sin(angle) * frames[v].y;
    clarity_[v] = std::min(1.0, length(field[v]));
  }
}

double DirectionField::misalignment_at(Index v, const Vec3& way) const {
  const Vec3& n = normals_[v];
  const Vec3 y = n.cross(directions_[v]);
  const double along = maths::square(directions_[v].dot(way));
  const double across = maths::square(y.dot(way));
  const double length = along + across;
  if (!(length > 0)) {
    return 0;
  }
  // (1 - cos 4a) / 2 = sin^2 2a
  return clarity_[v] * 4 * (along / length) * (across / length);
}

double DirectionField::misalignment(Index a, Index b, const Vec3& way) const {
  return (misalignment_at(a, way) + misalignment_at(b, way)) / 2;
}

} // namespace cagewright
