#include "binding.h"
#include "json.h"
#include "load.h"
#include "report/following.h"
#include "session.h"

#include "io/source.h"
#include <cagewright/deform/following.h>
#include <cagewright/deform/weights_file.h>

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace cagewright::cli {
namespace {

struct Options {
  BindingOptions binding;
  std::string output;
  std::string json;
  std::optional<WeightsFormat> format; // none: as the output's extension says
};

/// As asked for, or as the name says. vertex-groups is JSON, too: a name cannot say it.
Result<WeightsFormat> format_of(const Options& options) {
  if (options.format) {
    return *options.format;
  }
  if (const auto format = weights_format_of_name(options.output)) {
    return *format;
  }
  return Error{ErrorCode::invalid_option,
               one_line(options.output) + ": the extension names no format of weights; use .npz, "
                                          ".csv, .json or .dmat, or say --format"};
}

/// What --json says of a binding. Errors: cancelled, cannot_write.
Status write_report(const Options& options, const CoordinateSettings& settings,
                    const ModelAndCage& meshes, const Coordinates& coordinates,
                    const PointCounts& counts, const Session& session) {
  const std::vector<Vec3>& points = meshes.bound.mesh.positions;
  const Result<UnseenShare> unseen =
      unseen_share(meshes.cage, coordinates, points, session.progress());
  if (!unseen) {
    return unseen.error();
  }
  const double bound = coordinates.error_bound();
  const double estimate = coordinates.error_estimate();
  return write_json(
      options.json,
      {{"format", "cagewright-bind"},
       {"version", 1},
       {"model", options.binding.model},
       {"cage", options.binding.cage},
       {"output", options.output},
       {"coordinates", settings.name()},
       {"options", settings.text()},
       {"points", points.size()},
       {"columns", coordinates.columns()},
       {"on_cage", counts.on_surface},
       {"outside", counts.outside},
       {"undefined", counts.undefined},
       {"error_bound", bound > 0 ? nlohmann::json(bound) : nlohmann::json(nullptr)},
       {"error_estimate", estimate > 0 ? nlohmann::json(estimate) : nlohmann::json(nullptr)},
       {"unseen_share", json_of(*unseen)},
       {"notes", notes_as_json()}});
}

int run(const Options& options, const Session& session) {
  if (const Status writable =
          can_write_output(options.output, {options.binding.model, options.binding.cage,
                                            options.binding.coordinates.mix_weights});
      !writable) {
    return fail(writable.error());
  }
  const Result<WeightsFormat> format = format_of(options);
  if (!format) {
    return fail(format.error());
  }
  const bool is_best = options.binding.coordinates.kind == best_kind;
  Result<CoordinateSettings> settings =
      is_best ? CoordinateSettings() : settings_of(options.binding.coordinates);
  if (!settings) {
    return fail(settings.error());
  }
  const Result<ModelAndCage> meshes = read_model_and_cage(options.binding);
  if (!meshes) {
    return fail(meshes.error());
  }
  if (Status status = judge(*meshes, options.binding, session); !status) {
    return fail_of_judge(status.error());
  }
  if (is_best) {
    settings = chosen_settings(options.binding, *meshes, session);
    if (!settings) {
      return fail(settings.error());
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const auto coordinates = make_coordinates(*meshes, *settings, options.binding, session);
  if (!coordinates) {
    return fail(coordinates.error());
  }
  const Result<PointCounts> counts =
      bind_to_file(**coordinates, *settings, meshes->bound.mesh.positions, meshes->cage,
                   options.output, *format, session.progress());
  if (!counts) {
    return fail(counts.error());
  }
  warn_of_points(options.binding.cage, *counts);
  if ((*coordinates)->error_estimate() > 0) {
    session.say(fmt::format("{}: weights err by {:.2g} at most a hundredth of the cage's diagonal "
                            "inside it, as far as a coarser computation tells",
                            options.output, (*coordinates)->error_estimate()));
    session.say((*coordinates)->error_bound() > 0
                    ? fmt::format("; nowhere by more than {:.2g}\n", (*coordinates)->error_bound())
                    : "\n");
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  if (!options.json.empty()) {
    if (const Status written =
            write_report(options, *settings, *meshes, **coordinates, *counts, session);
        !written) {
      return fail(written.error());
    }
  }
  session.say(fmt::format("{}: {} model vertices bound to {} cage vertices in {:.2f} s\n",
                          options.output, meshes->bound.mesh.positions.size(),
                          meshes->cage.positions.size(), seconds.count()));
  return done;
}

} // namespace

void add_bind(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "bind", "Compute how a model follows its cage, and store it: for deform --weights, NumPy, "
              "spreadsheets, or groups of vertices");
  auto options = std::make_shared<Options>();
  add_binding_options(*command, options->binding);
  command
      ->add_option("-o,--output", options->output,
                   "The file to write: .npz (numpy.load), .csv, .json or .dmat (libigl)")
      ->required();
  command
      ->add_option("--format", options->format,
                   "Instead of what the extension says: npz, csv, json, dmat, or vertex-groups "
                   "(JSON for scripts in Blender and Maya: a group for each vertex of the cage)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, WeightsFormat>{{"npz", WeightsFormat::npz},
                                               {"csv", WeightsFormat::csv},
                                               {"json", WeightsFormat::json},
                                               {"dmat", WeightsFormat::dmat},
                                               {"vertex-groups", WeightsFormat::vertex_groups}}))
      ->option_text("FORMAT");
  command->add_option("--json", options->json,
                      "Write to this file as JSON what was bound, and how much of the weights "
                      "belongs to vertices of the cage that points do not see");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
