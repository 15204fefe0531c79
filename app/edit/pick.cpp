#include "app/edit/pick.h"

#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cagewright::app {
namespace {

// Elements whose distances from the cursor differ by less are told apart by depth.
constexpr double tie_pixels = 1.5;

double cross(const Pixel& a, const Pixel& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool segments_cross(const Pixel& a, const Pixel& b, const Pixel& c, const Pixel& d) {
  const double c_side = cross(b - a, c - a);
  const double d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c);
  const double b_side = cross(d - c, b - c);
  return (c_side > 0) != (d_side > 0) && (a_side > 0) != (b_side > 0);
}

bool reaches_into(std::span<const Pixel> outline, const Pixel& a, const Pixel& b) {
  if (contains(outline, a) || contains(outline, b)) {
    return true;
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    if (segments_cross(a, b, outline[i], outline[(i + 1) % outline.size()])) {
      return true;
    }
  }
  return false;
}

} // namespace

std::vector<Pixel> rectangle(const Pixel& a, const Pixel& b) {
  return {a, {b.x(), a.y()}, b, {a.x(), b.y()}};
}

bool contains(std::span<const Pixel> outline, const Pixel& p) {
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Pixel& a = outline[i];
    const Pixel& b = outline[(i + 1) % outline.size()];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y())) {
      inside = !inside;
    }
  }
  return inside;
}

double nearest_fraction(const Pixel& p, const Pixel& a, const Pixel& b) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
}

Picker::Picker(const PolygonMesh& cage, const CageGraph& graph, InSight sight)
    : positions_(cage.positions), graph_(&graph), sight_(std::move(sight)) {
  const Triangulation cut = triangulate(cage);
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    if (sight_.face(cut.face_of[t])) {
      triangles.push_back(cut.triangles[t]);
      face_of_.push_back(cut.face_of[t]);
    }
  }
  bvh_ = TriangleBvh({positions_, triangles});
  diagonal_ = diagonal(positions_);
}

std::vector<std::optional<Projected>> Picker::project_all(const OrbitCamera& camera) const {
  std::vector<std::optional<Projected>> projected(positions_.size());
  std::transform(positions_.begin(), positions_.end(), projected.begin(),
                 [&](const Vec3& p) { return camera.project(p); });
  return projected;
}

Vec3 Picker::center_of(Index face) const {
  Vec3 sum = Vec3::Zero();
  for (const Index v : graph_->face_vertices(face)) {
    sum += positions_[v];
  }
  return sum / static_cast<double>(graph_->face_vertices(face).size());
}

bool Picker::is_visible(const OrbitCamera& camera, const Vec3& p) const {
  const std::optional<Projected> at = camera.project(p);
  if (!at) {
    return false;
  }
  const Ray sight = camera.ray(at->pixel);
  const double distance = (p - sight.origin).dot(sight.direction);
  // The faces at the point itself are not before it.
  const double tolerance = 1e-6 * diagonal_ + 1e-9 * distance;
  return !bvh_.first_hit(sight.origin, sight.direction, distance - tolerance);
}

/// A face need not be flat: its middle may lie behind it, so that what is seen on the way there
/// counts, not whether anything is before the middle. Parts of the face may be hidden.
bool Picker::shows_face(const OrbitCamera& camera, Index face) const {
  const auto is_seen_at = [&](const Vec3& p) {
    const std::optional<Projected> at = camera.project(p);
    const std::optional<Pick> seen = at ? face_at(camera, at->pixel) : std::nullopt;
    return seen && seen->element == face;
  };
  const Vec3 center = center_of(face);
  if (is_seen_at(center)) {
    return true;
  }
  const std::span<const Index> corners = graph_->face_vertices(face);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3& a = positions_[corners[k]];
    const Vec3& b = positions_[corners[(k + 1) % corners.size()]];
    if (is_seen_at((center + a + b) / 3) || is_seen_at(0.25 * center + 0.75 * a)) {
      return true;
    }
  }
  return false;
}

std::optional<Pick> Picker::face_at(const OrbitCamera& camera, const Pixel& cursor) const {
  const Ray sight = camera.ray(cursor);
  const RayHit hit = bvh_.first_hit(sight.origin, sight.direction);
  if (!hit) {
    return std::nullopt;
  }
  return Pick{SelectionMode::face, face_of_[hit.triangle], sight.at(hit.distance), 0};
}

std::optional<Pick> Picker::pick(const OrbitCamera& camera, const Pixel& cursor, SelectionMode mode,
                                 const PickOptions& options) const {
  if (mode == SelectionMode::face) {
    return face_at(camera, cursor);
  }
  struct Candidate {
    Pick pick;
    double depth;
  };
  std::vector<Candidate> candidates;
  const auto offer = [&](Index element, const Vec3& point, const Pixel& pixel, double depth) {
    const double distance = (pixel - cursor).norm();
    if (distance <= options.radius) {
      candidates.push_back({{mode, element, point, distance}, depth});
    }
  };
  const std::vector<std::optional<Projected>> at = project_all(camera);
  if (mode == SelectionMode::vertex) {
    for (Index v = 0; v < at.size(); ++v) {
      if (at[v] && !graph_->vertex_faces(v).empty() && sight_.vertex(v)) {
        offer(v, positions_[v], at[v]->pixel, at[v]->depth);
      }
    }
  } else {
    for (Index e = 0; e < graph_->edge_count(); ++e) {
      const auto [a, b] = graph_->edge(e);
      if (!at[a] || !at[b] || !sight_.edge(e)) {
        continue;
      }
      const double t = nearest_fraction(cursor, at[a]->pixel, at[b]->pixel);
      // Even steps on the screen are uneven in space.
      const double s = camera.is_perspective()
                           ? t * at[a]->depth / ((1 - t) * at[b]->depth + t * at[a]->depth)
                           : t;
      offer(e, positions_[a] + s * (positions_[b] - positions_[a]),
            at[a]->pixel + t * (at[b]->pixel - at[a]->pixel),
            at[a]->depth + s * (at[b]->depth - at[a]->depth));
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.pick.distance < b.pick.distance;
  });
  const Candidate* best = nullptr;
  for (const Candidate& c : candidates) {
    if (best && c.pick.distance > best->pick.distance + tie_pixels) {
      break;
    }
    if ((!best || c.depth < best->depth) &&
        (options.see_through || is_visible(camera, c.pick.point))) {
      best = &c;
    }
  }
  return best ? std::optional(best->pick) : std::nullopt;
}

Selection Picker::within(const OrbitCamera& camera, std::span<const Pixel> outline,
                         SelectionMode mode, const PickOptions& options) const {
  Selection result;
  result.mode = mode;
  const auto seen = [&](const Vec3& p) { return options.see_through || is_visible(camera, p); };
  const std::vector<std::optional<Projected>> at = project_all(camera);
  switch (mode) {
  case SelectionMode::vertex:
    for (Index v = 0; v < at.size(); ++v) {
      if (at[v] && !graph_->vertex_faces(v).empty() && sight_.vertex(v) &&
          contains(outline, at[v]->pixel) && seen(positions_[v])) {
        result.vertices.push_back(v);
      }
    }
    break;
  case SelectionMode::edge:
    for (Index number = 0; number < graph_->edge_count(); ++number) {
      const EdgeVertices& e = graph_->edge(number);
      if (at[e[0]] && at[e[1]] && sight_.edge(number) &&
          reaches_into(outline, at[e[0]]->pixel, at[e[1]]->pixel) &&
          seen((positions_[e[0]] + positions_[e[1]]) / 2)) {
        result.edges.push_back(e);
      }
    }
    break;
  case SelectionMode::face:
    for (Index f = 0; f < graph_->face_count(); ++f) {
      const Vec3 center = center_of(f);
      const std::optional<Projected> middle = camera.project(center);
      if (middle && sight_.face(f) && contains(outline, middle->pixel) &&
          (options.see_through || shows_face(camera, f))) {
        result.faces.push_back(f);
      }
    }
    break;
  }
  return result;
}

} // namespace cagewright::app
