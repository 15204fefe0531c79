#include "quads/edge_loops.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace cagewright {
namespace {

using Side = std::array<Index, 2>;
using SideMap = std::map<Side, std::array<Index, 2>>; // face to the left, the corner it begins at

constexpr Index none = ~Index{0};

SideMap sides_of(const PolygonMesh& mesh) {
  SideMap sides;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (Index i = 0; i < face.size(); ++i) {
      sides[{face[i], face[(i + 1) % face.size()]}] = {f, i};
    }
  }
  return sides;
}

/// How many closed walks of sides there are, each one way or the other. `next` is the same side
/// where a walk ends.
template <class Next> std::size_t closed_walks(const SideMap& sides, const Next& next) {
  std::set<Side> seen;
  std::size_t closed = 0;
  for (const auto& [start, place] : sides) {
    if (seen.contains(start)) {
      continue;
    }
    Side side = start;
    while (seen.insert(side).second) {
      side = next(side);
    }
    closed += side == start && next(start) != start ? 1 : 0;
  }
  return closed / 2; // each was walked both ways
}

/// Follows quads across opposite sides, from the one to the left of `start`.
/// \returns false if that ends at another face, or comes to a quad again
bool follow(const PolygonMesh& mesh, const SideMap& sides, const Side& start, QuadStrip& strip) {
  std::set<Index> seen;
  Side side = start;
  for (;;) {
    const auto at = sides.find(side);
    strip.rungs.push_back(side);
    if (at == sides.end()) {
      return true; // a border
    }
    const std::span<const Index> face = mesh.face(at->second[0]);
    if (face.size() != 4 || !seen.insert(at->second[0]).second) {
      return false;
    }
    strip.faces.push_back(at->second[0]);
    const Index i = at->second[1];
    side = {face[(i + 3) % 4], face[(i + 2) % 4]};
    if (side == start) {
      strip.closed = true;
      return true;
    }
  }
}

/// Every side once each way, every vertex in one fan, no face with a corner twice, and neighbours
/// that have one side in common only.
bool is_manifold(const PolygonMesh& mesh) {
  std::map<Side, Index> sides;
  std::vector<std::vector<Index>> around(mesh.positions.size());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      if (!sides.try_emplace({face[i], face[(i + 1) % face.size()]}, f).second ||
          std::count(face.begin(), face.end(), face[i]) > 1) {
        return false;
      }
      around[face[i]].push_back(f);
    }
  }
  const auto next_at = [&](Index v, Index f) { // the face across the side that ends at v
    const std::span<const Index> face = mesh.face(f);
    const auto i = static_cast<std::size_t>(std::find(face.begin(), face.end(), v) - face.begin());
    const auto at = sides.find({v, face[(i + face.size() - 1) % face.size()]});
    return at == sides.end() ? none : at->second;
  };
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (around[v].empty()) {
      continue;
    }
    const auto is_first = [&](Index f) { // no face ends where it begins, at v
      const std::span<const Index> face = mesh.face(f);
      const auto i =
          static_cast<std::size_t>(std::find(face.begin(), face.end(), v) - face.begin());
      return !sides.contains({face[(i + 1) % face.size()], v});
    };
    const auto border = std::find_if(around[v].begin(), around[v].end(), is_first);
    const bool open = border != around[v].end();
    const Index first = open ? *border : around[v].front();
    std::size_t fan = 1;
    for (Index f = next_at(v, first); f != none && f != first && fan <= around[v].size();
         f = next_at(v, f)) {
      ++fan;
    }
    if (fan != around[v].size() || fan < (open ? 2U : 3U)) {
      return false;
    }
  }
  return true;
}

/// Without the vertices that no face uses.
/// \param number  of each vertex its new number
PolygonMesh compacted(const PolygonMesh& mesh, std::vector<Index>& number) {
  PolygonMesh result;
  number.assign(mesh.positions.size(), none);
  for (const Index v : mesh.corners()) {
    number[v] = 0;
  }
  for (Index v = 0; v < mesh.positions.size(); ++v) {
    if (number[v] != none) {
      number[v] = static_cast<Index>(result.positions.size());
      result.positions.push_back(mesh.positions[v]);
    }
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) {
      face.push_back(number[v]);
    }
    result.add_face(face);
  }
  return result;
}

} // namespace

std::vector<QuadStrip> strips_of(const PolygonMesh& mesh) {
  const SideMap sides = sides_of(mesh);
  std::vector<QuadStrip> strips;
  std::set<Side> seen;
  const auto add = [&](const Side& start) {
    QuadStrip strip;
    const bool whole = !seen.contains(start) && follow(mesh, sides, start, strip);
    for (const auto& [a, b] : strip.rungs) {
      seen.insert({a, b});
      seen.insert({b, a});
    }
    if (whole && !strip.faces.empty()) {
      strips.push_back(std::move(strip));
    }
  };
  // First those that begin at a border: elsewhere one would find half of them only.
  for (const auto& [side, place] : sides) {
    if (!sides.contains({side[1], side[0]})) {
      add(side);
    }
  }
  for (const auto& [side, place] : sides) {
    add(side);
  }
  std::erase_if(strips, [&](const QuadStrip& strip) {
    return !strip.closed && sides.contains({strip.rungs[0][1], strip.rungs[0][0]});
  });
  return strips;
}

PolygonMesh split_strip(const PolygonMesh& mesh, const QuadStrip& strip) {
  PolygonMesh result;
  result.positions = mesh.positions;
  std::vector<Index> middle;
  for (const auto& [a, b] : strip.rungs) {
    middle.push_back(static_cast<Index>(result.positions.size()));
    result.positions.push_back((mesh.positions[a] + mesh.positions[b]) / 2);
  }
  std::vector<std::uint8_t> is_split(mesh.face_count(), 0);
  for (std::size_t i = 0; i < strip.faces.size(); ++i) {
    is_split[strip.faces[i]] = 1;
    const std::size_t next = (i + 1) % strip.rungs.size();
    const auto& [a, b] = strip.rungs[i];
    const auto& [d, c] = strip.rungs[next];
    result.add_face({a, middle[i], middle[next], d});
    result.add_face({middle[i], b, c, middle[next]});
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (is_split[f] == 0) {
      result.add_face(mesh.face(f));
    }
  }
  return result;
}

std::optional<PolygonMesh> collapse_strip(const PolygonMesh& mesh, const QuadStrip& strip,
                                          const std::vector<Vec3>& places,
                                          std::vector<Index>& drawn) {
  PolygonMesh result;
  result.positions = mesh.positions;
  std::vector<Index> into(mesh.positions.size());
  for (Index v = 0; v < into.size(); ++v) {
    into[v] = v;
  }
  std::set<Index> used;
  for (std::size_t i = 0; i < strip.rungs.size(); ++i) {
    const auto& [a, b] = strip.rungs[i];
    if (!used.insert(a).second || !used.insert(b).second) {
      return std::nullopt; // rungs that hang together
    }
    into[b] = a;
    result.positions[a] = places[i];
  }
  std::vector<std::uint8_t> is_gone(mesh.face_count(), 0);
  for (const Index f : strip.faces) {
    is_gone[f] = 1;
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (is_gone[f] == 0) {
      std::vector<Index> face;
      for (const Index v : mesh.face(f)) {
        face.push_back(into[v]);
      }
      result.add_face(face);
    }
  }
  std::vector<Index> number;
  result = compacted(result, number);
  if (result.face_count() == 0 || !is_manifold(result)) {
    return std::nullopt;
  }
  drawn.clear();
  for (const auto& [a, b] : strip.rungs) {
    drawn.push_back(number[a]);
  }
  return result;
}

std::size_t closed_strips(const PolygonMesh& mesh) {
  const SideMap sides = sides_of(mesh);
  // The side across the quad to the left, the other way round; the same if there is no quad.
  const auto across = [&](const Side& side) {
    const auto at = sides.find(side);
    if (at == sides.end() || mesh.face(at->second[0]).size() != 4) {
      return side;
    }
    const std::span<const Index> face = mesh.face(at->second[0]);
    const Index i = at->second[1];
    return Side{face[(i + 3) % 4], face[(i + 2) % 4]};
  };
  return closed_walks(sides, across);
}

std::size_t closed_loops(const PolygonMesh& mesh) {
  const SideMap sides = sides_of(mesh);
  std::vector<int> quads(mesh.positions.size(), 0);
  std::vector<std::uint8_t> regular(mesh.positions.size(), 1);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    for (const Index v : mesh.face(f)) {
      ++quads[v];
      regular[v] = mesh.face(f).size() == 4 ? regular[v] : 0;
    }
  }
  // The side that goes straight on from the end of this one, or the same if there is none.
  const auto straight_on = [&](const Side& side) {
    const Index v = side[1];
    if (quads[v] != 4 || regular[v] == 0) {
      return side;
    }
    Side to = side;
    for (int turn = 0; turn < 2; ++turn) { // to the side after it round the face, and across
      const auto at = sides.find(to);
      if (at == sides.end()) {
        return side;
      }
      const std::span<const Index> face = mesh.face(at->second[0]);
      const Side next{v, face[(at->second[1] + 2) % 4]};
      to = turn == 0 ? Side{next[1], next[0]} : next;
    }
    return to;
  };
  return closed_walks(sides, straight_on);
}

} // namespace cagewright
