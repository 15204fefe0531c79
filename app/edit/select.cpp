#include "app/edit/select.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>

namespace cagewright::app {
namespace {

template <class T> void make_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template <class T>
std::vector<T> combined_lists(const std::vector<T>& a, const std::vector<T>& b, Combine how) {
  std::vector<T> result;
  const auto out = std::back_inserter(result);
  switch (how) {
  case Combine::replace:
    return b;
  case Combine::add:
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), out);
    break;
  case Combine::subtract:
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), out);
    break;
  case Combine::toggle:
    std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), out);
    break;
  }
  return result;
}

std::vector<char> marks_of(std::span<const Index> list, std::size_t count) {
  std::vector<char> marks(count, 0);
  for (const Index i : list) {
    if (i < count) {
      marks[i] = 1;
    }
  }
  return marks;
}

std::vector<Index> edge_numbers(const Selection& selection, const CageGraph& graph) {
  std::vector<Index> numbers;
  for (const EdgeVertices& e : selection.edges) {
    if (const auto number = graph.find_edge(e[0], e[1])) {
      numbers.push_back(*number);
    }
  }
  return numbers;
}

Selection of_edges(std::vector<Index> numbers, const CageGraph& graph) {
  make_unique(numbers);
  Selection result{.mode = SelectionMode::edge, .vertices = {}, .edges = {}, .faces = {}};
  for (const Index e : numbers) {
    result.edges.push_back(graph.edge(e));
  }
  return result;
}

Selection of_vertices(std::vector<Index> vertices) {
  make_unique(vertices);
  return {.mode = SelectionMode::vertex, .vertices = std::move(vertices), .edges = {}, .faces = {}};
}

Selection of_faces(std::vector<Index> faces) {
  make_unique(faces);
  return {.mode = SelectionMode::face, .vertices = {}, .edges = {}, .faces = std::move(faces)};
}

/// The vertices that some face uses: the others are never selected.
std::vector<Index> used_vertices(const CageGraph& graph) {
  std::vector<Index> used;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    if (!graph.vertex_faces(v).empty()) {
      used.push_back(v);
    }
  }
  return used;
}

/// A run of edges through `first`: backward from its first side, then forward from its second; or
/// once round, if it comes back to it.
/// \param walker  for a side (0, 1) what gives one edge after the other, and then none
template <class Walker>
std::vector<Index> both_ways(Index first, std::size_t sides, std::size_t most,
                             const Walker& walker) {
  std::vector<Index> run;
  for (std::size_t side = 0; side < sides; ++side) {
    auto next = walker(side);
    std::vector<Index> half;
    // A run may go round without ever coming back to where it began.
    for (std::optional<Index> e = next(); e && half.size() <= most; e = next()) {
      half.push_back(*e);
      if (*e == first) {
        return half;
      }
    }
    if (side == 0) {
      run.assign(half.rbegin(), half.rend());
      run.push_back(first);
    } else {
      run.insert(run.end(), half.begin(), half.end());
    }
  }
  return run;
}

Selection follow(const Selection& selection, const CageGraph& graph,
                 std::vector<Index> (*walk)(Index, const CageGraph&)) {
  const Selection edges = converted(selection, SelectionMode::edge, graph);
  std::vector<Index> found;
  for (const Index e : edge_numbers(edges, graph)) {
    const std::vector<Index> run = walk(e, graph);
    found.insert(found.end(), run.begin(), run.end());
  }
  return converted(of_edges(std::move(found), graph), selection.mode, graph);
}

} // namespace

std::vector<Index> vertices_of(const Selection& selection, const CageGraph& graph) {
  std::vector<Index> vertices = selection.vertices;
  for (const EdgeVertices& e : selection.edges) {
    vertices.insert(vertices.end(), e.begin(), e.end());
  }
  for (const Index f : selection.faces) {
    if (f < graph.face_count()) {
      const std::span<const Index> face = graph.face_vertices(f);
      vertices.insert(vertices.end(), face.begin(), face.end());
    }
  }
  make_unique(vertices);
  return vertices;
}

std::vector<EdgeVertices> edges_within(std::span<const Index> vertices, const CageGraph& graph) {
  const std::vector<char> marked = marks_of(vertices, graph.vertex_count());
  std::vector<EdgeVertices> result;
  for (const EdgeVertices& e : graph.edges()) {
    if (marked[e[0]] != 0 && marked[e[1]] != 0) {
      result.push_back(e);
    }
  }
  return result;
}

std::vector<Index> faces_within(std::span<const Index> vertices, const CageGraph& graph) {
  const std::vector<char> marked = marks_of(vertices, graph.vertex_count());
  std::vector<Index> result;
  for (Index f = 0; f < graph.face_count(); ++f) {
    const std::span<const Index> face = graph.face_vertices(f);
    if (!face.empty() &&
        std::all_of(face.begin(), face.end(), [&](Index v) { return marked[v] != 0; })) {
      result.push_back(f);
    }
  }
  return result;
}

Selection converted(const Selection& selection, SelectionMode mode, const CageGraph& graph) {
  if (selection.mode == mode) {
    return selection;
  }
  Selection result;
  result.mode = mode;
  if (selection.mode == SelectionMode::face && mode == SelectionMode::edge) {
    std::vector<Index> edges;
    for (const Index f : selection.faces) {
      const std::span<const Index> sides = graph.face_edges(f);
      edges.insert(edges.end(), sides.begin(), sides.end());
    }
    return of_edges(std::move(edges), graph);
  }
  const std::vector<Index> vertices = vertices_of(selection, graph);
  switch (mode) {
  case SelectionMode::vertex:
    result.vertices = vertices;
    break;
  case SelectionMode::edge:
    result.edges = edges_within(vertices, graph);
    break;
  case SelectionMode::face:
    result.faces = faces_within(vertices, graph);
    break;
  }
  return result;
}

Selection select_all(SelectionMode mode, const CageGraph& graph) {
  if (mode == SelectionMode::vertex) {
    return of_vertices(used_vertices(graph));
  }
  std::vector<Index> all(mode == SelectionMode::edge ? graph.edge_count() : graph.face_count());
  std::iota(all.begin(), all.end(), Index{0});
  return mode == SelectionMode::edge ? of_edges(std::move(all), graph) : of_faces(std::move(all));
}

Selection inverted(const Selection& selection, const CageGraph& graph) {
  return combined(select_all(selection.mode, graph), selection, Combine::subtract);
}

Selection grown(const Selection& selection, const CageGraph& graph) {
  if (selection.mode == SelectionMode::vertex) {
    std::vector<Index> more = selection.vertices;
    for (const Index v : selection.vertices) {
      for (const Index e : graph.vertex_edges(v)) {
        more.push_back(graph.other_end(e, v));
      }
    }
    return of_vertices(std::move(more));
  }
  const std::vector<Index> vertices = vertices_of(selection, graph);
  std::vector<Index> more;
  for (const Index v : vertices) {
    const std::span<const Index> round =
        selection.mode == SelectionMode::edge ? graph.vertex_edges(v) : graph.vertex_faces(v);
    more.insert(more.end(), round.begin(), round.end());
  }
  return selection.mode == SelectionMode::edge ? of_edges(std::move(more), graph)
                                               : of_faces(std::move(more));
}

Selection shrunk(const Selection& selection, const CageGraph& graph) {
  return inverted(grown(inverted(selection, graph), graph), graph);
}

Selection linked(const Selection& selection, const CageGraph& graph) {
  std::vector<Index> reached = vertices_of(selection, graph);
  std::vector<char> seen = marks_of(reached, graph.vertex_count());
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const Index e : graph.vertex_edges(reached[i])) {
      const Index other = graph.other_end(e, reached[i]);
      if (seen[other] == 0) {
        seen[other] = 1;
        reached.push_back(other);
      }
    }
  }
  return converted(of_vertices(std::move(reached)), selection.mode, graph);
}

std::vector<Index> edge_loop(Index edge, const CageGraph& graph) {
  return both_ways(edge, 2, graph.edge_count(), [&](std::size_t end) {
    return [&graph, e = edge, v = graph.edge(edge)[end]]() mutable {
      const std::optional<Index> next = graph.straight_on(e, v);
      if (next) {
        v = graph.other_end(*next, v);
        e = *next;
      }
      return next;
    };
  });
}

std::vector<Index> edge_ring(Index edge, const CageGraph& graph) {
  const std::span<const Index> faces = graph.edge_faces(edge);
  const std::size_t sides = std::min<std::size_t>(2, faces.size());
  return both_ways(edge, sides, graph.edge_count(), [&](std::size_t side) {
    return [&graph, e = edge, face = std::optional(faces[side])]() mutable {
      const std::optional<Index> next = face ? graph.across(e, *face) : std::nullopt;
      if (next) {
        const std::span<const Index> both = graph.edge_faces(*next);
        face = both.size() != 2 ? std::nullopt : std::optional(both[both[0] == *face ? 1 : 0]);
        e = *next;
      }
      return next;
    };
  });
}

std::vector<Index> face_ring(Index edge, const CageGraph& graph) {
  std::vector<char> in_ring(graph.edge_count(), 0);
  const std::vector<Index> ring = edge_ring(edge, graph);
  for (const Index e : ring) {
    in_ring[e] = 1;
  }
  std::vector<Index> faces;
  for (const Index e : ring) {
    for (const Index f : graph.edge_faces(e)) {
      const std::optional<Index> opposite = graph.across(e, f);
      if (opposite && in_ring[*opposite] != 0) {
        faces.push_back(f);
      }
    }
  }
  make_unique(faces);
  return faces;
}

Selection loops(const Selection& selection, const CageGraph& graph) {
  return follow(selection, graph, edge_loop);
}

Selection rings(const Selection& selection, const CageGraph& graph) {
  return follow(selection, graph, edge_ring);
}

Selection mirrored(const Selection& selection, std::span<const Index> partner,
                   const CageGraph& graph, bool keep) {
  const Selection result = carried_over(selection, graph, partner, graph);
  return keep ? combined(selection, result, Combine::add) : result;
}

Selection combined(const Selection& selection, const Selection& found, Combine how) {
  if (selection.mode != found.mode) {
    return found;
  }
  Selection result;
  result.mode = found.mode;
  result.vertices = combined_lists(selection.vertices, found.vertices, how);
  result.edges = combined_lists(selection.edges, found.edges, how);
  result.faces = combined_lists(selection.faces, found.faces, how);
  return result;
}

Selection carried_over(const Selection& selection, const CageGraph& before,
                       std::span<const Index> new_of_old, const CageGraph& after) {
  const auto now = [&](Index v) { return v < new_of_old.size() ? new_of_old[v] : ~Index{0}; };
  Selection result;
  result.mode = selection.mode;
  for (const Index v : selection.vertices) {
    if (now(v) < after.vertex_count()) {
      result.vertices.push_back(now(v));
    }
  }
  for (const EdgeVertices& e : selection.edges) {
    if (const auto edge = after.find_edge(now(e[0]), now(e[1]))) {
      result.edges.push_back(after.edge(*edge));
    }
  }
  for (const Index f : selection.faces) {
    std::vector<Index> corners;
    for (const Index v : before.face_vertices(f)) {
      corners.push_back(now(v));
    }
    std::sort(corners.begin(), corners.end());
    if (corners.empty() || corners.back() >= after.vertex_count()) {
      continue;
    }
    for (const Index g : after.vertex_faces(corners[0])) {
      const std::span<const Index> face = after.face_vertices(g);
      std::vector<Index> sorted(face.begin(), face.end());
      std::sort(sorted.begin(), sorted.end());
      if (sorted == corners) {
        result.faces.push_back(g);
      }
    }
  }
  make_unique(result.vertices);
  make_unique(result.edges);
  make_unique(result.faces);
  return result;
}

} // namespace cagewright::app
