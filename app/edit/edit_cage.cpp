#include "app/edit/edit_cage.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"
#include "mesh/triangulate.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace cagewright::app {
namespace {

constexpr Index none = EditedCage::none;

Error refuse(std::string why) {
  return {ErrorCode::invalid_cage, std::move(why)};
}

/// A cage being changed: faces as lists, vertices that come and go.
class Draft {
public:
  explicit Draft(const PolygonMesh& cage) : before_(cage), positions_(cage.positions) {
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      const std::span<const Index> face = cage.face(f);
      faces_.push_back(
          {{face.begin(), face.end()}, f < cage.face_groups.size() ? cage.face_groups[f] : 0});
    }
    origin_.resize(positions_.size());
    std::iota(origin_.begin(), origin_.end(), Index{0});
    like_ = origin_;
  }

  using Corners = std::vector<Index>;

  [[nodiscard]] const Vec3& position(Index v) const { return positions_[v]; }
  void move(Index v, const Vec3& p) { positions_[v] = p; }
  [[nodiscard]] Corners& face(std::size_t f) { return faces_[f].corners; }
  [[nodiscard]] std::size_t face_count() const { return faces_.size(); }

  /// A new vertex; `like` an old one whose colour it takes.
  Index add_vertex(const Vec3& p, Index like) {
    positions_.push_back(p);
    origin_.push_back(none);
    like_.push_back(like);
    return static_cast<Index>(positions_.size() - 1);
  }
  /// In the group of face `like`.
  void add_face(Corners corners, std::size_t like) {
    faces_.push_back({std::move(corners), faces_[like].group});
  }
  void remove_face(std::size_t f) { faces_[f].corners.clear(); }
  /// Everywhere; face corners that become equal to the one before fall together, and faces that
  /// have less than three corners left vanish.
  void replace_vertices(const std::map<Index, Index>& by) {
    for (Face& face : faces_) {
      for (Index& v : face.corners) {
        const auto at = by.find(v);
        v = at == by.end() ? v : at->second;
      }
      Corners kept;
      for (const Index v : face.corners) {
        if (kept.empty() || kept.back() != v) {
          kept.push_back(v);
        }
      }
      while (kept.size() > 1 && kept.front() == kept.back()) {
        kept.pop_back();
      }
      if (kept.size() < 3) {
        kept.clear();
      }
      face.corners = std::move(kept);
    }
  }

  /// Drops what is gone, and checks the whole.
  /// \param selected  numbers in the draft
  Result<EditedCage> finish(SelectionMode mode, const std::vector<Index>& selected) const {
    EditedCage result;
    std::vector<char> used(positions_.size(), 0);
    for (const Face& face : faces_) {
      for (const Index v : face.corners) {
        used[v] = 1;
      }
    }
    std::vector<Index> number(positions_.size(), none);
    result.new_of_old.assign(before_.positions.size(), none);
    for (Index v = 0; v < positions_.size(); ++v) {
      if (used[v] == 0) {
        continue;
      }
      number[v] = static_cast<Index>(result.mesh.positions.size());
      result.mesh.positions.push_back(positions_[v]);
      result.old_of_new.push_back(origin_[v]);
      if (origin_[v] != none) {
        result.new_of_old[origin_[v]] = number[v];
      }
      if (!before_.colors.empty()) {
        result.mesh.colors.push_back(before_.colors[like_[v]]);
      }
    }
    result.mesh.group_names = before_.group_names;
    for (const Face& face : faces_) {
      if (face.corners.empty()) {
        continue;
      }
      Corners corners;
      for (const Index v : face.corners) {
        corners.push_back(number[v]);
      }
      result.mesh.add_face(corners);
      if (!before_.face_groups.empty()) {
        result.mesh.face_groups.push_back(face.group);
      }
    }
    if (const Status good = check(result.mesh); !good) {
      return good.error();
    }
    std::vector<Index> vertices;
    for (const Index v : selected) {
      if (number[v] != none) {
        vertices.push_back(number[v]);
      }
    }
    std::sort(vertices.begin(), vertices.end());
    Selection chosen;
    chosen.vertices = std::move(vertices);
    result.selection = converted(chosen, mode, CageGraph(result.mesh));
    return result;
  }

private:
  struct Face {
    Corners corners; ///< none: gone
    Index group;
  };

  [[nodiscard]] Status check(const PolygonMesh& after) const {
    const TopologyReport was = topology(before_);
    const TopologyReport is = topology(after);
    if (!was.is_closed() || !was.is_manifold() || !was.is_oriented()) {
      return refuse("the cage is not a closed surface; repair it first");
    }
    if (is.edges == 0) {
      return refuse("nothing would be left of the cage");
    }
    if (!is.repeated_corner_faces.empty() || !is.duplicate_faces.empty() ||
        !is.boundary_edges.empty()) {
      return refuse("the cage would be folded flat there");
    }
    if (!is.is_manifold() || !is.is_oriented()) {
      return refuse("the cage would touch itself in an edge or a vertex");
    }
    if (is.components != was.components) {
      return refuse(is.components > was.components ? "the cage would fall apart"
                                                   : "a piece of the cage would vanish");
    }
    if (is.genus != was.genus) {
      return refuse("a handle of the cage would open or close");
    }
    return success();
  }

  const PolygonMesh& before_;
  std::vector<Vec3> positions_;
  std::vector<Face> faces_;
  std::vector<Index> origin_; // of each vertex the old one, or none
  std::vector<Index> like_;
};

Error no_such(const char* what) {
  return refuse(std::string("there is no such ") + what);
}

bool has_faces(const PolygonMesh& cage, std::span<const Index> faces) {
  return !faces.empty() &&
         std::all_of(faces.begin(), faces.end(), [&](Index f) { return f < cage.face_count(); });
}

// ---------------------------------------------------------------- splitting

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

// ---------------------------------------------------------------- joining

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

/// The faces, grouped where they share an edge.
std::vector<std::vector<Index>> connected_faces(const CageGraph& graph,
                                                std::span<const Index> faces) {
  std::set<Index> waiting(faces.begin(), faces.end());
  std::vector<std::vector<Index>> groups;
  while (!waiting.empty()) {
    std::vector<Index> group = {*waiting.begin()};
    waiting.erase(waiting.begin());
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const Index e : graph.face_edges(group[i])) {
        for (const Index f : graph.edge_faces(e)) {
          if (waiting.erase(f) > 0) {
            group.push_back(f);
          }
        }
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
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
    if (ring->size() <= 4) {
      draft.add_face(*ring, like);
    } else {
      PolygonMesh alone;
      std::vector<Index> corners;
      for (const Index c : *ring) {
        corners.push_back(static_cast<Index>(alone.positions.size()));
        alone.positions.push_back(result.mesh.positions[c]);
      }
      alone.add_face(corners);
      for (const Triangle& t : triangulate(alone).triangles) {
        draft.add_face({(*ring)[t[0]], (*ring)[t[1]], (*ring)[t[2]]}, like);
      }
    }
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
    std::vector<EdgeVertices> edges;
    for (const Index f : selection.faces) {
      for (const Index e : graph.face_edges(f)) {
        edges.push_back(graph.edge(e));
      }
    }
    return merge(cage, joined_vertices(edges), SelectionMode::vertex);
  }
  }
  return refuse("nothing is selected");
}

Result<EditedCage> extrude_faces(const PolygonMesh& cage, std::span<const Index> faces,
                                 double offset) {
  if (!has_faces(cage, faces)) {
    return faces.empty() ? refuse("no face is selected") : no_such("face");
  }
  if (offset == 0) {
    return refuse("extruding by nothing would make faces without area");
  }
  const CageGraph graph(cage);
  Draft draft(cage);
  std::vector<Index> selected;
  for (const std::vector<Index>& region : connected_faces(graph, faces)) {
    const std::set<Index> inside(region.begin(), region.end());
    Vec3 normal = Vec3::Zero();
    std::set<Index> vertices;
    std::map<std::pair<Index, Index>, Index> rim; // directed side and its face
    for (const Index f : region) {
      const std::span<const Index> face = cage.face(f);
      for (std::size_t k = 0; k < face.size(); ++k) {
        const Index a = face[k];
        const Index b = face[(k + 1) % face.size()];
        vertices.insert(a);
        const Vec3& origin = cage.positions[face[0]];
        normal += (cage.positions[a] - origin).cross(cage.positions[b] - origin);
        const std::span<const Index> both = graph.edge_faces(*graph.find_edge(a, b));
        if (std::any_of(both.begin(), both.end(), [&](Index g) { return !inside.contains(g); })) {
          rim.emplace(std::pair(a, b), f);
        }
      }
    }
    if (rim.empty()) {
      return refuse("the whole piece is selected: there is nothing to extrude it from");
    }
    if (!(normal.norm() > 0)) {
      return refuse("the faces have no common direction to be extruded along");
    }
    const Vec3 shift = offset * normal.normalized();
    // The rim gets new vertices, the rest of the region moves.
    std::map<Index, Index> raised;
    for (const auto& [side, f] : rim) {
      for (const Index v : {side.first, side.second}) {
        if (!raised.contains(v)) {
          raised.emplace(v, draft.add_vertex(cage.positions[v] + shift, v));
        }
      }
    }
    for (const Index v : vertices) {
      if (!raised.contains(v)) {
        draft.move(v, cage.positions[v] + shift);
        selected.push_back(v);
      }
    }
    for (const auto& [v, up] : raised) {
      selected.push_back(up);
    }
    for (const Index f : region) {
      for (Index& v : draft.face(f)) {
        const auto at = raised.find(v);
        v = at == raised.end() ? v : at->second;
      }
    }
    for (const auto& [side, f] : rim) {
      const auto [a, b] = side;
      draft.add_face({a, b, raised.at(b), raised.at(a)}, f);
    }
  }
  return draft.finish(SelectionMode::face, selected);
}

double extrusion_offset(const PolygonMesh& cage, std::span<const Index> faces) {
  double sum = 0;
  double count = 0;
  for (const Index f : faces) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      sum += (cage.positions[face[k]] - cage.positions[face[(k + 1) % face.size()]]).norm();
      ++count;
    }
  }
  return count > 0 ? sum / count / 3 : 0;
}

} // namespace cagewright::app
