#include "app/edit/surface_pick.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cagewright::app {
namespace {

constexpr std::size_t block = 16384;

/// Möller and Trumbore 1997.
std::optional<SurfacePoint> hit(TriangleView mesh, Index t, const Ray& sight) {
  const Triangle& corners = mesh.triangles[t];
  const Vec3& a = mesh.positions[corners[0]];
  const Vec3 u = mesh.positions[corners[1]] - a;
  const Vec3 v = mesh.positions[corners[2]] - a;
  const Vec3 p = sight.direction.cross(v);
  const double det = u.dot(p);
  if (det == 0) {
    return std::nullopt;
  }
  const Vec3 s = sight.origin - a;
  const double b = s.dot(p) / det;
  const Vec3 q = s.cross(u);
  const double c = sight.direction.dot(q) / det;
  const double distance = v.dot(q) / det;
  if (!(b >= 0 && c >= 0 && b + c <= 1 && distance > 0)) {
    return std::nullopt;
  }
  return SurfacePoint{t, {1 - b - c, b, c}, distance};
}

} // namespace

std::optional<SurfacePoint> first_surface_point(TriangleView mesh, const Ray& sight) {
  const std::size_t count = mesh.triangles.size();
  std::vector<std::optional<SurfacePoint>> found((count + block - 1) / block);
  parallel_for(0, found.size(), 1, [&](std::size_t i) {
    for (std::size_t t = i * block; t < std::min(count, (i + 1) * block); ++t) {
      const std::optional<SurfacePoint> here = hit(mesh, static_cast<Index>(t), sight);
      if (here && (!found[i] || here->distance < found[i]->distance)) {
        found[i] = here;
      }
    }
  });
  std::optional<SurfacePoint> first;
  for (const std::optional<SurfacePoint>& f : found) {
    if (f && (!first || f->distance < first->distance)) {
      first = f;
    }
  }
  return first;
}

} // namespace cagewright::app
