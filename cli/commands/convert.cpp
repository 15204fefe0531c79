#include "load.h"
#include "session.h"

#include <cagewright/io/mesh_format.h>
#include <cagewright/io/write_mesh.h>

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

namespace cagewright::cli {
namespace {

struct Options {
  std::string input;
  std::string output;
  bool text = false;
};

int run(const Options& options, const Session& session) {
  if (const Status writable = can_write_mesh(options.output); !writable) {
    return fail(writable.error());
  }
  const Result<ModelFile> file = load_model(options.input);
  if (!file) {
    return fail(file.error());
  }
  const Result<MeshAttributes> attributes = file->attributes();
  if (!attributes) {
    return fail(attributes.error());
  }
  const Result<std::vector<FileNote>> notes =
      write_mesh(file->mesh(), *attributes, options.output, {.ascii_ply = options.text});
  if (!notes) {
    return fail(notes.error());
  }
  tell(*notes);
  if (!session.quiet) {
    fmt::print("{}: {} vertices, {} faces\n", options.output, file->mesh().positions.size(),
               file->mesh().face_count());
  }
  return done;
}

} // namespace

void add_convert(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "convert", "Write a model in another format, with all that the format can hold");
  auto options = std::make_shared<Options>();
  command->add_option("input", options->input, "The model to read")->required();
  command->add_option("output", options->output, "The model to write: .obj, .ply, .stl or .off")
      ->required();
  command->add_flag("--text", options->text, "PLY as text instead of binary");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
