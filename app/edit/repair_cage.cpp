#include "app/edit/repair_cage.h"

#include "app/edit/cage_graph.h"
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace cagewright::app {
namespace {

/// Six times the volume under the face, seen from `origin`.
double volume_under(const PolygonMesh& cage, std::span<const Index> face, const Vec3& origin) {
  double sum = 0;
  const Vec3 a = cage.positions[face[0]] - origin;
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    sum += a.dot((cage.positions[face[k]] - origin).cross(cage.positions[face[k + 1]] - origin));
  }
  return sum;
}

/// Whether the face runs from a to b.
bool runs_along(std::span<const Index> face, Index a, Index b) {
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (face[k] == a && face[(k + 1) % face.size()] == b) {
      return true;
    }
  }
  return false;
}

} // namespace

PolygonMesh welded_cage(const PolygonMesh& cage, double tolerance) {
  const PolygonMesh exact = weld(cage);
  const CageGraph graph(exact);
  std::vector<Index> open;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    if (graph.edge_faces(e).size() == 1) {
      open.insert(open.end(), graph.edge(e).begin(), graph.edge(e).end());
    }
  }
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  std::vector<Index> becomes(exact.positions.size());
  std::iota(becomes.begin(), becomes.end(), Index{0});
  for (std::size_t i = 0; i < open.size(); ++i) {
    for (std::size_t j = 0; j < i && becomes[open[i]] == open[i]; ++j) {
      if (becomes[open[j]] == open[j] &&
          (exact.positions[open[i]] - exact.positions[open[j]]).norm() <= tolerance) {
        becomes[open[i]] = open[j];
      }
    }
  }
  PolygonMesh result;
  std::vector<Index> number(exact.positions.size(), ~Index{0});
  for (std::size_t f = 0; f < exact.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : exact.face(f)) {
      if (corners.empty() || corners.back() != becomes[v]) {
        corners.push_back(becomes[v]);
      }
    }
    while (corners.size() > 1 && corners.front() == corners.back()) {
      corners.pop_back();
    }
    if (corners.size() < 3) {
      continue;
    }
    for (Index& v : corners) {
      if (number[v] == ~Index{0}) {
        number[v] = static_cast<Index>(result.positions.size());
        result.positions.push_back(exact.positions[v]);
      }
      v = number[v];
    }
    result.add_face(corners);
  }
  return result;
}

PolygonMesh turned_outward(const PolygonMesh& cage) {
  const CageGraph graph(cage);
  std::vector<int> turn(cage.face_count(), -1); // -1: not reached yet
  for (Index seed = 0; seed < cage.face_count(); ++seed) {
    if (turn[seed] >= 0) {
      continue;
    }
    std::vector<Index> piece = {seed};
    turn[seed] = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Index f = piece[i];
      for (const Index e : graph.face_edges(f)) {
        const std::span<const Index> both = graph.edge_faces(e);
        if (both.size() != 2) {
          continue; // on which side the next one is, is not clear
        }
        const Index other = both[0] == f ? both[1] : both[0];
        if (other == f || turn[other] >= 0) {
          continue;
        }
        const auto [a, b] = graph.edge(e);
        const bool same_way = runs_along(cage.face(f), a, b) == runs_along(cage.face(other), a, b);
        turn[other] = same_way ? 1 - turn[f] : turn[f];
        piece.push_back(other);
      }
    }
    double volume = 0;
    for (const Index f : piece) {
      volume += (turn[f] == 1 ? -1 : 1) *
                volume_under(cage, cage.face(f), cage.positions[cage.face(seed)[0]]);
    }
    if (volume < 0) {
      for (const Index f : piece) {
        turn[f] = 1 - turn[f];
      }
    }
  }
  PolygonMesh result;
  result.positions = cage.positions;
  result.colors = cage.colors;
  result.face_groups = cage.face_groups;
  result.group_names = cage.group_names;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    std::vector<Index> corners(cage.face(f).begin(), cage.face(f).end());
    if (turn[f] == 1) {
      std::reverse(corners.begin() + 1, corners.end());
    }
    result.add_face(corners);
  }
  return result;
}

} // namespace cagewright::app
