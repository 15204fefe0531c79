#include "json.h"
#include "load.h"
#include "model_choice.h"
#include "report/model_info.h"
#include "report/plane_text.h"
#include "session.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>

namespace cagewright::cli {
namespace {

struct Options {
  std::string model;
  std::string json;
  VoxelizeOptions voxels;
  ModelChoice choice;
};

std::string plural(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string describe_faces(const ModelInfo& info) {
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

std::string describe_topology(const ModelInfo& info) {
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

std::string describe_defects(const ModelInfo& info) {
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

std::string describe_sizes(const ModelInfo& info) {
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

std::string describe_mirror(const ModelInfo& info) {
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

int run(const Options& options, const Session& session) {
  const auto model = load_chosen(options.model, options.choice);
  if (!model) {
    return fail(model.error());
  }
  const auto info = describe_model(*model, options.voxels, session.progress());
  if (!info) {
    return fail(info.error());
  }
  if (!options.json.empty()) {
    nlohmann::json figures = json_of(*info);
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
