#include <cagewright/validate/every_cutting.h>

#include "exact/predicates.h"
#include "mesh/concave.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <span>

namespace cagewright {
namespace {

constexpr std::size_t most_corners_of_all = 8;
constexpr std::size_t most_corners_of_fans = 32;

class OtherCuttings {
public:
  OtherCuttings(const PolygonMesh& mesh, Triangulation& result) : mesh_(mesh), result_(result) {}

  /// \param own  the face's triangles in triangulate()
  void add(Index f, std::span<const Triangle> own) {
    const std::span<const Index> face = mesh_.face(f);
    if (is_flat(face) && !(face.size() == 4 && concave_corner(mesh_.positions, face))) {
      return;
    }
    known_.clear();
    for (const Triangle& t : own) {
      known_.insert(sorted(t));
    }
    const std::size_t n = face.size();
    if (n == 4) {
      for (std::size_t i = 0; i < n; ++i) {
        add_new(f, {face[i], face[(i + 1) % n], face[(i + 2) % n]});
      }
    } else if (n <= most_corners_of_all) {
      add_all(f, face);
    } else {
      const std::size_t fans = n <= most_corners_of_fans ? n : 1;
      for (std::size_t center = 0; center < fans; ++center) {
        for (std::size_t k = 1; k + 1 < n; ++k) {
          add_new(f, {face[center], face[(center + k) % n], face[(center + k + 1) % n]});
        }
      }
    }
  }

private:
  static Triangle sorted(Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  }

  /// Whether all corners are in one plane, exactly: then every way to cut the face covers the same.
  [[nodiscard]] bool is_flat(std::span<const Index> face) const {
    const auto p = [&](std::size_t i) -> const Vec3& { return mesh_.positions[face[i]]; };
    for (std::size_t i = 0; i + 3 < face.size(); ++i) { // corners on a line decide nothing
      for (std::size_t j = i + 3; j < face.size(); ++j) {
        if (orient3d(p(i), p(i + 1), p(i + 2), p(j)) != 0) {
          return false;
        }
      }
    }
    return true;
  }

  void add_all(Index f, std::span<const Index> face) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      for (std::size_t j = i + 1; j < face.size(); ++j) {
        for (std::size_t k = j + 1; k < face.size(); ++k) {
          add_new(f, {face[i], face[j], face[k]});
        }
      }
    }
  }

  void add_new(Index f, const Triangle& t) {
    if (known_.insert(sorted(t)).second) {
      result_.triangles.push_back(t);
      result_.face_of.push_back(f);
    }
  }

  const PolygonMesh& mesh_;
  Triangulation& result_;
  std::set<Triangle> known_; // of the face under way, corners ascending
};

} // namespace

Triangulation every_cutting(const PolygonMesh& mesh) {
  Triangulation result = triangulate(mesh);
  const std::size_t own = result.triangles.size();
  OtherCuttings others(mesh, result);
  std::vector<Triangle> of_face;
  for (std::size_t t = 0; t < own; ++t) {
    const Index f = result.face_of[t];
    of_face.push_back(result.triangles[t]);
    if (t + 1 < own && result.face_of[t + 1] == f) {
      continue;
    }
    if (of_face.size() > 1) {
      others.add(f, of_face);
    }
    of_face.clear();
  }
  return result;
}

} // namespace cagewright
