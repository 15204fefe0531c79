#include "generate/arguments.h"
#include "generate/run.h"
#include "joints.h"
#include "session.h"

#include <memory>
#include <string>

namespace cagewright::cli {

void add_generate(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("generate", "Make a valid cage for a model");
  const auto arguments = std::make_shared<GenerateArguments>();
  command
      ->add_option("MODEL", arguments->models,
                   "OBJ, PLY, STL, OFF, GLB or glTF file; of several, a figure and its clothes or "
                   "the poses of an animation, one cage is made for all")
      ->required();
  command->add_option("-o,--output", arguments->output, "OBJ, PLY, STL or OFF file to write")
      ->required();
  add_cage_options(*command, *arguments);
  command
      ->add_option("--start", arguments->start,
                   "A cage of your own, made valid and tight by moving its vertices: one made by "
                   "hand, or for an earlier state of the model. Its faces and the order of its "
                   "vertices stay")
      ->option_text("CAGE")
      ->group(std::string(title_of(OptionGroup::cage)));
  add_pose_option(*command, arguments->choice);
  add_only_option(*command, arguments->choice,
                  "Make the cage for this object or group of the model");
  for (const char* name : {"--pose", "--only"}) {
    command->get_option(name)->group(std::string(title_of(OptionGroup::model)));
  }
  command
      ->add_option(
          "--density", arguments->density,
          "Where the cage is to be finer: a text or .npy file of one number for each vertex "
          "of the model (four times as much: edges half as long), or 'colors': where its "
          "vertex colors are red, and coarser where blue")
      ->option_text("FILE|colors")
      ->group(std::string(title_of(OptionGroup::model)));
  add_joints_option(*command, arguments->joints,
                    "Where limbs bend: a ring of edges goes round the limb there")
      ->group(std::string(title_of(OptionGroup::model)));
  const char* results = "Results";
  command
      ->add_flag("--skin-cage", arguments->skin_cage,
                 "The cage of a rigged model follows its joints, as the model near it does: a .glb "
                 "or .gltf file with the rig, its animations, and the cage instead of the model")
      ->group(results);
  command
      ->add_option("--json", arguments->json,
                   "File for all figures and the options used; of boxes every box, axis, "
                   "cross-section and cut")
      ->option_text("FILE")
      ->group(results);
  command
      ->add_option_function<std::string>(
          "--emit",
          [arguments](const std::string& what) {
            arguments->emit = what == "boxes"    ? Emit::boxes
                              : what == "voxels" ? Emit::voxels
                                                 : Emit::cage;
          },
          "What to write: the cage, the boxes (one object each), or the voxels they are made of")
      ->check(CLI::IsMember({"cage", "boxes", "voxels"}))
      ->option_text("cage|boxes|voxels [cage]")
      ->group(results);
  command->footer("Lengths are parts of the diagonal of the model's box: 0.2% or 0.002.\n"
                  "Options of the boxes without --method mean boxes.\n"
                  "Exit code 0: done as asked; 3: a valid cage is written, but not all that was "
                  "asked for holds.\n\n"
                  "Examples:\n"
                  "  cagewright generate model.obj -o cage.obj                  the best cage of "
                  "100 vertices\n"
                  "  cagewright generate model.obj -o cage.obj --vertices 60 --quads\n"
                  "  cagewright generate model.obj -o cage.obj --max-gap 2%     the coarsest cage "
                  "within 2 %\n"
                  "  cagewright generate skin.obj coat.obj -o cage.obj          one cage "
                  "for both\n"
                  "  cagewright generate model.obj -o cage.obj --pieces apart   a closed surface "
                  "for each piece\n"
                  "  cagewright generate model.obj -o cage.obj --start my_cage.obj\n"
                  "  cagewright generate model.obj -o boxes.obj --depth 4       the union of "
                  "oriented boxes\n");
  command->callback([arguments, &session] {
    imply_method(*arguments);
    session.run = [arguments, &session] { return run_generate(*arguments, session); };
  });
}

} // namespace cagewright::cli
