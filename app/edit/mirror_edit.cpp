#include "app/edit/mirror_edit.h"

#include "app/edit/cage_graph.h"
#include "app/edit/draft.h"
#include "app/edit/select.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace cagewright::app {
namespace {

constexpr Index none = EditedCage::none;
using Corners = std::vector<Index>;

/// The same face, begun at its lowest corner.
Corners turned(std::span<const Index> face) {
  Corners corners(face.begin(), face.end());
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// The face of the images, which runs the other way round.
Corners image_of(std::span<const Index> face, std::span<const Index> partner) {
  Corners corners;
  for (auto v = face.rbegin(); v != face.rend(); ++v) {
    corners.push_back(partner[*v]);
  }
  return corners;
}

std::set<Corners> all_faces(const PolygonMesh& mesh) {
  std::set<Corners> faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    faces.insert(turned(mesh.face(f)));
  }
  return faces;
}

/// The partners of the vertices after the edit: those of before, and for new ones and those that
/// moved, the images by place. None where some have none.
std::vector<Index> partners_after(const PolygonMesh& before, const Symmetry& symmetry,
                                  const EditedCage& edited, double tolerance) {
  const std::vector<Vec3>& positions = edited.mesh.positions;
  std::vector<Index> partner =
      find_partners(positions, symmetry.point, symmetry.normal, tolerance).partner;
  for (Index v = 0; v < positions.size(); ++v) {
    const Index old = edited.old_of_new[v];
    if (old == none || positions[v] != before.positions[old]) {
      continue;
    }
    const Index other = edited.new_of_old[symmetry.partner[old]];
    if (other != none && positions[other] == before.positions[symmetry.partner[old]]) {
      partner[v] = other; // a cage need not be mirrored to the last bit
    }
  }
  const auto is_mutual = [&](Index v) { return v < partner.size() && partner[v] < partner.size(); };
  for (Index v = 0; v < partner.size(); ++v) {
    if (!is_mutual(v) || partner[partner[v]] != v) {
      return {};
    }
  }
  return partner;
}

enum class Side { leading, following, across };

Side side_of(std::span<const Index> face, std::span<const double> height,
             std::span<const Index> partner) {
  bool above = false;
  bool below = false;
  for (const Index v : face) {
    above = above || (partner[v] != v && height[v] > 0);
    below = below || (partner[v] != v && height[v] < 0);
  }
  return above && !below ? Side::leading : below && !above ? Side::following : Side::across;
}

Error not_alike() {
  return refuse("that cannot be done alike on both sides of the mirror plane; switch symmetric "
                "editing off, or select less");
}

} // namespace

bool is_mirrored(const PolygonMesh& cage, const Symmetry& symmetry) {
  if (symmetry.partner.size() != cage.positions.size() ||
      std::find(symmetry.partner.begin(), symmetry.partner.end(), Symmetry::none) !=
          symmetry.partner.end()) {
    return false;
  }
  const std::set<Corners> faces = all_faces(cage);
  return std::all_of(faces.begin(), faces.end(), [&](const Corners& face) {
    return faces.contains(turned(image_of(face, symmetry.partner)));
  });
}

Result<EditedCage> mirrored_edit(const PolygonMesh& before, const Symmetry& symmetry,
                                 EditedCage edited, double side, double tolerance) {
  const std::vector<Index> partner = partners_after(before, symmetry, edited, tolerance);
  if (partner.empty()) {
    return not_alike();
  }
  std::vector<Vec3>& positions = edited.mesh.positions;
  std::vector<double> height(positions.size());
  for (Index v = 0; v < positions.size(); ++v) {
    height[v] = (positions[v] - symmetry.point).dot(symmetry.normal) * (side < 0 ? -1 : 1);
  }

  // Faces in their order, those of the following side as the leading one has them.
  const CageGraph graph_before(edited.mesh);
  const std::vector<Index> selected = vertices_of(edited.selection, graph_before);
  const std::set<Corners> was = all_faces(edited.mesh);
  PolygonMesh mesh;
  mesh.positions = positions;
  mesh.colors = edited.mesh.colors;
  mesh.group_names = edited.mesh.group_names;
  const auto add = [&](const Corners& face, std::size_t like) {
    mesh.add_face(face);
    if (!edited.mesh.face_groups.empty()) {
      mesh.face_groups.push_back(edited.mesh.face_groups[like]);
    }
  };
  std::set<Corners> wanted; // on the following side
  for (std::size_t f = 0; f < edited.mesh.face_count(); ++f) {
    if (side_of(edited.mesh.face(f), height, partner) == Side::leading) {
      wanted.insert(turned(image_of(edited.mesh.face(f), partner)));
    }
  }
  for (std::size_t f = 0; f < edited.mesh.face_count(); ++f) {
    const std::span<const Index> face = edited.mesh.face(f);
    const Side at = side_of(face, height, partner);
    if (at == Side::across && !was.contains(turned(image_of(face, partner)))) {
      return not_alike();
    }
    if (at != Side::following || wanted.contains(turned(face))) {
      add({face.begin(), face.end()}, f);
    }
  }
  for (std::size_t f = 0; f < edited.mesh.face_count(); ++f) {
    const Corners image = image_of(edited.mesh.face(f), partner);
    if (side_of(edited.mesh.face(f), height, partner) == Side::leading &&
        !was.contains(turned(image))) {
      add(image, f);
    }
  }

  for (Index v = 0; v < positions.size(); ++v) {
    const Index old = edited.old_of_new[v];
    const bool stays = old != none && positions[v] == before.positions[old];
    if (partner[v] == v) {
      mesh.positions[v] = stays ? positions[v] : symmetry.onto_plane(positions[v]);
    } else if (height[v] < 0 && !stays) {
      mesh.positions[v] = symmetry.mirror(positions[partner[v]]);
    }
  }
  if (const Status good = check_edited(before, mesh); !good) {
    return not_alike();
  }
  Selection chosen;
  chosen.vertices = selected;
  edited.selection = converted(chosen, edited.selection.mode, CageGraph(mesh));
  edited.mesh = std::move(mesh);
  return edited;
}

} // namespace cagewright::app
