#include "improve/cage_mesh.h"

#include <algorithm>
#include <utility>

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

CageMesh::CageMesh(TriangleView mesh, CageExtent extent, std::span<const Index> parts,
                   std::span<const SeamBand> bands)
    : extent_(extent), positions_(mesh.positions.begin(), mesh.positions.end()),
      on_plane_(mesh.positions.size(), 0), faces_(mesh.triangles.begin(), mesh.triangles.end()),
      parts_(parts.begin(), parts.end()), around_(mesh.positions.size()) {
  if (!parts_.empty()) {
    bands_.assign(bands.begin(), bands.end());
  }
  face_count_ = faces_.size();
  for (Index f = 0; f < face_end(); ++f) {
    for (const Index v : faces_[f]) {
      around_[v].push_back(f);
    }
  }
  for (Index v = 0; v < vertex_end(); ++v) {
    on_plane_[v] = is_half() && positions_[v].x() == 0 ? 1 : 0;
    vertex_count_ += has_vertex(v) ? copies(v) : 0;
  }
}

std::vector<Index> CageMesh::neighbors(Index v) const {
  std::vector<Index> result;
  result.reserve(around_[v].size());
  for (const Index f : around_[v]) {
    const Triangle& t = faces_[f];
    const int at = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    result.push_back(t[(at + 1) % 3]); // each neighbour follows v in exactly one face,
    if (on_plane(v) && face_left_of(v, t[(at + 2) % 3]) == no_index) {
      result.push_back(t[(at + 2) % 3]); // but the last of an open fan
    }
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
  patch.on_plane = on_plane(v);
  patch.position = p;
  return patch;
}

std::optional<Patch> CageMesh::collapse(Index u, Index v) const {
  if (on_plane(v) && !on_plane(u)) {
    std::swap(u, v);
  }
  const std::vector<Index> near_u = neighbors(u);
  const std::vector<Index> near_v = neighbors(v);
  const auto common = std::count_if(near_u.begin(), near_u.end(), [&](Index w) {
    return std::find(near_v.begin(), near_v.end(), w) != near_v.end();
  });
  if (is_half()) {
    const bool along = on_plane(u) && on_plane(v);
    if (common != (along ? 1 : 2) || face_count_ <= 3) {
      return std::nullopt;
    }
  } else if (common != 2 || face_count_ <= 4 || near_u.size() + near_v.size() < 7) {
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
  patch.on_plane = on_plane(u);
  patch.gone = v;
  patch.position =
      on_plane(u) && !on_plane(v) ? positions_[u] : Vec3((positions_[u] + positions_[v]) / 2);
  if ((is_half() && !keeps_halves_apart(patch)) || !keeps_seams(u, v)) {
    return std::nullopt;
  }
  return patch;
}

// Whether the seams are loops as before when u and v are one.
bool CageMesh::keeps_seams(Index u, Index v) const {
  if (parts_.empty() || !is_on_seam(u) || !is_on_seam(v)) {
    return true;
  }
  return is_seam(u, v) && seam_length(u, v) > least_seam;
}

bool CageMesh::is_on_seam(Index v) const {
  return std::any_of(around_[v].begin(), around_[v].end(),
                     [&](Index f) { return parts_[f] != parts_[around_[v].front()]; });
}

const SeamBand* CageMesh::band_of(Index v) const {
  if (bands_.empty() || !is_on_seam(v)) {
    return nullptr;
  }
  Index part = 0;
  for (const Index f : around_[v]) {
    part = std::max(part, parts_[f]);
  }
  return &bands_[part];
}

const SeamBand* CageMesh::band_of(const Patch& patch) const {
  if (bands_.empty() || patch.vertex == no_index) {
    return nullptr;
  }
  if (patch.vertex == vertex_end()) { // on an edge
    const Index a = parts_[patch.removed.front()];
    const Index b = parts_[patch.removed.back()];
    return a != b ? &bands_[std::max(a, b)] : nullptr;
  }
  const SeamBand* band = band_of(patch.vertex);
  return band == nullptr && patch.gone != no_index ? band_of(patch.gone) : band;
}

bool CageMesh::is_seam(Index a, Index b) const {
  const Index left = face_left_of(a, b);
  const Index right = face_left_of(b, a);
  return left != no_index && right != no_index && parts_[left] != parts_[right];
}

// How many edges of the whole cage the seam has that the edge a b is of.
std::size_t CageMesh::seam_length(Index a, Index b) const {
  const auto next_after = [&](Index from, Index at) {
    for (const Index v : neighbors(at)) {
      if (v != from && is_seam(at, v)) {
        return v;
      }
    }
    return no_index; // at the boundary of a half
  };
  const auto walk = [&](Index from, Index at) {
    std::size_t edges = 0;
    while (at != no_index && at != a) {
      from = std::exchange(at, next_after(from, at));
      edges += at != no_index ? 1 : 0;
    }
    return std::pair(edges, at == a);
  };
  const auto [onward, is_closed] = walk(a, b);
  if (is_closed) {
    return onward + 1;
  }
  std::size_t back = 0;
  for (Index from = b, at = a; at != no_index; ++back) {
    from = std::exchange(at, next_after(from, at));
  }
  return 2 * (onward + back); // with the edge a b, and without the step off the boundary
}

// The faces round patch.vertex, once made: none lies in the plane, no edge of two faces joins two
// vertices of the plane, and no vertex of the whole has fewer than three faces.
bool CageMesh::keeps_halves_apart(const Patch& patch) const {
  const Index u = patch.vertex;
  for (const Triangle& t : patch.added) {
    if (on_plane(t[0]) && on_plane(t[1]) && on_plane(t[2])) {
      return false;
    }
  }
  if (patch.added.size() < (on_plane(u) ? 2U : 3U)) {
    return false;
  }
  const auto fits = [&](Index a) {
    std::size_t kept = 0;
    for (const Index f : around_[a]) {
      kept +=
          std::find(patch.removed.begin(), patch.removed.end(), f) == patch.removed.end() ? 1 : 0;
    }
    const auto added = static_cast<std::size_t>(
        std::count_if(patch.added.begin(), patch.added.end(),
                      [&](const Triangle& t) { return has_corner(t, a); }));
    return kept + added >= (on_plane(a) ? 2 : 3) && !(on_plane(u) && on_plane(a) && added != 1);
  };
  for (const auto& [a, b] : ring_of(patch)) {
    if (!fits(a) || !fits(b)) {
      return false;
    }
  }
  return true;
}

std::optional<Patch> CageMesh::flip(Index a, Index b) const {
  const Index left = face_left_of(a, b);
  const Index right = face_left_of(b, a);
  if (left == no_index || right == no_index || part(left) != part(right)) {
    return std::nullopt;
  }
  const Index c = corner_opposite(left, a, b);
  const Index d = corner_opposite(right, a, b);
  const std::vector<Index> near_c = neighbors(c);
  if (around_[a].size() <= (on_plane(a) ? 2 : 3) || around_[b].size() <= (on_plane(b) ? 2 : 3) ||
      (on_plane(c) && on_plane(d)) || std::find(near_c.begin(), near_c.end(), d) != near_c.end()) {
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
  patch.on_plane = is_half() && (left == no_index || right == no_index);
  for (const Index f : {left, right}) {
    if (f != no_index) {
      patch.removed.push_back(f);
    }
  }
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

// The parts of the patch's new faces: they come of the old ones in order.
std::vector<Index> CageMesh::parts_after(const Patch& patch) const {
  std::vector<Index> parts;
  if (parts_.empty()) {
    return parts;
  }
  const bool is_split = patch.vertex == vertex_end();
  for (const Index f : patch.removed) {
    const bool ends = patch.gone != no_index && has_corner(faces_[f], patch.gone) &&
                      has_corner(faces_[f], patch.vertex);
    if (!ends) {
      parts.insert(parts.end(), is_split ? 2 : 1, parts_[f]);
    }
  }
  return parts;
}

std::vector<Index> CageMesh::apply(const Patch& patch) {
  assert(patch.vertex == no_index || !patch.on_plane || patch.position.x() == 0);
  const std::vector<Index> parts = parts_after(patch);
  for (const Index f : patch.removed) {
    detach(f);
  }
  if (patch.vertex == vertex_end()) {
    positions_.push_back(patch.position);
    on_plane_.push_back(patch.on_plane ? 1 : 0);
    around_.emplace_back();
    vertex_count_ += copies(patch.vertex);
  } else if (patch.vertex != no_index) {
    positions_[patch.vertex] = patch.position;
  }
  if (patch.gone != no_index) {
    vertex_count_ -= copies(patch.gone);
  }
  std::vector<Index> added;
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    // A face's place is taken over by its successor: the arrays grow by splits alone.
    const Index f = i < patch.removed.size() ? patch.removed[i] : face_end();
    if (f == face_end()) {
      faces_.emplace_back();
      parts_.resize(parts_.empty() ? 0 : faces_.size());
    }
    if (!parts_.empty()) {
      parts_[f] = parts[i];
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

std::vector<Index> CageMesh::compact_parts() const {
  std::vector<Index> parts;
  for (Index f = 0; f < face_end(); ++f) {
    if (has_face(f)) {
      parts.push_back(part(f));
    }
  }
  return parts;
}

Corners corners_of(const CageMesh& cage, Index face) {
  const Triangle& t = cage.face(face);
  return {cage.position(t[0]), cage.position(t[1]), cage.position(t[2])};
}

Corners corners_across(const CageMesh& cage, const Corners& from, Index a, Index b) {
  const Index face = cage.face_left_of(a, b);
  return face == no_index ? mirrored(from) : corners_of(cage, face);
}

Ring ring_of(const Patch& patch) {
  Ring ring;
  for (const Triangle& t : patch.added) {
    const int at = t[0] == patch.vertex ? 0 : t[1] == patch.vertex ? 1 : 2;
    ring.push_back({t[(at + 1) % 3], t[(at + 2) % 3]});
  }
  // A chain starts where no other edge leads to.
  const auto first = std::find_if(ring.begin(), ring.end(), [&](const auto& edge) {
    return std::none_of(ring.begin(), ring.end(),
                        [&](const auto& other) { return other[1] == edge[0]; });
  });
  if (first != ring.end()) {
    std::iter_swap(ring.begin(), first);
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
