#include <cagewright/cage/specks.h>

#include "cage/pieces.h"
#include "mesh/disjoint_sets.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <utility>

namespace cagewright {
namespace {

constexpr double far = 0.05;         // of the diagonal of the rest
constexpr double tiny = 0.05;        // the length of a piece, of the body's diagonal
constexpr double least_share = 0.01; // of the body's area
constexpr int resolution = 64;

/// What counts of a group.
struct Group {
  Box3 box;
  double area = 0;
  double longest_piece = 0;
};

/// For each vertex the first one of its piece.
std::vector<Index> pieces_of(TriangleView model) {
  const WeldedPoints points = weld_points(model.positions);
  DisjointSets sets(points.positions.size());
  for (const Triangle& t : model.triangles) {
    sets.join({points.point_of[t[0]], points.point_of[t[1]], points.point_of[t[2]]});
  }
  std::vector<Index> pieces;
  pieces.reserve(model.positions.size());
  for (const Index point : points.point_of) {
    pieces.push_back(points.first_with[sets.find(point)]);
  }
  return pieces;
}

std::vector<Group> groups_of(const ModelPart& part, std::span<const Index> pieces,
                             const PieceGroups& numbers) {
  std::vector<Group> groups(numbers.count);
  std::vector<Box3> boxes(pieces.size());
  for (std::size_t i = 0; i < part.vertices.size(); ++i) {
    const Vec3& p = part.mesh.positions[i];
    groups[numbers.group_of[i]].box.extend(p);
    boxes[pieces[part.vertices[i]]].extend(p);
  }
  for (std::size_t i = 0; i < part.vertices.size(); ++i) {
    Group& group = groups[numbers.group_of[i]];
    const Box3& piece = boxes[pieces[part.vertices[i]]];
    group.longest_piece = std::max(group.longest_piece, piece.diagonal().norm());
  }
  for (const Triangle& t : part.mesh.triangles) {
    const Vec3& a = part.mesh.positions[t[0]];
    groups[numbers.group_of[t[0]]].area +=
        (part.mesh.positions[t[1]] - a).cross(part.mesh.positions[t[2]] - a).norm() / 2;
  }
  return groups;
}

/// The model without the vertices that are in specks.
ModelPart rest_of(TriangleView model, const std::vector<bool>& is_speck) {
  PieceGroups groups;
  groups.count = 2;
  for (const bool is : is_speck) {
    groups.group_of.push_back(is ? 1 : 0);
  }
  return std::move(parts_of(model, groups).front());
}

} // namespace

std::vector<bool> Specks::faces_in_none(const PolygonMesh& model) const {
  std::vector<bool> faces;
  for (std::size_t f = 0; f < model.face_count(); ++f) {
    faces.push_back(!of_vertex[model.face(f).front()]);
  }
  return faces;
}

Result<Specks> find_specks(TriangleView model, const Progress& progress) {
  Specks specks;
  specks.of_vertex.assign(model.positions.size(), false);
  const std::vector<Index> pieces = pieces_of(model);
  if (std::all_of(pieces.begin(), pieces.end(),
                  [&](Index piece) { return piece == pieces.front(); })) {
    return specks;
  }
  // Seen from far away what is near the model hangs together with it: so once more without what has
  // been found, as long as there is more.
  for (bool is_more = true; is_more;) {
    is_more = false;
    const ModelPart rest = rest_of(model, specks.of_vertex);
    const Result<PieceGroups> numbers = piece_groups(rest.mesh, far / 2, resolution, progress);
    if (!numbers) {
      return numbers.error();
    }
    const std::vector<Group> groups = groups_of(rest, pieces, *numbers);
    const Group& body =
        *std::max_element(groups.begin(), groups.end(),
                          [](const Group& a, const Group& b) { return a.area < b.area; });
    std::vector<bool> is_speck;
    for (const Group& group : groups) {
      is_speck.push_back(&group != &body && group.area <= least_share * body.area &&
                         group.longest_piece <= tiny * body.box.diagonal().norm());
      is_more = is_more || is_speck.back();
    }
    for (std::size_t i = 0; i < rest.vertices.size(); ++i) {
      specks.of_vertex[rest.vertices[i]] = is_speck[numbers->group_of[i]];
    }
  }
  const auto first = std::find(specks.of_vertex.begin(), specks.of_vertex.end(), true);
  if (first == specks.of_vertex.end()) {
    return specks;
  }
  for (Index v = 0; v < pieces.size(); ++v) { // a piece is named by its first vertex
    specks.count += specks.of_vertex[v] && pieces[v] == v ? 1 : 0;
  }
  specks.place = model.positions[static_cast<std::size_t>(first - specks.of_vertex.begin())];
  specks.triangles = static_cast<std::size_t>(
      std::count_if(model.triangles.begin(), model.triangles.end(),
                    [&](const Triangle& t) { return specks.of_vertex[t[0]]; }));
  specks.enlargement =
      diagonal(model.positions) / diagonal(rest_of(model, specks.of_vertex).mesh.positions);
  return specks;
}

Result<std::vector<bool>> faces_in_no_speck(const PolygonMesh& model, const Progress& progress) {
  const Result<Specks> specks = find_specks(to_triangle_mesh(model), progress);
  return specks ? specks->faces_in_none(model) : Result<std::vector<bool>>(specks.error());
}

} // namespace cagewright
