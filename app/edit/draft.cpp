#include "app/edit/draft.h"

#include "app/edit/cage_graph.h"
#include "app/edit/select.h"
#include "mesh/topology.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace cagewright::app {
namespace {

constexpr Index none = EditedCage::none;

} // namespace

Error refuse(std::string why) {
  return {ErrorCode::invalid_cage, std::move(why)};
}

Error no_such(const char* what) {
  return refuse(std::string("there is no such ") + what);
}

bool has_faces(const PolygonMesh& cage, std::span<const Index> faces) {
  return !faces.empty() &&
         std::all_of(faces.begin(), faces.end(), [&](Index f) { return f < cage.face_count(); });
}

Status check_edited(const PolygonMesh& before, const PolygonMesh& after) {
  const TopologyReport was = topology(before);
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

Draft::Draft(const PolygonMesh& cage) : before_(cage), positions_(cage.positions) {
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    const std::span<const Index> face = cage.face(f);
    faces_.push_back(
        {{face.begin(), face.end()}, f < cage.face_groups.size() ? cage.face_groups[f] : 0});
  }
  origin_.resize(positions_.size());
  std::iota(origin_.begin(), origin_.end(), Index{0});
  like_ = origin_;
}

Index Draft::add_vertex(const Vec3& p, Index like) {
  positions_.push_back(p);
  origin_.push_back(none);
  like_.push_back(like);
  return static_cast<Index>(positions_.size() - 1);
}

void Draft::add_face(Corners corners, std::size_t like) {
  faces_.push_back({std::move(corners), faces_[like].group});
}

void Draft::replace_vertices(const std::map<Index, Index>& by) {
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

Result<EditedCage> Draft::finish(SelectionMode mode, const std::vector<Index>& selected) const {
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
  if (const Status good = check_edited(before_, result.mesh); !good) {
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

} // namespace cagewright::app
