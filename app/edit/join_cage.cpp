// Faces, edges and vertices of a cage that are joined, deleted or turned.
#include "app/edit/draft.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"
#include <cagewright/mesh/triangulate.h>

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

constexpr Index none = EditedCage::none;

/// Joins faces over the edges between them into one polygon: its outline, if that is a single ring
/// through each vertex once.
std::optional<std::vector<Index>> outline(const PolygonMesh& cage, std::span<const Index> faces) {
  std::set<std::pair<Index, Index>> sides;
  for (const Index f : faces) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      sides.emplace(face[k], face[(k + 1) % face.size()]);
    }
  }
  std::map<Index, Index> next;
  for (const auto& [a, b] : sides) {
    if (!sides.contains({b, a}) && !next.emplace(a, b).second) {
      return std::nullopt; // touches itself in a vertex
    }
  }
  if (next.empty()) {
    return std::nullopt;
  }
  std::vector<Index> ring = {next.begin()->first};
  for (Index v = next.at(ring[0]); v != ring[0]; v = next.at(v)) {
    if (ring.size() > next.size() || !next.contains(v)) {
      return std::nullopt;
    }
    ring.push_back(v);
  }
  return ring.size() == next.size() ? std::optional(ring) : std::nullopt;
}

/// Sets of vertices each drawn together to their mean.
Result<EditedCage> merge(const PolygonMesh& cage, const std::vector<std::vector<Index>>& sets,
                         SelectionMode mode) {
  Draft draft(cage);
  std::map<Index, Index> by;
  std::vector<Index> selected;
  for (const std::vector<Index>& set : sets) {
    Vec3 sum = Vec3::Zero();
    for (const Index v : set) {
      sum += cage.positions[v] / static_cast<double>(set.size());
      by.emplace(v, set[0]);
    }
    draft.move(set[0], sum);
    selected.push_back(set[0]);
  }
  draft.replace_vertices(by);
  return draft.finish(mode, selected);
}

/// Vertices joined by the given edges, in sets.
std::vector<std::vector<Index>> joined_vertices(std::span<const EdgeVertices> edges) {
  std::map<Index, Index> parent;
  const auto find = [&](Index v) {
    while (parent.at(v) != v) {
      v = parent.at(v);
    }
    return v;
  };
  for (const EdgeVertices& e : edges) {
    parent.emplace(e[0], e[0]);
    parent.emplace(e[1], e[1]);
    const Index a = find(e[0]);
    const Index b = find(e[1]);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::map<Index, std::vector<Index>> sets;
  for (const auto& [v, p] : parent) {
    sets[find(v)].push_back(v);
  }
  std::vector<std::vector<Index>> result;
  for (auto& [root, set] : sets) {
    result.push_back(std::move(set));
  }
  return result;
}

/// Vertices that only two edges meet in, between two faces: taken out of both.
void drop_through_vertices(Draft& draft, const std::set<Index>& candidates) {
  std::map<Index, std::vector<std::size_t>> faces;
  for (std::size_t f = 0; f < draft.face_count(); ++f) {
    for (const Index v : draft.face(f)) {
      if (candidates.contains(v)) {
        faces[v].push_back(f);
      }
    }
  }
  for (const auto& [v, round] : faces) {
    if (round.size() == 2 && draft.face(round[0]).size() > 3 && draft.face(round[1]).size() > 3) {
      std::erase(draft.face(round[0]), v);
      std::erase(draft.face(round[1]), v);
    }
  }
}

/// Closes a hole: by one face, or by triangles where it has more than four corners.
/// \returns by how many
std::size_t fill(Draft& draft, std::span<const Vec3> positions, const std::vector<Index>& ring,
                 std::size_t like) {
  if (ring.size() <= 4) {
    draft.add_face(ring, like);
    return 1;
  }
  PolygonMesh alone;
  std::vector<Index> corners;
  for (const Index c : ring) {
    corners.push_back(static_cast<Index>(alone.positions.size()));
    alone.positions.push_back(positions[c]);
  }
  alone.add_face(corners);
  const std::vector<Triangle> triangles = triangulate(alone).triangles;
  for (const Triangle& t : triangles) {
    draft.add_face({ring[t[0]], ring[t[1]], ring[t[2]]}, like);
  }
  return triangles.size();
}

Result<EditedCage> delete_vertices(const PolygonMesh& cage, const CageGraph& graph,
                                   std::span<const Index> vertices) {
  // One after the other: the second may be a corner of what the first left.
  EditedCage result{cage, {}, {}, {}};
  result.new_of_old.resize(cage.positions.size());
  std::iota(result.new_of_old.begin(), result.new_of_old.end(), Index{0});
  CageGraph now = graph;
  for (const Index old : vertices) {
    const Index v = result.new_of_old[old];
    if (v == none || v >= now.vertex_count() || now.vertex_faces(v).empty()) {
      continue;
    }
    const std::span<const Index> round = now.vertex_faces(v);
    std::optional<std::vector<Index>> ring = outline(result.mesh, round);
    if (!ring || ring->size() < 3 || std::find(ring->begin(), ring->end(), v) != ring->end()) {
      return refuse("the faces round vertex " + std::to_string(old) +
                    " do not join to a single face");
    }
    Draft draft(result.mesh);
    const std::size_t like = round[0];
    for (const Index f : round) {
      draft.remove_face(f);
    }
    fill(draft, result.mesh.positions, *ring, like);
    Result<EditedCage> step = draft.finish(SelectionMode::vertex, {});
    if (!step) {
      return step.error();
    }
    for (Index& number : result.new_of_old) {
      number = number == none ? none : step->new_of_old[number];
    }
    result.mesh = std::move(step->mesh);
    now = CageGraph(result.mesh);
  }
  result.old_of_new.assign(result.mesh.positions.size(), none);
  for (Index v = 0; v < result.new_of_old.size(); ++v) {
    if (result.new_of_old[v] != none) {
      result.old_of_new[result.new_of_old[v]] = v;
    }
  }
  return result;
}

Result<EditedCage> delete_edges(const PolygonMesh& cage, const CageGraph& graph,
                                std::span<const EdgeVertices> edges) {
  std::set<Index> gone;
  std::set<Index> ends;
  for (const EdgeVertices& e : edges) {
    const std::optional<Index> number = graph.find_edge(e[0], e[1]);
    if (!number) {
      return no_such("edge");
    }
    gone.insert(*number);
    ends.insert(e.begin(), e.end());
  }
  // Faces that hang together over the edges that go.
  std::vector<Index> group(cage.face_count());
  std::iota(group.begin(), group.end(), Index{0});
  const auto find = [&](Index f) {
    while (group[f] != f) {
      f = group[f];
    }
    return f;
  };
  for (const Index e : gone) {
    const std::span<const Index> both = graph.edge_faces(e);
    if (both.size() != 2) {
      return refuse("the cage is not a closed surface; repair it first");
    }
    const Index a = find(both[0]);
    const Index b = find(both[1]);
    group[std::max(a, b)] = std::min(a, b);
  }
  std::map<Index, std::vector<Index>> sets;
  for (Index f = 0; f < group.size(); ++f) {
    sets[find(f)].push_back(f);
  }
  Draft draft(cage);
  for (const auto& [first, faces] : sets) {
    if (faces.size() < 2) {
      continue;
    }
    const std::optional<std::vector<Index>> ring = outline(cage, faces);
    if (!ring || ring->size() < 3) {
      return refuse("the faces beside the edge do not join to a single face");
    }
    for (const Index f : faces) {
      draft.remove_face(f);
    }
    draft.add_face(*ring, first);
  }
  drop_through_vertices(draft, ends);
  return draft.finish(SelectionMode::edge, {});
}

/// Each connected set of faces goes, with the vertices that only it uses, and what it leaves is
/// filled.
Result<EditedCage> delete_faces(const PolygonMesh& cage, const CageGraph& graph,
                                std::span<const Index> faces) {
  Draft draft(cage);
  std::size_t filled = 0;
  std::size_t gone = 0;
  for (const std::vector<Index>& region : connected_faces(graph, faces)) {
    const std::optional<std::vector<Index>> ring = outline(cage, region);
    if (!ring || ring->size() < 3) {
      return refuse("what these faces leave cannot be filled by one face: select a region without "
                    "holes, smaller than the whole piece");
    }
    std::set<Index> vertices;
    for (const Index f : region) {
      const std::span<const Index> corners = cage.face(f);
      vertices.insert(corners.begin(), corners.end());
    }
    const bool makes_one = region.size() > 1 && ring->size() <= 4;
    if (vertices.size() == ring->size() && !makes_one) {
      continue; // the same hole would be filled in the same way
    }
    for (const Index f : region) {
      draft.remove_face(f);
    }
    gone += region.size();
    filled += fill(draft, cage.positions, *ring, region[0]);
  }
  if (gone == 0) {
    return refuse("a cage stays closed: what these faces leave would be filled by the same faces "
                  "again. Select the faces round a vertex, or draw these together by Collapse");
  }
  Result<EditedCage> result = draft.finish(SelectionMode::face, {});
  if (result) {
    result->selection.mode = SelectionMode::face;
    for (std::size_t f = result->mesh.face_count() - filled; f < result->mesh.face_count(); ++f) {
      result->selection.faces.push_back(static_cast<Index>(f));
    }
  }
  return result;
}

Result<EditedCage> flip_edge(const PolygonMesh& cage, const EdgeVertices& edge) {
  const CageGraph graph(cage);
  const std::optional<Index> number = graph.find_edge(edge[0], edge[1]);
  if (!number) {
    return no_such("edge");
  }
  const std::span<const Index> both = graph.edge_faces(*number);
  const std::optional<std::vector<Index>> ring =
      both.size() == 2 ? outline(cage, both) : std::nullopt;
  if (!ring) {
    return refuse("the faces beside the edge do not join to a single face");
  }
  // Both ends go one corner on round the outline.
  const std::size_t n = ring->size();
  const auto place = [&](Index v) {
    return static_cast<std::size_t>(std::find(ring->begin(), ring->end(), v) - ring->begin());
  };
  if (place(edge[0]) == n || place(edge[1]) == n) {
    return refuse("the faces beside the edge share more than this edge");
  }
  const std::size_t from = (place(edge[0]) + 1) % n;
  const std::size_t to = (place(edge[1]) + 1) % n;
  if (graph.find_edge((*ring)[from], (*ring)[to])) {
    return refuse("the flipped edge exists already");
  }
  Draft draft(cage);
  std::array<std::vector<Index>, 2> halves;
  for (std::size_t i = from;; i = (i + 1) % n) {
    halves[0].push_back((*ring)[i]);
    if (i == to) {
      break;
    }
  }
  for (std::size_t i = to;; i = (i + 1) % n) {
    halves[1].push_back((*ring)[i]);
    if (i == from) {
      break;
    }
  }
  draft.face(both[0]) = halves[0];
  draft.face(both[1]) = halves[1];
  return draft.finish(SelectionMode::edge, {(*ring)[from], (*ring)[to]});
}

} // namespace

Result<EditedCage> collapse_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges) {
  const CageGraph graph(cage);
  for (const EdgeVertices& e : edges) {
    if (!graph.find_edge(e[0], e[1])) {
      return no_such("edge");
    }
  }
  if (edges.empty()) {
    return refuse("no edge is selected");
  }
  return merge(cage, joined_vertices(edges), SelectionMode::vertex);
}

Result<EditedCage> flip_edges(const PolygonMesh& cage, std::span<const EdgeVertices> edges) {
  if (edges.empty()) {
    return refuse("no edge is selected");
  }
  // Vertices keep their numbers unless there were some that no face uses.
  std::optional<EditedCage> result;
  std::vector<EdgeVertices> flipped;
  for (const EdgeVertices& edge : edges) {
    const auto now = [&](Index v) { return result ? result->new_of_old[v] : v; };
    if (edge[0] >= cage.positions.size() || edge[1] >= cage.positions.size()) {
      return no_such("edge");
    }
    Result<EditedCage> step =
        flip_edge(result ? result->mesh : cage, EdgeVertices{now(edge[0]), now(edge[1])});
    if (!step) {
      return step.error();
    }
    flipped.insert(flipped.end(), step->selection.edges.begin(), step->selection.edges.end());
    if (!result) {
      result = std::move(*step);
    } else {
      result->mesh = std::move(step->mesh);
    }
  }
  std::sort(flipped.begin(), flipped.end());
  flipped.erase(std::unique(flipped.begin(), flipped.end()), flipped.end());
  const CageGraph graph(result->mesh); // a later flip may have turned an earlier one's edge
  std::erase_if(flipped, [&](const EdgeVertices& e) { return !graph.find_edge(e[0], e[1]); });
  result->selection.edges = std::move(flipped);
  return *std::move(result);
}

Result<EditedCage> delete_elements(const PolygonMesh& cage, const Selection& selection) {
  if (selection.empty()) {
    return refuse("nothing is selected");
  }
  const CageGraph graph(cage);
  switch (selection.mode) {
  case SelectionMode::vertex:
    return delete_vertices(cage, graph, selection.vertices);
  case SelectionMode::edge:
    return delete_edges(cage, graph, selection.edges);
  case SelectionMode::face: {
    if (!has_faces(cage, selection.faces)) {
      return no_such("face");
    }
    return delete_faces(cage, graph, selection.faces);
  }
  }
  return refuse("nothing is selected");
}

} // namespace cagewright::app
