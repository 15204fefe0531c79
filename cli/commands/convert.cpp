#include "load.h"
#include "model_choice.h"
#include "session.h"

#include <cagewright/io/mesh_format.h>
#include <cagewright/io/write_mesh.h>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace cagewright::cli {
namespace {

struct Options {
  std::string input;
  std::string output;
  bool text = false;
  ModelChoice choice;
};

/// glTF stays the same file, in the other container where the extensions differ.
Result<std::vector<FileNote>> write(const ModelFile& file, const Options& options) {
  if (file.format() == MeshFormat::gltf && file.keeps_format(options.output)) {
    const Status written = file.rewrite(file.mesh().positions, {}, options.output);
    return written ? Result<std::vector<FileNote>>(std::vector<FileNote>()) : written.error();
  }
  const Result<MeshAttributes> attributes = file.attributes();
  if (!attributes) {
    return attributes.error();
  }
  return write_mesh(file.mesh(), *attributes, options.output, {.ascii_ply = options.text});
}

int run(const Options& options, const Session& session) {
  const Status writable = can_write_model(options.output, {options.input});
  if (!writable) {
    return fail(writable.error());
  }
  const Result<ModelFile> file = load_model(options.input, options.choice.pose);
  if (!file) {
    return fail(file.error());
  }
  const Result<std::vector<FileNote>> notes = write(*file, options);
  if (!notes) {
    return fail(notes.error());
  }
  tell(*notes);
  if (file->keeps_format(options.output)) {
    warn_of_links(*file, options.output);
  }
  session.say(fmt::format("{}: {} vertices, {} faces\n", options.output,
                          file->mesh().positions.size(), file->mesh().face_count()));
  return done;
}

} // namespace

void add_convert(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "convert", "Write a model in another format, with all that the format can hold");
  auto options = std::make_shared<Options>();
  command->add_option("input", options->input, "The model to read")->required();
  command
      ->add_option("output", options->output,
                   "The model to write: .obj, .ply, .stl, .off, .glb or .gltf")
      ->required();
  command->add_flag("--text", options->text, "PLY as text instead of binary");
  add_pose_option(*command, options->choice);
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
