// Edges and faces of a cage that are split.
#include "app/edit/draft.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"

#include <algorithm>
#include <array>
#include <cmath>
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

constexpr double halfway = 0.5;

/// Splits edges, each at a fraction of its way from its lower vertex; faces in `centered` with all
/// edges split get a vertex in their middle.
Result<EditedCage> subdivide(const PolygonMesh& cage, const std::map<EdgeVertices, double>& edges,
                             const std::set<Index>& centered, SelectionMode mode) {
  Draft draft(cage);
  std::map<EdgeVertices, Index> middle;
  std::vector<Index> selected;
  for (const auto& [e, at] : edges) {
    const Vec3 place = at == halfway
                           ? Vec3((draft.position(e[0]) + draft.position(e[1])) / 2)
                           : Vec3((1 - at) * draft.position(e[0]) + at * draft.position(e[1]));
    const Index v = draft.add_vertex(place, e[0]);
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
  std::map<EdgeVertices, double> wanted;
  for (const EdgeVertices& e : edges) {
    if (!graph.find_edge(e[0], e[1])) {
      return no_such("edge");
    }
    wanted.emplace(EdgeVertices{std::min(e[0], e[1]), std::max(e[0], e[1])}, halfway);
  }
  if (wanted.empty()) {
    return refuse("no edge is selected");
  }
  return subdivide(cage, wanted, {}, SelectionMode::vertex);
}

Result<EditedCage> split_rings(const PolygonMesh& cage, std::span<const EdgeVertices> edges) {
  const CageGraph graph(cage);
  std::map<EdgeVertices, double> wanted;
  for (const EdgeVertices& edge : edges) {
    const std::optional<Index> number = graph.find_edge(edge[0], edge[1]);
    if (!number) {
      return no_such("edge");
    }
    for (const Index e : edge_ring(*number, graph)) {
      wanted.emplace(graph.edge(e), halfway);
    }
  }
  if (wanted.empty()) {
    return refuse("no edge is selected");
  }
  return subdivide(cage, wanted, {}, SelectionMode::edge);
}

namespace {

/// The ring of an edge, each edge from the side of `edge[0]` to the side of `edge[1]`.
std::vector<EdgeVertices> directed_ring(const EdgeVertices& edge, const CageGraph& graph) {
  const Index start = *graph.find_edge(edge[0], edge[1]);
  const std::vector<Index> ring = edge_ring(start, graph);
  std::vector<EdgeVertices> directed(ring.size());
  const auto first =
      static_cast<std::size_t>(std::find(ring.begin(), ring.end(), start) - ring.begin());
  directed[first] = edge;
  // The sides of a quad join the ends that lie on the same side of the ring.
  const auto follow = [&](std::size_t from, std::size_t to) {
    for (const Index quad : graph.edge_faces(ring[from])) {
      if (graph.across(ring[from], quad) != ring[to]) {
        continue;
      }
      const std::span<const Index> corners = graph.face_vertices(quad);
      const auto at = static_cast<std::size_t>(
          std::find(corners.begin(), corners.end(), directed[from][0]) - corners.begin());
      const Index after = corners[(at + 1) % 4];
      const Index mate = after == directed[from][1] ? corners[(at + 3) % 4] : after;
      const EdgeVertices& e = graph.edge(ring[to]);
      directed[to] = e[0] == mate ? e : EdgeVertices{e[1], e[0]};
      return;
    }
  };
  for (std::size_t i = first; i + 1 < ring.size(); ++i) {
    follow(i, i + 1);
  }
  for (std::size_t i = first; i > 0; --i) {
    follow(i, i - 1);
  }
  return directed;
}

} // namespace

Result<EditedCage> cut_loops(const PolygonMesh& cage, const EdgeVertices& edge, int cuts,
                             double slide) {
  if (cuts < 1 || !(std::abs(slide) < 1)) {
    return refuse("a ring is cut once or more, between its ends");
  }
  if (!CageGraph(cage).find_edge(edge[0], edge[1])) {
    return no_such("edge");
  }
  // One cut after the other, each between the last one and the far ends.
  EditedCage result{cage, {}, {}, {}};
  result.new_of_old.resize(cage.positions.size());
  std::iota(result.new_of_old.begin(), result.new_of_old.end(), Index{0});
  EdgeVertices rest = edge;
  double done = 0;
  std::vector<std::vector<Index>> loops; // vertices, rising
  for (int cut = 1; cut <= cuts; ++cut) {
    const double even = static_cast<double>(cut) / (cuts + 1);
    const double at = even + slide / (cuts + 1);
    const double fraction = (at - done) / (1 - done);
    done = at;
    std::map<EdgeVertices, double> wanted;
    for (const EdgeVertices& e : directed_ring(rest, CageGraph(result.mesh))) {
      const bool rising = e[0] < e[1];
      wanted.emplace(EdgeVertices{std::min(e[0], e[1]), std::max(e[0], e[1])},
                     rising ? fraction : 1 - fraction);
    }
    Result<EditedCage> step = subdivide(result.mesh, wanted, {}, SelectionMode::vertex);
    if (!step) {
      return step.error();
    }
    // New vertices come last, in the order of their edges.
    const EdgeVertices here = {std::min(rest[0], rest[1]), std::max(rest[0], rest[1])};
    const auto place = std::distance(wanted.begin(), wanted.find(here));
    const auto first_new = static_cast<Index>(step->mesh.positions.size() - wanted.size());
    const Index far = step->new_of_old[rest[1]];
    for (Index& number : result.new_of_old) {
      number = number == EditedCage::none ? number : step->new_of_old[number];
    }
    for (std::vector<Index>& loop : loops) {
      std::ranges::transform(loop, loop.begin(), [&](Index v) { return step->new_of_old[v]; });
    }
    loops.emplace_back(wanted.size());
    std::iota(loops.back().begin(), loops.back().end(), first_new);
    rest = {first_new + static_cast<Index>(place), far};
    result.mesh = std::move(step->mesh);
  }
  result.old_of_new.assign(result.mesh.positions.size(), EditedCage::none);
  for (Index v = 0; v < result.new_of_old.size(); ++v) {
    if (result.new_of_old[v] != EditedCage::none) {
      result.old_of_new[result.new_of_old[v]] = v;
    }
  }
  result.selection.mode = SelectionMode::edge;
  const CageGraph graph(result.mesh);
  for (const std::vector<Index>& loop : loops) {
    const std::vector<EdgeVertices> edges = edges_within(loop, graph);
    result.selection.edges.insert(result.selection.edges.end(), edges.begin(), edges.end());
  }
  std::ranges::sort(result.selection.edges);
  return result;
}

Result<EditedCage> subdivide_faces(const PolygonMesh& cage, std::span<const Index> faces) {
  if (!has_faces(cage, faces)) {
    return faces.empty() ? refuse("no face is selected") : no_such("face");
  }
  std::map<EdgeVertices, double> edges;
  for (const Index f : faces) {
    const std::span<const Index> face = cage.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Index a = face[k];
      const Index b = face[(k + 1) % face.size()];
      edges.emplace(EdgeVertices{std::min(a, b), std::max(a, b)}, halfway);
    }
  }
  return subdivide(cage, edges, {faces.begin(), faces.end()}, SelectionMode::face);
}

} // namespace cagewright::app
