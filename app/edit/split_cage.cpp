// Edges and faces of a cage that are split.
#include "app/edit/draft.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace cagewright::app {
namespace {

/// Corners and new vertices of a face, in order.
struct SplitFace {
  std::vector<Index> ring;
  std::vector<char> is_new;
  int new_count = 0;

  [[nodiscard]] std::size_t size() const { return ring.size(); }
  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) % size(); }
  [[nodiscard]] std::size_t previous(std::size_t i) const { return (i + size() - 1) % size(); }
};

/// Cuts a face with new vertices on its edges, no part with three corners on a line.
std::vector<std::vector<Index>> cut(SplitFace face) {
  std::vector<std::vector<Index>> parts;
  const bool was_quad = face.size() - static_cast<std::size_t>(face.new_count) == 4;
  if (was_quad && face.new_count == 2) {
    const std::size_t first = static_cast<std::size_t>(
        std::find(face.is_new.begin(), face.is_new.end(), 1) - face.is_new.begin());
    if (face.is_new[(first + 3) % 6] != 0) { // opposite to each other
      const auto at = [&](std::size_t i) { return face.ring[(first + i) % 6]; };
      return {{at(0), at(1), at(2), at(3)}, {at(3), at(4), at(5), at(0)}};
    }
  }
  // Corners between two new vertices are cut off.
  for (std::size_t i = 0; i < face.size() && face.size() > 3;) {
    const std::size_t before = face.previous(i);
    const std::size_t after = face.next(i);
    if (face.is_new[i] == 0 && face.is_new[before] != 0 && face.is_new[after] != 0) {
      parts.push_back({face.ring[before], face.ring[i], face.ring[after]});
      face.ring.erase(face.ring.begin() + static_cast<std::ptrdiff_t>(i));
      face.is_new.erase(face.is_new.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  const auto anchor = std::find(face.is_new.begin(), face.is_new.end(), 1);
  const bool all_new = std::find(face.is_new.begin(), face.is_new.end(), 0) == face.is_new.end();
  if (face.size() <= 3 || anchor == face.is_new.end() || all_new) {
    parts.push_back(face.ring);
    return parts;
  }
  // A fan from a new vertex: its two neighbors lie on a line with it, but are never in one part.
  const auto first = static_cast<std::size_t>(anchor - face.is_new.begin());
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    parts.push_back({face.ring[first], face.ring[(first + k) % face.size()],
                     face.ring[(first + k + 1) % face.size()]});
  }
  return parts;
}

/// Splits edges; faces in `centered` with all edges split get a vertex in their middle.
Result<EditedCage> subdivide(const PolygonMesh& cage, const std::set<EdgeVertices>& edges,
                             const std::set<Index>& centered, SelectionMode mode) {
  Draft draft(cage);
  std::map<EdgeVertices, Index> middle;
  std::vector<Index> selected;
  for (const EdgeVertices& e : edges) {
    const Index v = draft.add_vertex((draft.position(e[0]) + draft.position(e[1])) / 2, e[0]);
    middle.emplace(e, v);
    selected.push_back(v);
  }
  const std::size_t faces = draft.face_count();
  for (std::size_t f = 0; f < faces; ++f) {
    const std::vector<Index> corners = draft.face(f);
    SplitFace split;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Index a = corners[k];
      const Index b = corners[(k + 1) % corners.size()];
      split.ring.push_back(a);
      split.is_new.push_back(0);
      if (const auto m = middle.find({std::min(a, b), std::max(a, b)}); m != middle.end()) {
        split.ring.push_back(m->second);
        split.is_new.push_back(1);
        ++split.new_count;
      }
    }
    if (split.new_count == 0) {
      continue;
    }
    std::vector<std::vector<Index>> parts;
    if (centered.contains(static_cast<Index>(f))) {
      selected.insert(selected.end(), corners.begin(), corners.end());
    }
    if (centered.contains(static_cast<Index>(f)) && corners.size() > 3) {
      Vec3 sum = Vec3::Zero();
      for (const Index v : corners) {
        sum += draft.position(v) / static_cast<double>(corners.size());
      }
      const Index center = draft.add_vertex(sum, corners[0]);
      selected.push_back(center);
      for (std::size_t k = 0; k < split.size(); k += 2) { // corners and new vertices alternate
        parts.push_back({split.ring[k], split.ring[k + 1], center, split.ring[split.previous(k)]});
      }
    } else {
      parts = cut(split);
    }
    draft.remove_face(f);
    for (std::vector<Index>& part : parts) {
      draft.add_face(std::move(part), f);
    }
  }
  return draft.finish(mode, selected);
}

} // namespace

Result<EditedCage> split_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges) {
  const CageGraph graph(cage);
  std::set<EdgeVertices> wanted;
  for (const EdgeVertices& e : edges) {
    if (!graph.find_edge(e[0], e[1])) {
      return no_such("edge");
    }
    wanted.insert({std::min(e[0], e[1]), std::max(e[0], e[1])});
  }
  if (wanted.empty()) {
    return refuse("no edge is selected");
  }
  return subdivide(cage, wanted, {}, SelectionMode::vertex);
}

Result<EditedCage> split_rings(const PolygonMesh& cage, std::span<const EdgeVertices> edges) {
  const CageGraph graph(cage);
  std::set<EdgeVertices> wanted;
  for (const EdgeVertices& edge : edges) {
    const std::optional<Index> number = graph.find_edge(edge[0], edge[1]);
    if (!number) {
      return no_such("edge");
    }
    for (const Index e : edge_ring(*number, graph)) {
      wanted.insert(graph.edge(e));
    }
  }
  if (wanted.empty()) {
    return refuse("no edge is selected");
  }
  return subdivide(cage, wanted, {}, SelectionMode::edge);
}

Result<EditedCage> subdivide_faces(const PolygonMesh& cage, std::span<const Index> faces) {
  if (!has_faces(cage, faces)) {
    return faces.empty() ? refuse("no face is selected") : no_such("face");
  }
  std::set<EdgeVertices> edges;
  for (const Index f : faces) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k];
      const Index b = face[(k + 1) % face.size()];
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return subdivide(cage, edges, {faces.begin(), faces.end()}, SelectionMode::face);
}

} // namespace cagewright::app
