#include "app/edit/outlined_faces.h"

#include "app/edit/pick.h"
#include "core/parallel.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <numeric>
#include <optional>

namespace cagewright::app {
namespace {

class Onlooker {
public:
  Onlooker(const PolygonMesh& mesh, const TriangleBvh& bvh, const OrbitCamera& camera)
      : mesh_(mesh), bvh_(bvh), camera_(camera), cut_(triangulate(mesh)),
        first_(mesh.face_count() + 1, 0), tolerance_(1e-6 * diagonal(mesh.positions)) {
    for (const Index face : cut_.face_of) {
      ++first_[face + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  [[nodiscard]] Vec3 middle(Index face) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : mesh_.face(face)) {
      sum += mesh_.positions[v];
    }
    return sum / static_cast<double>(mesh_.face(face).size());
  }

  /// A face need not be flat, so its triangles are looked at; and parts of them may be hidden.
  [[nodiscard]] bool sees(Index face) const {
    for (std::size_t t = first_[face]; t < first_[face + 1]; ++t) {
      const auto& [a, b, c] = cut_.triangles[t];
      const Vec3 center = (mesh_.positions[a] + mesh_.positions[b] + mesh_.positions[c]) / 3;
      if (sees_point(center)) {
        return true;
      }
      for (const Index v : {a, b, c}) {
        if (sees_point(0.25 * center + 0.75 * mesh_.positions[v])) {
          return true;
        }
      }
    }
    return false;
  }

private:
  /// What lies at the point itself is not before it: a model may have the same face twice.
  [[nodiscard]] bool sees_point(const Vec3& p) const {
    const std::optional<Projected> at = camera_.project(p);
    if (!at) {
      return false;
    }
    const Ray sight = camera_.ray(at->pixel);
    const double distance = (p - sight.origin).dot(sight.direction);
    return !bvh_.first_hit(sight.origin, sight.direction, distance - tolerance_);
  }

  const PolygonMesh& mesh_;
  const TriangleBvh& bvh_;
  const OrbitCamera& camera_;
  Triangulation cut_;
  std::vector<std::size_t> first_; // triangle of each face, as they are in order of the faces
  double tolerance_;
};

} // namespace

Result<std::vector<Index>> outlined_faces(const PolygonMesh& mesh, const TriangleBvh& bvh,
                                          const ScreenOutline& outline, const Progress& progress) {
  const Onlooker onlooker(mesh, bvh, outline.camera);
  std::vector<char> is_within(mesh.face_count(), 0);
  parallel_for(0, is_within.size(), 1024, progress, [&](std::size_t i) {
    const auto face = static_cast<Index>(i);
    const std::optional<Projected> middle = outline.camera.project(onlooker.middle(face));
    is_within[i] = middle && contains(outline.pixels, middle->pixel) &&
                           (outline.see_through || onlooker.sees(face))
                       ? 1
                       : 0;
  });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  std::vector<Index> faces;
  for (Index f = 0; f < is_within.size(); ++f) {
    if (is_within[f] != 0) {
      faces.push_back(f);
    }
  }
  return faces;
}

} // namespace cagewright::app
