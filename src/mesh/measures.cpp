#include <cagewright/mesh/measures.h>

namespace cagewright {

Box3 bounding_box(std::span<const Vec3> points) {
  Box3 box;
  for (const Vec3& p : points) {
    box.extend(p);
  }
  return box;
}

double diagonal(std::span<const Vec3> points) {
  return points.empty() ? 0.0 : bounding_box(points).diagonal().norm();
}

Box3 bounding_box(TriangleView mesh) {
  Box3 box;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) {
      box.extend(mesh.positions[v]);
    }
  }
  return box;
}

double surface_area(TriangleView mesh) {
  double twice = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[t[0]];
    twice += (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
  }
  return twice / 2;
}

double signed_volume(TriangleView mesh) {
  return mesh.triangles.empty() ? 0 : signed_volume(mesh, bounding_box(mesh).center());
}

double signed_volume(TriangleView mesh, const Vec3& origin) {
  double six_times = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.positions[t[0]] - origin;
    const Vec3 b = mesh.positions[t[1]] - origin;
    const Vec3 c = mesh.positions[t[2]] - origin;
    six_times += a.dot(b.cross(c));
  }
  return six_times / 6;
}

Vec3 triangle_normal(TriangleView mesh, const Triangle& triangle) {
  const Vec3& a = mesh.positions[triangle[0]];
  const Vec3 n = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
  const double length = n.norm();
  return length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

double triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = (b - a).norm();
  const double bc = (c - b).norm();
  const double ca = (a - c).norm();
  const double product = ab * bc * ca;
  if (product <= 0) {
    return 0;
  }
  // 2 r / R = 8 (s - ab) (s - bc) (s - ca) / (ab bc ca), with s half the perimeter; the area by a
  // cross product is more accurate for needles: r = area / s, R = ab bc ca / (4 area).
  const double area = (b - a).cross(c - a).norm() / 2;
  return 16 * area * area / (product * (ab + bc + ca));
}

} // namespace cagewright
