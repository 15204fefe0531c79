#include "json.h"
#include "load.h"
#include "model_choice.h"
#include "plane_text.h"
#include "session.h"

#include "exact/predicates.h"
#include "mesh/topology.h"
#include "obb/minimum_box.h"
#include "obb/principal_axes.h"
#include "symmetry/mirror_plane.h"
#include "validate/self_crossings.h"
#include "voxel/point_set.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/model_volume.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

struct Options {
  std::string model;
  std::string json;
  VoxelizeOptions voxels;
  ModelChoice choice;
};

struct NamedBox {
  const char* key;   // in JSON
  const char* title; // for people
  OrientedBox box;
};

struct Info {
  std::size_t vertices = 0;
  std::size_t distinct_positions = 0;
  std::map<std::size_t, std::size_t> faces_by_sides;
  TopologyReport topology; // after merging equal positions
  std::size_t unused_vertices = 0;
  std::size_t degenerate_triangles = 0; // without area, or naming a vertex twice
  std::size_t self_crossings = 0;
  double diagonal = 0;
  double area = 0;
  ModelVolume volume;
  std::vector<NamedBox> boxes;
  std::optional<MirrorPlane> mirror;

  [[nodiscard]] std::size_t faces() const {
    std::size_t sum = 0;
    for (const auto& [sides, count] : faces_by_sides) {
      sum += count;
    }
    return sum;
  }
};

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
    std::ranges::sort(sorted);
    return sorted.size() == 3 || std::ranges::adjacent_find(sorted) == sorted.end();
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

Result<Info> describe(const PolygonMesh& model, const VoxelizeOptions& voxels,
                      const Progress& progress) {
  const TriangleMesh triangles = to_triangle_mesh(model);
  const PolygonMesh welded = weld(model);
  Info info;
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

std::string plural(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string describe_faces(const Info& info) {
  std::string kinds;
  for (const auto& [sides, count] : info.faces_by_sides) {
    const std::string name = sides == 3   ? plural(count, "triangle", "triangles")
                             : sides == 4 ? plural(count, "quad", "quads")
                                          : fmt::format("{} of {} sides", count, sides);
    kinds += (kinds.empty() ? "" : ", ") + name;
  }
  return fmt::format("{}, {}: {}\n", plural(info.vertices, "vertex", "vertices"),
                     plural(info.faces(), "face", "faces"), kinds);
}

std::string describe_topology(const Info& info) {
  const TopologyReport& topology = info.topology;
  std::string text =
      fmt::format("With equal positions merged ({} left):\n", info.distinct_positions);
  text += topology.is_closed()
              ? "  closed\n"
              : fmt::format("  open: {} in {}\n",
                            plural(topology.boundary_edges.size(), "open edge", "open edges"),
                            plural(topology.boundary_loops, "loop", "loops"));
  text += topology.is_manifold()
              ? "  manifold\n"
              : fmt::format("  not manifold: {}, {}\n",
                            plural(topology.nonmanifold_edges.size(), "edge of three or more faces",
                                   "edges of three or more faces"),
                            plural(topology.nonmanifold_vertices.size(), "pinched vertex",
                                   "pinched vertices"));
  text += topology.is_oriented()
              ? "  consistently oriented\n"
              : fmt::format("  not consistently oriented: {} between faces that disagree\n",
                            plural(topology.inconsistent_edges.size(), "edge", "edges"));
  text += fmt::format("  {}, genus {}\n", plural(topology.components, "component", "components"),
                      topology.genus ? std::to_string(*topology.genus) : "not defined");
  return text;
}

std::string describe_defects(const Info& info) {
  std::string text;
  const auto mention = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) {
      text += "  " + plural(count, one, many) + "\n";
    }
  };
  mention(info.unused_vertices, "vertex that no face uses", "vertices that no face uses");
  mention(info.degenerate_triangles, "triangle without area", "triangles without area");
  mention(info.topology.duplicate_faces.size(), "face that repeats another",
          "faces that repeat another");
  text += info.self_crossings == 0
              ? "  no self-intersections\n"
              : fmt::format("  {} that cross (an edge of one passes through the inside of the "
                            "other; pairs that share an edge not counted)\n",
                            plural(info.self_crossings, "pair of triangles", "pairs of triangles"));
  return text;
}

std::string describe_sizes(const Info& info) {
  std::string text = fmt::format(
      "Diagonal {:.6g}, area {:.6g}, volume {:.6g}{}\n", info.diagonal, info.area,
      info.volume.value,
      info.volume.method == VolumeMethod::sampled    ? " (open or inconsistent: sampled)"
      : info.volume.method == VolumeMethod::enclosed ? " (enclosed by parts that overlap, double "
                                                       "or enclose others: sampled)"
                                                     : "");
  text += "Boxes\n";
  for (const auto& [key, title, box] : info.boxes) {
    const Vec3 size = 2 * box.half;
    text += fmt::format("  {:<28}{:.6g} x {:.6g} x {:.6g}, volume {:.6g}\n", title, size.x(),
                        size.y(), size.z(), box.volume());
  }
  return text;
}

std::string describe_mirror(const Info& info) {
  if (!info.mirror) {
    return "No mirror plane\n";
  }
  constexpr double percent = 100;
  constexpr double rounding = 1e-9;
  if (info.mirror->high_error < rounding) {
    return fmt::format("Mirror plane {}: its exact mirror image\n", text_of(*info.mirror));
  }
  return fmt::format("Mirror plane {}: off its mirror image by {:.2g} % of the diagonal in the "
                     "mean, {:.2g} % at most but for a hundredth of the surface\n",
                     text_of(*info.mirror), percent * info.mirror->mean_error,
                     percent * info.mirror->high_error);
}

nlohmann::json to_json(const Info& info) {
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

int run(const Options& options, const Session& session) {
  const auto model = load_chosen(options.model, options.choice);
  if (!model) {
    return fail(model.error());
  }
  const auto info = describe(*model, options.voxels, session.progress());
  if (!info) {
    return fail(info.error());
  }
  if (!options.json.empty()) {
    nlohmann::json figures = to_json(*info);
    figures["notes"] = notes_as_json();
    if (const Status status = write_json(options.json, figures, 2); !status) {
      return fail(status.error());
    }
  }
  session.say(describe_faces(*info) + describe_topology(*info) + describe_defects(*info) +
              describe_sizes(*info) + describe_mirror(*info));
  return done;
}

} // namespace

void add_info(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("info", "Describe a model: counts, defects, sizes, boxes");
  auto options = std::make_shared<Options>();
  command->add_option("model", options->model, "The model")->required();
  add_pose_option(*command, options->choice);
  add_only_option(*command, options->choice, "Look at this object or group of the model only");
  command->add_option("--json", options->json, "Write the same and more to this file as JSON");
  command
      ->add_option("--resolution", options->voxels.resolution,
                   "Voxels along the longest axis, for the box of vertices and voxels")
      ->check(CLI::Range(2, 4096));
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
