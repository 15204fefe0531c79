#include <cagewright/mesh/triangulate.h>

#include <utility>

namespace cagewright {
namespace {

/// Twice the area vector of the polygon (Newell's method): its direction is the best normal.
Vec3 area_vector(std::span<const Vec3> positions, std::span<const Index> face) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = positions[face[0]];
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += (positions[face[i]] - origin).cross(positions[face[i + 1]] - origin);
  }
  return sum;
}

/// Twice the signed area of a b c seen along `normal`.
double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  return (b - a).cross(c - a).dot(normal);
}

class EarClipper {
public:
  EarClipper(std::span<const Vec3> positions, std::span<const Index> face)
      : positions_(positions), ring_(face.begin(), face.end()),
        normal_(area_vector(positions, face)) {}

  void clip(std::vector<Triangle>& triangles) {
    while (ring_.size() > 3) {
      const std::size_t ear = find_ear();
      triangles.push_back({at(ear + ring_.size() - 1), at(ear), at(ear + 1)});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.push_back({ring_[0], ring_[1], ring_[2]});
  }

private:
  [[nodiscard]] Index at(std::size_t i) const { return ring_[i % ring_.size()]; }
  [[nodiscard]] const Vec3& position(std::size_t i) const { return positions_[at(i)]; }

  /// The second corner is tried first, so that a convex polygon becomes a fan round its first.
  [[nodiscard]] std::size_t find_ear() const {
    for (std::size_t i = 1; i <= ring_.size(); ++i) {
      if (is_ear(i % ring_.size())) {
        return i % ring_.size();
      }
    }
    return 1; // a degenerate or self-crossing polygon: any cut is as good
  }

  [[nodiscard]] bool is_ear(std::size_t i) const {
    const std::size_t n = ring_.size();
    const Vec3& a = position(i + n - 1);
    const Vec3& b = position(i);
    const Vec3& c = position(i + 1);
    if (turn(a, b, c, normal_) <= 0) {
      return false;
    }
    for (std::size_t k = i + 2; k < i + n - 1; ++k) {
      const Vec3& p = position(k);
      if (turn(a, b, p, normal_) >= 0 && turn(b, c, p, normal_) >= 0 &&
          turn(c, a, p, normal_) >= 0) {
        return false;
      }
    }
    return true;
  }

  std::span<const Vec3> positions_;
  std::vector<Index> ring_;
  Vec3 normal_;
};

void cut_quad(std::span<const Vec3> x, std::span<const Index> q, std::vector<Triangle>& triangles) {
  const Vec3 normal = area_vector(x, q);
  const auto convex_at = [&](std::size_t i) {
    return turn(x[q[(i + 3) % 4]], x[q[i]], x[q[(i + 1) % 4]], normal) >= 0;
  };
  if (convex_at(1) && convex_at(3)) {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  } else {
    triangles.push_back({q[1], q[2], q[3]});
    triangles.push_back({q[1], q[3], q[0]});
  }
}

} // namespace

Triangulation triangulate(const PolygonMesh& mesh) {
  Triangulation result;
  result.triangles.reserve(mesh.corners().size());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    if (face.size() == 3) {
      result.triangles.push_back({face[0], face[1], face[2]});
    } else if (face.size() == 4) {
      cut_quad(mesh.positions, face, result.triangles);
    } else {
      EarClipper(mesh.positions, face).clip(result.triangles);
    }
    result.face_of.resize(result.triangles.size(), static_cast<Index>(f));
  }
  return result;
}

TriangleMesh to_triangle_mesh(const PolygonMesh& mesh) {
  return {mesh.positions, triangulate(mesh).triangles};
}

} // namespace cagewright
