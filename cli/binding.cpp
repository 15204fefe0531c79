#include "binding.h"
#include "load.h"
#include "report/cage_words.h"

#include "io/source.h"
#include <cagewright/coordinates/mixed.h>
#include <cagewright/deform/choose_coordinates.h>
#include <cagewright/io/read_vertex_weights.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace cagewright::cli {
Error about_file(const std::string& path, const Error& error) {
  return {error.code, path + ": " + error.message};
}

void add_binding_options(CLI::App& command, BindingOptions& options) {
  command.add_option("model", options.model, "The model")->required();
  command.add_option("cage", options.cage, "Its cage at rest: closed, round the model")->required();
  add_coordinate_options(command, options.coordinates, true);
  add_mix_options(command, options.coordinates);
  command.add_flag("--strict", options.strict,
                   "Stop with exit code 1 unless the cage is valid for the model; else only warn");
  add_pose_option(command, options.choice);
  add_only_option(command, options.choice,
                  "The cage is for this object or group of the model; all else stays as it is");
  add_specks_option(command, options.choice, "Bind the model");
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
  if (options.coordinates.kind != best_kind || !options.coordinates.mix.empty()) {
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

namespace {

/// For the vertices of the faces that a group has.
Result<std::vector<double>> shares_of_group(const std::string& name, const ModelFile& file) {
  const Result<std::vector<bool>> faces = faces_named(file, std::span(&name, 1), "--mix-weights");
  if (!faces) {
    return faces.error();
  }
  const PolygonMesh& model = file.mesh();
  std::vector<double> shares(model.positions.size(), 0.0);
  for (std::size_t f = 0; f < faces->size(); ++f) {
    for (const Index v : model.face(f)) {
      shares[v] = (*faces)[f] ? 1 : shares[v];
    }
  }
  return shares;
}

/// Red paint as --density takes it.
Result<std::vector<double>> shares_of_colors(const PolygonMesh& model) {
  if (model.colors.empty()) {
    return Error{ErrorCode::unfit_model,
                 "--mix-weights colors: the model has no vertex colors; paint it red where --mix "
                 "is to hold, or give a file with a number a line"};
  }
  std::vector<double> shares;
  for (const std::array<float, 4>& color : model.colors) {
    shares.push_back(std::clamp<double>(color[0] - std::max(color[1], color[2]), 0, 1));
  }
  return shares;
}

/// The share of --mix for the vertices that are bound. Errors: invalid_option, unfit_model,
/// mismatch, those of read_vertex_weights().
Result<std::vector<double>> shares_of_mix(const CoordinateArguments& arguments,
                                          const ModelAndCage& meshes) {
  constexpr std::string_view group = "group:";
  const std::string& source = arguments.mix_weights;
  if (source.empty()) {
    return Error{ErrorCode::invalid_option,
                 "--mix: say with --mix-weights how much of each vertex of the model it is for"};
  }
  const std::size_t count = meshes.model().positions.size();
  const Result<std::vector<double>> all =
      source == "colors"          ? shares_of_colors(meshes.model())
      : source.starts_with(group) ? shares_of_group(source.substr(group.size()), meshes.file)
                                  : read_vertex_weights(source, count);
  if (!all) {
    return all.error();
  }
  std::vector<double> shares;
  for (const Index v : meshes.bound.vertices) {
    shares.push_back((*all)[v]);
    if (shares.back() > 1) {
      return Error{ErrorCode::mismatch,
                   fmt::format("{}: the share of vertex {} is {}; give numbers from 0 to 1",
                               one_line(source), v, shares.back())};
    }
  }
  return shares;
}

} // namespace

Result<std::shared_ptr<const Coordinates>> make_coordinates(const ModelAndCage& meshes,
                                                            const CoordinateSettings& settings,
                                                            const BindingOptions& options,
                                                            const Session& session) {
  CoordinateSettings permissive = settings;
  permissive.allow_open = true;
  if (settings.mixed() == nullptr) {
    auto coordinates = prepare_coordinates(meshes.cage, permissive, session.progress());
    return coordinates ? std::move(coordinates) : about_file(options.cage, coordinates.error());
  }
  const Result<std::vector<double>> shares = shares_of_mix(options.coordinates, meshes);
  if (!shares) {
    return shares.error();
  }
  auto coordinates = prepare_mixed(meshes.cage, permissive, meshes.bound.mesh.positions, *shares,
                                   session.progress());
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
