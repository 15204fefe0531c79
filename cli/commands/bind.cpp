#include "binding.h"
#include "session.h"

#include <cagewright/deform/weights_file.h>

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

namespace cagewright::cli {
namespace {

struct Options {
  BindingOptions binding;
  std::string output;
};

int run(const Options& options, const Session& session) {
  const Result<ModelAndCage> meshes = read_model_and_cage(options.binding);
  if (!meshes) {
    return fail(meshes.error());
  }
  if (Status status = judge(*meshes, options.binding, session); !status) {
    return fail(status.error());
  }
  const Result<MeanValueSolver> solver = make_solver(meshes->cage, options.binding);
  if (!solver) {
    return fail(solver.error());
  }
  const auto start = std::chrono::steady_clock::now();
  const Result<BoundCounts> counts = bind_to_file(*solver, meshes->bound.mesh.positions,
                                                  meshes->cage, options.output, session.progress());
  if (!counts) {
    return fail(counts.error());
  }
  warn_of_points(options.binding.cage, counts->on_surface, counts->undefined);
  if (!session.quiet) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("{}: {} model vertices bound to {} cage vertices in {:.2f} s\n", options.output,
               meshes->bound.mesh.positions.size(), meshes->cage.positions.size(), seconds.count());
  }
  return done;
}

} // namespace

void add_bind(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "bind", "Compute how a model follows its cage, and store it: a file for numpy.load");
  auto options = std::make_shared<Options>();
  add_binding_options(*command, options->binding);
  command->add_option("-o,--output", options->output, "The file to write, weights.npz")->required();
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
