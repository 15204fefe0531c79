#include "improve/cage_mesh.h"

#include <algorithm>

namespace cagewright {

namespace {

bool has_corner(const Triangle& t, Index v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

Triangle with_corner(Triangle t, Index from, Index to) {
  for (Index& corner : t) {
    corner = corner == from ? to : corner;
  }
  return t;
}

} // namespace

CageMesh::CageMesh(TriangleView mesh)
    : positions_(mesh.positions.begin(), mesh.positions.end()),
      faces_(mesh.triangles.begin(), mesh.triangles.end()), around_(mesh.positions.size()) {
  face_count_ = faces_.size();
  for (Index f = 0; f < face_end(); ++f) {
    for (const Index v : faces_[f]) {
      around_[v].push_back(f);
    }
  }
  vertex_count_ = static_cast<std::size_t>(
      std::count_if(around_.begin(), around_.end(), [](const auto& a) { return !a.empty(); }));
}

std::vector<Index> CageMesh::neighbors(Index v) const {
  std::vector<Index> result;
  result.reserve(around_[v].size());
  for (const Index f : around_[v]) {
    const Triangle& t = faces_[f];
    const int at = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    result.push_back(t[(at + 1) % 3]); // each neighbour follows v in exactly one face
  }
  return result;
}

Index CageMesh::face_left_of(Index a, Index b) const {
  for (const Index f : around_[a]) {
    const Triangle& t = faces_[f];
    if ((t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b)) {
      return f;
    }
  }
  return no_index;
}

Index CageMesh::corner_opposite(Index f, Index a, Index b) const {
  const Triangle& t = faces_[f];
  for (const Index v : t) {
    if (v != a && v != b) {
      return v;
    }
  }
  return no_index;
}

Patch CageMesh::move(Index v, const Vec3& p) const {
  Patch patch;
  patch.removed = around_[v];
  for (const Index f : around_[v]) {
    patch.added.push_back(faces_[f]);
  }
  patch.vertex = v;
  patch.position = p;
  return patch;
}

std::optional<Patch> CageMesh::collapse(Index u, Index v) const {
  const std::vector<Index> near_u = neighbors(u);
  const std::vector<Index> near_v = neighbors(v);
  const auto common = std::count_if(near_u.begin(), near_u.end(), [&](Index w) {
    return std::find(near_v.begin(), near_v.end(), w) != near_v.end();
  });
  if (common != 2 || face_count_ <= 4 || near_u.size() + near_v.size() < 7) {
    return std::nullopt;
  }
  Patch patch;
  patch.removed = around_[u];
  for (const Index f : around_[u]) {
    if (!has_corner(faces_[f], v)) {
      patch.added.push_back(faces_[f]);
    }
  }
  for (const Index f : around_[v]) {
    if (!has_corner(faces_[f], u)) {
      patch.removed.push_back(f);
      patch.added.push_back(with_corner(faces_[f], v, u));
    }
  }
  patch.vertex = u;
  patch.gone = v;
  patch.position = (positions_[u] + positions_[v]) / 2;
  return patch;
}

std::optional<Patch> CageMesh::flip(Index a, Index b) const {
  const Index left = face_left_of(a, b);
  const Index right = face_left_of(b, a);
  const Index c = corner_opposite(left, a, b);
  const Index d = corner_opposite(right, a, b);
  const std::vector<Index> near_c = neighbors(c);
  if (around_[a].size() <= 3 || around_[b].size() <= 3 ||
      std::find(near_c.begin(), near_c.end(), d) != near_c.end()) {
    return std::nullopt;
  }
  Patch patch;
  patch.removed = {left, right};
  patch.added = {Triangle{c, a, d}, Triangle{d, b, c}};
  return patch;
}

Patch CageMesh::split(Index a, Index b) const {
  const Index left = face_left_of(a, b);
  const Index right = face_left_of(b, a);
  Patch patch;
  patch.vertex = vertex_end();
  patch.position = (positions_[a] + positions_[b]) / 2;
  patch.removed = {left, right};
  for (const Index f : patch.removed) {
    patch.added.push_back(with_corner(faces_[f], a, patch.vertex));
    patch.added.push_back(with_corner(faces_[f], b, patch.vertex));
  }
  return patch;
}

void CageMesh::detach(Index f) {
  for (const Index v : faces_[f]) {
    std::vector<Index>& list = around_[v];
    list.erase(std::find(list.begin(), list.end(), f));
  }
  faces_[f] = {no_index, no_index, no_index};
}

std::vector<Index> CageMesh::apply(const Patch& patch) {
  for (const Index f : patch.removed) {
    detach(f);
  }
  if (patch.vertex == vertex_end()) {
    positions_.push_back(patch.position);
    around_.emplace_back();
    ++vertex_count_;
  } else if (patch.vertex != no_index) {
    positions_[patch.vertex] = patch.position;
  }
  if (patch.gone != no_index) {
    --vertex_count_;
  }
  std::vector<Index> added;
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    // A face's place is taken over by its successor: the arrays grow by splits alone.
    const Index f = i < patch.removed.size() ? patch.removed[i] : face_end();
    if (f == face_end()) {
      faces_.emplace_back();
    }
    faces_[f] = patch.added[i];
    for (const Index v : patch.added[i]) {
      around_[v].push_back(f);
    }
    added.push_back(f);
  }
  face_count_ += patch.added.size();
  face_count_ -= patch.removed.size();
  return added;
}

TriangleMesh CageMesh::compact() const {
  TriangleMesh mesh;
  std::vector<Index> renumbered(positions_.size(), no_index);
  for (Index v = 0; v < vertex_end(); ++v) {
    if (has_vertex(v)) {
      renumbered[v] = static_cast<Index>(mesh.positions.size());
      mesh.positions.push_back(positions_[v]);
    }
  }
  for (Index f = 0; f < face_end(); ++f) {
    if (has_face(f)) {
      const Triangle& t = faces_[f];
      mesh.triangles.push_back({renumbered[t[0]], renumbered[t[1]], renumbered[t[2]]});
    }
  }
  return mesh;
}

Ring ring_of(const Patch& patch) {
  Ring ring;
  for (const Triangle& t : patch.added) {
    const int at = t[0] == patch.vertex ? 0 : t[1] == patch.vertex ? 1 : 2;
    ring.push_back({t[(at + 1) % 3], t[(at + 2) % 3]});
  }
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const auto next = std::find_if(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, ring.end(),
                                   [&](const auto& edge) { return edge[0] == ring[i][1]; });
    if (next != ring.end()) {
      std::iter_swap(ring.begin() + static_cast<std::ptrdiff_t>(i) + 1, next);
    }
  }
  return ring;
}

} // namespace cagewright
