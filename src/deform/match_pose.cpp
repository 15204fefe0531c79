#include <cagewright/deform/match_pose.h>

#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

namespace cagewright {
namespace {

constexpr Index none = std::numeric_limits<Index>::max();

/// A MatchedPose while it is being found.
struct Match {
  std::vector<Vec3> positions;
  std::string_view note;
};

/// Which vertices share an edge, and which a face.
class Neighbors {
public:
  /// \param names  for each vertex of the mesh, its name here; `none` leaves its faces out
  Neighbors(const PolygonMesh& mesh, std::span<const Index> names, std::size_t count)
      : of_(count), faces_of_(count) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      std::vector<Index>& ring = rings_.emplace_back();
      for (const Index v : mesh.face(f)) {
        if (ring.empty() || ring.back() != names[v]) {
          ring.push_back(names[v]);
        }
      }
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Index a = ring[k];
        const Index b = ring[(k + 1) % ring.size()];
        if (a != b) {
          of_[a].insert(b);
          of_[b].insert(a);
        }
        faces_of_[a].insert(f);
      }
    }
  }

  [[nodiscard]] bool share_edge(Index a, Index b) const { return of_[a].contains(b); }

  /// What becomes of an edge of `other` where the faces are cut otherwise: its ends are corners of
  /// a face whose sides are edges of the other, too; or it is the other diagonal of two triangles
  /// whose outer sides are.
  [[nodiscard]] bool replaces(Index a, Index b, const Neighbors& other) const {
    for (const std::size_t f : faces_of_[a]) {
      if (faces_of_[b].contains(f) && has_sides_in(rings_[f], other)) {
        return true;
      }
    }
    std::vector<Index> common;
    std::set_intersection(of_[a].begin(), of_[a].end(), of_[b].begin(), of_[b].end(),
                          std::back_inserter(common));
    std::erase_if(common,
                  [&](Index c) { return !other.share_edge(a, c) || !other.share_edge(b, c); });
    for (const Index c : common) {
      for (const Index d : common) {
        if (share_edge(c, d) && !other.share_edge(c, d)) {
          return true;
        }
      }
    }
    return false;
  }

  /// Every edge is one of the other's, or what one becomes.
  [[nodiscard]] bool agree_with(const Neighbors& other) const {
    for (Index a = 0; a < of_.size(); ++a) {
      for (const Index b : of_[a]) {
        if (b > a && !other.share_edge(a, b) && !other.replaces(a, b, *this)) {
          return false;
        }
      }
    }
    return true;
  }

private:
  static bool has_sides_in(std::span<const Index> ring, const Neighbors& other) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Index a = ring[k];
      const Index b = ring[(k + 1) % ring.size()];
      if (a != b && !other.share_edge(a, b)) {
        return false;
      }
    }
    return true;
  }

  std::vector<std::vector<Index>> rings_; // by face
  std::vector<std::set<Index>> of_;
  std::vector<std::set<std::size_t>> faces_of_;
};

/// The faces, whichever corner they begin at and in whichever order they are listed.
std::vector<std::vector<Index>> face_set(const PolygonMesh& mesh, std::span<const Index> names) {
  std::vector<std::vector<Index>> faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index>& face = faces.emplace_back();
    for (const Index v : mesh.face(f)) {
      face.push_back(names[v]);
    }
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Names 0, 1, ... for the vertices that faces use, `none` for the others.
struct UsedNames {
  std::vector<Index> of;
  Index count = 0;
};

UsedNames used_names(const PolygonMesh& mesh) {
  UsedNames names{std::vector<Index>(mesh.positions.size(), none)};
  for (const Index v : mesh.corners()) {
    names.of[v] = 0;
  }
  for (Index& name : names.of) {
    name = name == none ? none : names.count++;
  }
  return names;
}

/// The vertices of `rest` are those of `posed` by these names: C of the one, P of the other.
/// \returns for each vertex at rest its place, if the edges agree.
std::optional<Match> by_names(const PolygonMesh& rest, std::span<const Index> rest_names,
                              const PolygonMesh& posed, std::span<const Index> posed_names,
                              std::size_t count) {
  const Neighbors at_rest(rest, rest_names, count);
  const Neighbors moved(posed, posed_names, count);
  if (!at_rest.agree_with(moved) || !moved.agree_with(at_rest)) {
    return std::nullopt;
  }
  std::vector<Index> vertex_of(count, none);
  for (Index v = 0; v < posed_names.size(); ++v) {
    if (posed_names[v] != none) {
      vertex_of[posed_names[v]] = v;
    }
  }
  Match pose;
  for (Index v = 0; v < rest_names.size(); ++v) {
    const bool is_there = rest_names[v] != none && vertex_of[rest_names[v]] != none;
    pose.positions.push_back(is_there ? posed.positions[vertex_of[rest_names[v]]]
                                      : rest.positions[v]);
  }
  if (face_set(rest, rest_names) != face_set(posed, posed_names)) {
    pose.note = "its faces are others than those of the cage at rest, which are taken";
  }
  return pose;
}

/// Face by face and corner by corner: all corners of one vertex must have gone to one place.
std::optional<Match> by_corners(const PolygonMesh& rest, const PolygonMesh& posed) {
  if (rest.face_count() != posed.face_count()) {
    return std::nullopt;
  }
  Match pose{rest.positions, ""};
  std::vector<char> known(rest.positions.size(), 0);
  std::vector<Index> first_of(posed.positions.size(), none);
  const WeldedPoints rest_points = weld_points(rest.positions);
  for (std::size_t f = 0; f < rest.face_count(); ++f) {
    const std::span<const Index> from = rest.face(f);
    const std::span<const Index> to = posed.face(f);
    if (from.size() != to.size()) {
      return std::nullopt;
    }
    for (std::size_t k = 0; k < from.size(); ++k) {
      const Vec3& place = posed.positions[to[k]];
      if (known[from[k]] != 0 && pose.positions[from[k]] != place) {
        return std::nullopt;
      }
      // Two places at rest may not have become one vertex.
      const Index point = rest_points.point_of[from[k]];
      if (first_of[to[k]] != none && first_of[to[k]] != point) {
        return std::nullopt;
      }
      known[from[k]] = 1;
      first_of[to[k]] = point;
      pose.positions[from[k]] = place;
    }
  }
  pose.note = "its vertices are numbered, split or merged otherwise than those of the cage at "
              "rest; they are told by the corners of the faces";
  return pose;
}

PolygonMesh cut(const PolygonMesh& mesh) {
  TriangleMesh triangles = to_triangle_mesh(mesh);
  return PolygonMesh(triangles);
}

std::vector<Index> numbers(std::size_t count) {
  std::vector<Index> list(count);
  for (Index i = 0; i < count; ++i) {
    list[i] = i;
  }
  return list;
}

std::optional<Match> match_by_number(const PolygonMesh& rest, const PolygonMesh& posed) {
  const std::size_t count = rest.positions.size();
  if (posed.positions.size() == count) {
    return by_names(rest, numbers(count), posed, numbers(count), count);
  }
  // Loose vertices more or fewer.
  const UsedNames at_rest = used_names(rest);
  const UsedNames moved = used_names(posed);
  if (at_rest.count == moved.count) {
    std::optional<Match> pose = by_names(rest, at_rest.of, posed, moved.of, at_rest.count);
    if (pose) {
      pose->note = pose->note.empty() ? "it has other vertices that no face uses than the cage at "
                                        "rest; these are left out"
                                      : "it has other vertices that no face uses than the cage at "
                                        "rest, and other faces; both are left out";
    }
    return pose;
  }
  // Merged here and split there, or the other way round.
  const WeldedPoints rest_points = weld_points(rest.positions);
  const WeldedPoints posed_points = weld_points(posed.positions);
  if (rest_points.positions.size() == posed_points.positions.size()) {
    std::optional<Match> pose = by_names(rest, rest_points.point_of, posed, posed_points.point_of,
                                         rest_points.positions.size());
    if (pose) {
      pose->note = "its vertices are split or merged otherwise than those of the cage at rest; "
                   "they are told by their positions";
    }
    return pose;
  }
  return std::nullopt;
}

Error mismatch(const PolygonMesh& rest, const PolygonMesh& posed, const std::string& what) {
  const auto counts = [](const PolygonMesh& mesh) {
    return std::to_string(mesh.positions.size()) + " vertices and " +
           std::to_string(mesh.face_count()) + " faces";
  };
  if (rest.positions.size() == posed.positions.size()) {
    return {ErrorCode::mismatch,
            what +
                ": its vertices are in another order than those of the cage at rest, or it is "
                "another cage (both have " +
                std::to_string(rest.positions.size()) +
                " vertices, but other edges); pose a copy of the cage at rest, and export it with "
                "the vertex order kept"};
  }
  return {ErrorCode::mismatch,
          what + " has " + counts(posed) + ", the cage at rest " + counts(rest) +
              ": vertices were added, removed or split; pose a copy of the cage at rest without "
              "changing its vertices, or bind the model to the new cage in its rest pose"};
}

} // namespace

Result<MatchedPose> match_pose(const PolygonMesh& rest, const PolygonMesh& posed,
                               const std::string& what) {
  std::optional<Match> pose = match_by_number(rest, posed);
  for (const bool rest_is_cut : {false, true}) {
    for (const bool posed_is_cut : {false, true}) {
      if (!pose) {
        pose = by_corners(rest_is_cut ? cut(rest) : rest, posed_is_cut ? cut(posed) : posed);
      }
    }
  }
  if (!pose) {
    return mismatch(rest, posed, what);
  }
  return MatchedPose{std::move(pose->positions), std::string(pose->note)};
}

} // namespace cagewright
