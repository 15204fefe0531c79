#include "mesh/edge_chains.h"

#include <map>

namespace cagewright {

std::vector<EdgeChain> chains_of(std::span<const std::array<Index, 2>> edges) {
  std::map<Index, std::vector<Index>> next;
  std::map<Index, int> ends;
  for (const auto& [a, b] : edges) {
    next[a].push_back(b);
    ++ends[b];
  }
  std::vector<EdgeChain> chains;
  const auto follow = [&](Index first) {
    EdgeChain chain;
    for (Index at = first;;) {
      chain.vertices.push_back(at);
      const auto onward = next.find(at);
      chain.simple &= ends[at] <= 1 && (onward == next.end() || onward->second.size() == 1);
      if (onward == next.end()) {
        break;
      }
      const Index to = onward->second.back();
      onward->second.pop_back();
      if (onward->second.empty()) {
        next.erase(onward);
      }
      if (to == first) {
        chain.closed = true;
        break;
      }
      at = to;
    }
    chains.push_back(std::move(chain));
  };
  std::vector<Index> firsts;
  for (const auto& [a, onward] : next) {
    if (ends[a] == 0) {
      firsts.push_back(a);
    }
  }
  for (const Index a : firsts) {
    follow(a);
  }
  while (!next.empty()) {
    follow(next.begin()->first);
  }
  return chains;
}

std::vector<std::array<Index, 2>> edges_between_parts(const PolygonMesh& mesh,
                                                      std::span<const Index> parts) {
  std::map<std::array<Index, 2>, Index> part_left_of;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      part_left_of[{face[i], face[(i + 1) % face.size()]}] = parts[f];
    }
  }
  std::vector<std::array<Index, 2>> edges;
  for (const auto& [edge, part] : part_left_of) {
    const auto other = part_left_of.find({edge[1], edge[0]});
    if (other != part_left_of.end() && other->second < part) {
      edges.push_back(edge);
    }
  }
  return edges;
}

} // namespace cagewright
