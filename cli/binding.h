/// \file
/// What the commands bind and deform share: a model, a cage at rest, and whether they fit.
#pragma once

#include "coordinate_options.h"
#include "model_choice.h"
#include "session.h"

#include <cagewright/coordinates/coordinates.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <memory>
#include <string>

namespace cagewright::cli {

/// How a model is bound, as the command line says.
struct BindingOptions {
  std::string model;
  std::string cage;
  CoordinateArguments coordinates;
  bool strict = false;
  ModelChoice choice;
};

/// The error, with the file it is about in front.
Error about_file(const std::string& path, const Error& error);

/// Declares the arguments MODEL and CAGE and the options of coordinates, --strict,
/// --mix, --mix-weights, --pose, --only and --cage-object.
void add_binding_options(CLI::App& command, BindingOptions& options);

Result<ModelAndCage> read_model_and_cage(const BindingOptions& options);

/// Says on stderr what is wrong with the cage for this model, with counts. With --strict that is an
/// error (no_valid_cage).
Status judge(const ModelAndCage& meshes, const BindingOptions& options, const Session& session);

/// fail() for what judge() returns: a cage that is not valid is a finding.
int fail_of_judge(const Error& error);

/// What was asked for; with --coordinates auto the kind that carries the model best, of which is
/// said why. Errors: invalid_option, invalid_cage, cancelled.
Result<CoordinateSettings> chosen_settings(const BindingOptions& options,
                                           const ModelAndCage& meshes, const Session& session);

/// The cage ready for binding the model; it may be open, of which judge() has warned.
Result<std::shared_ptr<const Coordinates>> make_coordinates(const ModelAndCage& meshes,
                                                            const CoordinateSettings& settings,
                                                            const BindingOptions& options,
                                                            const Session& session);

/// Says on stderr how many model vertices lie on the cage or stay at rest, if any.
void warn_of_points(const std::string& cage, const PointCounts& counts);

} // namespace cagewright::cli
