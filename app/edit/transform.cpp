#include "app/edit/transform.h"

#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace cagewright::app {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 mean_of(std::span<const Vec3> positions, std::span<const Index> vertices) {
  Vec3 sum = Vec3::Zero();
  for (const Index v : vertices) {
    sum += positions[v] / static_cast<double>(vertices.size());
  }
  return sum;
}

/// Positions in rising order of x, to look near places up.
class SortedPoints {
public:
  explicit SortedPoints(std::span<const Vec3> positions)
      : positions_(positions), order_(positions.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::sort(order_.begin(), order_.end(),
              [&](Index a, Index b) { return positions[a].x() < positions[b].x(); });
  }
  [[nodiscard]] Index nearest(const Vec3& p, double within) const {
    auto at = std::lower_bound(order_.begin(), order_.end(), p.x() - within,
                               [&](Index v, double x) { return positions_[v].x() < x; });
    Index best = Symmetry::none;
    double least = within;
    for (; at != order_.end() && positions_[*at].x() <= p.x() + within; ++at) {
      const double d = (positions_[*at] - p).norm();
      if (d < least || (d == least && *at < best)) {
        least = d;
        best = *at;
      }
    }
    return best;
  }

private:
  std::span<const Vec3> positions_;
  std::vector<Index> order_;
};

} // namespace

// ---------------------------------------------------------------- transformations

bool Transform::is_identity() const {
  switch (kind) {
  case TransformKind::translate:
    return shift.isZero(0);
  case TransformKind::rotate:
    return angle == 0;
  case TransformKind::scale:
    return factors == Vec3::Ones();
  }
  return true;
}

Vec3 Transform::apply(const Vec3& p, double weight, const Vec3& about) const {
  if (weight == 0 || is_identity()) {
    return p;
  }
  switch (kind) {
  case TransformKind::translate:
    return p + weight * shift;
  case TransformKind::rotate:
    return about + Eigen::AngleAxisd(weight * angle, axis) * (p - about);
  case TransformKind::scale: {
    const Vec3 local = axes.transpose() * (p - about);
    return p + weight * (axes * ((factors - Vec3::Ones()).cwiseProduct(local)));
  }
  }
  return p;
}

// ---------------------------------------------------------------- symmetry

Symmetry find_partners(std::span<const Vec3> positions, const Vec3& point, const Vec3& normal,
                       double tolerance) {
  Symmetry symmetry{point, normal, std::vector<Index>(positions.size(), Symmetry::none)};
  const SortedPoints points(positions);
  std::vector<Index> image(positions.size());
  for (Index v = 0; v < positions.size(); ++v) {
    const bool on_plane = std::abs((positions[v] - point).dot(normal)) <= tolerance / 2;
    image[v] = on_plane ? v : points.nearest(symmetry.mirror(positions[v]), tolerance);
  }
  for (Index v = 0; v < positions.size(); ++v) {
    if (image[v] != Symmetry::none && image[image[v]] == v) {
      symmetry.partner[v] = image[v];
    }
  }
  return symmetry;
}

std::optional<Symmetry> find_symmetry(std::span<const Vec3> positions, int axis, double tolerance) {
  const Vec3 normal = Vec3::Unit(axis);
  const auto count = [](const Symmetry& s) {
    return s.partner.size() -
           static_cast<std::size_t>(std::count(s.partner.begin(), s.partner.end(), Symmetry::none));
  };
  Symmetry best = find_partners(positions, Vec3::Zero(), normal, tolerance);
  if (!positions.empty()) {
    Symmetry middle = find_partners(positions, bounding_box(positions).center(), normal, tolerance);
    if (count(middle) > count(best)) {
      best = std::move(middle);
    }
  }
  return 2 * count(best) >= positions.size() && count(best) > 0 ? std::optional(std::move(best))
                                                                : std::nullopt;
}

// ---------------------------------------------------------------- frames

double falloff(Falloff kind, double distance, double radius) {
  if (!(distance < radius)) {
    return distance <= 0 ? 1 : 0;
  }
  const double t = 1 - distance / radius;
  switch (kind) {
  case Falloff::smooth:
    return t * t * (3 - 2 * t);
  case Falloff::linear:
    return t;
  case Falloff::sharp:
    return t * t;
  }
  return t;
}

Vec3 pivot_of(std::span<const Vec3> positions, std::span<const Index> vertices, Pivot pivot) {
  if (pivot != Pivot::bounding_box) {
    return mean_of(positions, vertices);
  }
  Box3 box;
  for (const Index v : vertices) {
    box.extend(positions[v]);
  }
  return box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.center());
}

Mat3 local_axes(const PolygonMesh& cage, const CageGraph& graph, std::span<const Index> vertices) {
  std::vector<Index> faces;
  for (const Index v : vertices) {
    const std::span<const Index> round = graph.vertex_faces(v);
    faces.insert(faces.end(), round.begin(), round.end());
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  // Faces that are selected as a whole tell more than those round about.
  std::vector<Index> whole;
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(whole), [&](Index f) {
    const std::span<const Index> face = graph.face_vertices(f);
    return std::all_of(face.begin(), face.end(), [&](Index v) {
      return std::binary_search(vertices.begin(), vertices.end(), v);
    });
  });
  Vec3 normal = Vec3::Zero();
  Vec3 along = Vec3::Zero();
  for (const Index f : whole.empty() ? faces : whole) {
    const std::span<const Index> face = graph.face_vertices(f);
    for (std::size_t k = 1; k + 1 < face.size(); ++k) {
      normal += (cage.positions[face[k]] - cage.positions[face[0]])
                    .cross(cage.positions[face[k + 1]] - cage.positions[face[0]]);
    }
    if (along.isZero(0)) {
      along = cage.positions[face[1]] - cage.positions[face[0]];
    }
  }
  const double size = normal.norm();
  if (!(size > 0)) {
    return Mat3::Identity();
  }
  normal /= size;
  along -= along.dot(normal) * normal;
  if (!(along.norm() > 0)) {
    along = normal.unitOrthogonal();
  }
  Mat3 axes;
  axes.col(2) = normal;
  axes.col(0) = along.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

// ---------------------------------------------------------------- targets

TransformTarget::TransformTarget(std::vector<Vec3> start, std::vector<Index> vertices,
                                 const CageGraph& graph, TransformOptions options)
    : start_(std::move(start)), vertices_(std::move(vertices)), options_(std::move(options)) {
  find_distances(graph);
  if (options_.pivot == Pivot::individual) {
    find_islands(graph);
  }
  update_weights();
}

void TransformTarget::find_distances(const CageGraph& graph) {
  distances_.assign(start_.size(), infinity);
  nearest_.assign(start_.size(), Symmetry::none);
  for (const Index v : vertices_) {
    distances_[v] = 0;
    nearest_[v] = v;
  }
  if (!options_.proportional.enabled) {
    return;
  }
  if (!options_.proportional.connected_only) {
    for (Index v = 0; v < start_.size(); ++v) {
      for (const Index s : vertices_) {
        const double d = (start_[v] - start_[s]).norm();
        if (d < distances_[v]) {
          distances_[v] = d;
          nearest_[v] = s;
        }
      }
    }
    return;
  }
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue; // Dijkstra
  for (const Index v : vertices_) {
    queue.emplace(0, v);
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distances_[v]) {
      continue;
    }
    for (const Index e : graph.vertex_edges(v)) {
      const Index other = graph.other_end(e, v);
      const double further = d + (start_[other] - start_[v]).norm();
      if (further < distances_[other]) {
        distances_[other] = further;
        nearest_[other] = nearest_[v];
        queue.emplace(further, other);
      }
    }
  }
}

void TransformTarget::find_islands(const CageGraph& graph) {
  pivots_.assign(start_.size(), Vec3::Zero());
  std::vector<char> waiting(start_.size(), 0);
  for (const Index v : vertices_) {
    waiting[v] = 1;
  }
  for (const Index first : vertices_) {
    if (waiting[first] == 0) {
      continue;
    }
    std::vector<Index> island = {first};
    waiting[first] = 0;
    for (std::size_t i = 0; i < island.size(); ++i) {
      for (const Index e : graph.vertex_edges(island[i])) {
        const Index other = graph.other_end(e, island[i]);
        if (waiting[other] != 0) {
          waiting[other] = 0;
          island.push_back(other);
        }
      }
    }
    const Vec3 mean = mean_of(start_, island);
    for (const Index v : island) {
      pivots_[v] = mean;
    }
  }
  for (Index v = 0; v < start_.size(); ++v) {
    if (nearest_[v] != Symmetry::none) {
      pivots_[v] = pivots_[nearest_[v]];
    }
  }
}

void TransformTarget::set_radius(double radius) {
  options_.proportional.radius = radius;
  update_weights();
}

void TransformTarget::update_weights() {
  weights_.assign(start_.size(), 0);
  for (Index v = 0; v < start_.size(); ++v) {
    weights_[v] =
        options_.proportional.enabled
            ? falloff(options_.proportional.falloff, distances_[v], options_.proportional.radius)
            : (distances_[v] == 0 ? 1 : 0);
  }
  for (const Index v : vertices_) {
    weights_[v] = 1;
  }
  find_leaders();
}

/// Of two partners the one that is moved more leads; when both are, the one on the side where more
/// is selected, and the side that the normal points to if that is equal.
void TransformTarget::find_leaders() {
  leads_.assign(start_.size(), 1);
  if (!options_.symmetry) {
    return;
  }
  const Symmetry& symmetry = *options_.symmetry;
  const auto height = [&](Index v) { return (start_[v] - symmetry.point).dot(symmetry.normal); };
  std::ptrdiff_t balance = 0;
  for (const Index v : vertices_) {
    if (!symmetry.is_on_plane(v)) {
      balance += height(v) > 0 ? 1 : -1;
    }
  }
  const double leading_side = balance >= 0 ? 1 : -1;
  for (Index v = 0; v < start_.size() && v < symmetry.partner.size(); ++v) {
    const Index partner = symmetry.partner[v];
    if (partner == v || partner >= start_.size()) {
      continue;
    }
    leads_[v] = weights_[v] != weights_[partner] ? weights_[v] > weights_[partner]
                                                 : height(v) * leading_side > 0;
    if (weights_[v] == weights_[partner] && height(v) == height(partner)) {
      leads_[v] = v < partner; // both on one side: not a mirror image, but one of them must lead
    }
  }
}

std::vector<Vec3> TransformTarget::moved(const Transform& transform) const {
  std::vector<Vec3> result = start_;
  if (transform.is_identity()) {
    return result;
  }
  for (Index v = 0; v < start_.size(); ++v) {
    if (weights_[v] > 0 && leads_[v] != 0) {
      result[v] = options_.pivot == Pivot::individual
                      ? transform.apply(start_[v], weights_[v], pivots_[v])
                      : transform.apply(start_[v], weights_[v]);
    }
  }
  if (!options_.symmetry) {
    return result;
  }
  const Symmetry& symmetry = *options_.symmetry;
  for (Index v = 0; v < start_.size() && v < symmetry.partner.size(); ++v) {
    const Index partner = symmetry.partner[v];
    if (partner >= start_.size()) {
      continue;
    }
    if (partner == v) {
      // A vertex a little off the plane keeps its distance, whatever else it does.
      result[v] = symmetry.onto_plane(result[v]) + (start_[v] - symmetry.onto_plane(start_[v]));
    } else if (leads_[v] == 0 && weights_[partner] > 0) {
      if (start_[v] == symmetry.mirror(start_[partner])) {
        result[v] = symmetry.mirror(result[partner]);
        continue;
      }
      // By the leader's displacement, mirrored: pairs that are not quite mirror images stay so.
      const Vec3 step = result[partner] - start_[partner];
      result[v] = start_[v] + step - 2 * step.dot(symmetry.normal) * symmetry.normal;
    }
  }
  return result;
}

} // namespace cagewright::app
