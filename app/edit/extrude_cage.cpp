// Faces of a cage that are extruded.
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
