#include "binding.h"
#include "load.h"
#include "report/cage_words.h"

#include <cagewright/deform/choose_coordinates.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace cagewright::cli {
Error about_file(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.message};
}

void add_binding_options(CLI::App& command, BindingOptions& options) {
  command.add_option("model", options.model, "The model")->required();
  command.add_option("cage", options.cage, "Its cage at rest: closed, round the model")->required();
  add_coordinate_options(command, options.coordinates, true);
  command.add_flag("--strict", options.strict,
                   "Stop with exit code 1 unless the cage is valid for the model; else only warn");
  add_pose_option(command, options.choice);
  add_only_option(command, options.choice,
                  "The cage is for this object or group of the model; all else stays as it is");
  add_cage_object_option(command, options.choice);
}

Result<ModelAndCage> read_model_and_cage(const BindingOptions& options) {
  return load_model_and_cage(options.model, options.cage, options.choice);
}

Status judge(const ModelAndCage& meshes, const BindingOptions& options, const Session& session) {
  const Triangulation triangles = every_cutting(meshes.bound.mesh);
  const TriangleView model{meshes.bound.mesh.positions, triangles.triangles};
  const Result<ValidityReport> report = validate_cage(
      meshes.cage, model,
      {.allow_pieces = true, .allow_inner_shells = true, .weld = true, .max_listed = 0},
      session.progress());
  if (!report) {
    return report.error();
  }
  for (const FileNote& note : hints(*report, meshes.cage, model, {options.model, options.cage})) {
    if (note.code != "loose_model_vertices") { // they move along: nothing to warn of
      warn(note.message);
    }
  }
  if (report->valid()) {
    return success();
  }
  const std::string message = not_valid_in_words(*report, {options.model, options.cage});
  if (options.strict) {
    return Error{ErrorCode::no_valid_cage, message};
  }
  warn(message);
  return success();
}

int fail_of_judge(const Error& error) {
  const int exit_code = fail(error);
  return error.code == ErrorCode::no_valid_cage ? found_faults : exit_code;
}

Result<CoordinateSettings> chosen_settings(const BindingOptions& options,
                                           const ModelAndCage& meshes, const Session& session) {
  if (options.coordinates.kind != best_kind) {
    return settings_of(options.coordinates);
  }
  const Result<ChosenCoordinates> chosen =
      choose_coordinates(meshes.cage, meshes.bound.mesh.positions, session.progress());
  if (!chosen) {
    return chosen.error().code == ErrorCode::cancelled ? chosen.error()
                                                       : about_file(options.cage, chosen.error());
  }
  for (const TriedKind& tried : chosen->tried) {
    session.say(
        tried.refusal.empty()
            ? fmt::format("  {:<20} bend {:.2f} %, twist {:.2f} %, drag across gaps {:.2f} %\n",
                          tried.kind->name, 100 * tried.bend, 100 * tried.twist, 100 * tried.drag)
            : fmt::format("  {:<20} cannot: {}\n", tried.kind->name, tried.refusal));
  }
  session.say(fmt::format("{}: {} coordinates, of all the least errors in sum, in % of the model's "
                          "diagonal\n",
                          options.cage, chosen->settings.kind().name));
  CoordinateArguments named = options.coordinates;
  named.kind = chosen->settings.kind().name;
  return settings_of(named);
}

Result<std::shared_ptr<const Coordinates>> make_coordinates(const PolygonMesh& cage,
                                                            const CoordinateSettings& settings,
                                                            const BindingOptions& options,
                                                            const Session& session) {
  CoordinateSettings permissive = settings;
  permissive.allow_open = true;
  auto coordinates = prepare_coordinates(cage, permissive, session.progress());
  return coordinates ? std::move(coordinates) : about_file(options.cage, coordinates.error());
}

void warn_of_points(const std::string& cage, const PointCounts& counts) {
  const auto warn = [&](std::size_t count, const char* what) {
    if (count > 0) {
      std::fprintf(stderr, "cagewright: warning: %s: %zu model %s %s\n", cage.c_str(), count,
                   count == 1 ? "vertex" : "vertices", what);
    }
  };
  warn(counts.on_surface, "on the cage: only the face there moves them");
  warn(counts.undefined, "without weights: left at rest");
  warn(counts.outside, "outside the cage, where the coordinates are not defined by themselves");
}

} // namespace cagewright::cli
