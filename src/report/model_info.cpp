#include "report/model_info.h"

#include "exact/predicates.h"
#include "obb/minimum_box.h"
#include "obb/principal_axes.h"
#include "report/json.h"
#include "symmetry/mirror_plane.h"
#include "validate/self_crossings.h"
#include "voxel/point_set.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>

#include <algorithm>
#include <string>
#include <utility>

namespace cagewright {
namespace {

std::size_t count_degenerate(TriangleView mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return is_degenerate(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
      }));
}

/// A model without extent has no voxels: its fourth box is left out.
std::vector<NamedBox> boxes_of(TriangleView mesh, const VoxelizeOptions& voxels,
                               const Progress& progress) {
  std::vector<NamedBox> boxes = {
      {"axis_aligned", "axis-aligned", box_in_frame(Mat3::Identity(), mesh.positions)},
      {"pca_vertices", "PCA of the vertices", pca_box(mesh.positions)}};
  if (const auto grid = voxelize(mesh, boxes.back().box, voxels, progress)) {
    boxes.push_back({"pca_points", "PCA of vertices and voxels", pca_box(point_set(mesh, *grid))});
  }
  boxes.push_back({"minimum", "minimum volume", minimum_box(mesh.positions)});
  return boxes;
}

/// The mesh with the faces that visit a vertex twice cut into triangles: a polygon with a hole that
/// is joined to its outline by a bridge is a surface like any other.
PolygonMesh with_simple_faces(const PolygonMesh& mesh) {
  std::vector<Index> sorted;
  const auto is_simple = [&](std::size_t f) {
    sorted.assign(mesh.face(f).begin(), mesh.face(f).end());
    std::sort(sorted.begin(), sorted.end());
    return sorted.size() == 3 || std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  };
  const Triangulation cut = triangulate(mesh);
  PolygonMesh simple;
  simple.positions = mesh.positions;
  for (std::size_t f = 0, t = 0; f < mesh.face_count(); ++f) {
    const bool is_whole = is_simple(f);
    if (is_whole) {
      simple.add_face(mesh.face(f));
    }
    for (; t < cut.triangles.size() && cut.face_of[t] == f; ++t) {
      if (!is_whole) {
        simple.add_face(cut.triangles[t]);
      }
    }
  }
  return simple;
}

} // namespace

Result<ModelInfo> describe_model(const PolygonMesh& model, const VoxelizeOptions& voxels,
                                 const Progress& progress) {
  const TriangleMesh triangles = to_triangle_mesh(model);
  const PolygonMesh welded = weld(model);
  ModelInfo info;
  info.vertices = model.positions.size();
  info.distinct_positions = welded.positions.size();
  for (std::size_t f = 0; f < model.face_count(); ++f) {
    ++info.faces_by_sides[model.face(f).size()];
  }
  info.topology = topology(with_simple_faces(welded));
  info.unused_vertices = topology(model).unused_vertices.size();
  info.degenerate_triangles = count_degenerate(triangles);
  progress(0.2, "self-intersections");
  const auto crossings = count_self_crossings(triangles, progress.part(0.2, 0.6));
  if (!crossings) {
    return crossings.error();
  }
  info.self_crossings = *crossings;
  info.diagonal = diagonal(triangles.positions);
  info.area = surface_area(triangles);
  info.volume = model_volume(triangles);
  progress(0.6, "boxes");
  info.boxes = boxes_of(triangles, voxels, progress.part(0.6, 0.9));
  progress(0.9, "mirror plane");
  info.mirror = detect_mirror_plane(triangles, {}, progress.part(0.9, 1));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  progress(1, "done");
  return info;
}

nlohmann::json json_of(const ModelInfo& info) {
  const TopologyReport& topology = info.topology;
  nlohmann::json json = {{"vertices", info.vertices},
                         {"distinct_positions", info.distinct_positions},
                         {"faces", info.faces()},
                         {"closed", topology.is_closed()},
                         {"manifold", topology.is_manifold()},
                         {"oriented", topology.is_oriented()},
                         {"boundary_edges", topology.boundary_edges.size()},
                         {"boundary_loops", topology.boundary_loops},
                         {"nonmanifold_edges", topology.nonmanifold_edges.size()},
                         {"nonmanifold_vertices", topology.nonmanifold_vertices.size()},
                         {"inconsistent_edges", topology.inconsistent_edges.size()},
                         {"components", topology.components},
                         {"genus", nullptr},
                         {"unused_vertices", info.unused_vertices},
                         {"degenerate_triangles", info.degenerate_triangles},
                         {"duplicate_faces", topology.duplicate_faces.size()},
                         {"self_intersecting_pairs", info.self_crossings},
                         {"diagonal", info.diagonal},
                         {"area", info.area},
                         {"volume", info.volume.value},
                         {"volume_method", name_of(info.volume.method)}};
  if (topology.genus) {
    json["genus"] = *topology.genus;
  }
  json["mirror_plane"] = nullptr;
  if (info.mirror) {
    json["mirror_plane"] = {{"normal", json_of(info.mirror->normal)},
                            {"offset", info.mirror->offset},
                            {"mean_error", info.mirror->mean_error},
                            {"high_error", info.mirror->high_error}};
  }
  for (const auto& [sides, count] : info.faces_by_sides) {
    json["faces_by_sides"][std::to_string(sides)] = count;
  }
  for (const auto& [key, title, box] : info.boxes) {
    json["boxes"][key] = json_of(box);
  }
  return json;
}

} // namespace cagewright
