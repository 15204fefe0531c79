#include "generate_report.h"
#include "load.h"
#include "session.h"

#include "cage/budget_cage.h"
#include "cage/generate.h"
#include "cage/hexahedron.h"
#include "io/atomic_file.h"
#include "io/write_mesh.h"
#include "validate/cage_metrics.h"
#include "voxel/voxel_mesh.h"

#include <cstdio>
#include <map>
#include <memory>
#include <utility>

namespace cagewright::cli {
namespace {

enum class Emit { cage, boxes, voxels };

struct Arguments {
  std::string model;
  std::string output;
  std::string json;
  Emit emit = Emit::cage;
  GenerateOptions options;
  bool has_budget = false; ///< an option asks for more than the union of the boxes
  int vertices = 0;        ///< 0: not given
  BudgetCageOptions budget;
};

void say(const Session& session, const std::string& text) {
  if (!session.quiet) {
    std::fputs(text.c_str(), stdout);
  }
}

/// One object for each box, in the model's own coordinates.
PolygonMesh box_objects(const BoxDecomposition& boxes, const std::vector<int>& cover) {
  PolygonMesh mesh;
  for (const int at : cover) {
    const auto first = static_cast<Index>(mesh.positions.size());
    for (const Vec3& corner : boxes.tree.nodes[static_cast<std::size_t>(at)].box.corners()) {
      mesh.positions.push_back(boxes.to_model(corner));
    }
    for (const std::array<Index, 4>& face : hexahedron_faces) {
      mesh.add_face({face[0] + first, face[1] + first, face[2] + first, face[3] + first});
      mesh.face_groups.push_back(static_cast<Index>(mesh.group_names.size()));
    }
    mesh.group_names.push_back("box_" + std::to_string(at));
  }
  return mesh;
}

PolygonMesh voxel_objects(const BoxDecomposition& boxes) {
  PolygonMesh mesh = voxel_boxes(boxes.grid);
  for (Vec3& p : mesh.positions) {
    p = boxes.frame.from_unit(p);
  }
  return mesh;
}

/// Writes the JSON first: should the mesh fail then, no result stands without its description.
Status write_outputs(const Arguments& arguments, const PolygonMesh& mesh,
                     const nlohmann::json& description) {
  if (!arguments.json.empty()) {
    const Status written = write_file_atomically(arguments.json, description.dump(1) + "\n");
    if (!written) {
      return written;
    }
  }
  return write_mesh(mesh, arguments.output);
}

int emit_stage(const Arguments& arguments, const Session& session, const TriangleMesh& model) {
  const Result<BoxDecomposition> boxes =
      decompose(model, arguments.options.boxes, session.progress());
  if (!boxes) {
    return fail(in_file(arguments.model, boxes.error()));
  }
  const std::vector<int> cover = boxes->tree.cover();
  const PolygonMesh mesh =
      arguments.emit == Emit::boxes ? box_objects(*boxes, cover) : voxel_objects(*boxes);
  if (const Status written = write_outputs(arguments, mesh, to_json(*boxes, cover)); !written) {
    return fail(written.error());
  }
  say(session, summary(*boxes, cover));
  return done;
}

int make_cage(const Arguments& arguments, const Session& session, const TriangleMesh& model) {
  const Progress progress = session.progress();
  const Result<GeneratedCage> made =
      generate_cage(model, arguments.options, progress.part(0, 0.97));
  if (!made) {
    return fail(in_file(arguments.model, made.error()));
  }
  const CageMetrics metrics = measure_cage(made->cage, model);
  progress(1, "done");
  if (const Status written =
          write_outputs(arguments, PolygonMesh(made->cage), to_json(*made, metrics));
      !written) {
    return fail(written.error());
  }
  say(session, summary(*made, metrics));
  return done;
}

int make_cage_within_budget(const Arguments& arguments, const Session& session,
                            const TriangleMesh& model) {
  const Progress progress = session.progress();
  BudgetCageOptions options = arguments.budget;
  options.boxes = arguments.options;
  if (arguments.vertices > 0 || options.improve.faces > 0) {
    options.improve.vertices = arguments.vertices;
  }
  const Result<BudgetCage> made = make_budget_cage(model, options, progress.part(0, 0.97));
  if (!made) {
    return fail(in_file(arguments.model, made.error()));
  }
  const CageMetrics metrics = measure_cage(made->cage, model);
  progress(1, "done");
  if (const Status written =
          write_outputs(arguments, PolygonMesh(made->cage), to_json(*made, metrics));
      !written) {
    return fail(written.error());
  }
  say(session, summary(*made, metrics));
  return done;
}

int run(const Arguments& arguments, const Session& session) {
  if (const Status writable = can_write_mesh(arguments.output); !writable) {
    return fail(writable.error());
  }
  const Result<TriangleMesh> model = load_triangles(arguments.model);
  if (!model) {
    return fail(model.error());
  }
  if (arguments.emit != Emit::cage) {
    return emit_stage(arguments, session, *model);
  }
  return arguments.has_budget ? make_cage_within_budget(arguments, session, *model)
                              : make_cage(arguments, session, *model);
}

void add_slicing_options(CLI::App& command, SlicingOptions& slicing) {
  const char* group = "Slicing";
  command.add_option("--depth", slicing.depth, "How often a part of the model may be cut in two")
      ->check(CLI::Range(0, 20))
      ->group(group);
  command
      .add_option(
          "--boxes", slicing.max_boxes,
          "Use at most so many boxes, cutting where it pays most; 0: as many as --depth gives")
      ->check(CLI::Range(0, 100000))
      ->group(group);
  command
      .add_option("--slicing", slicing.rule,
                  "volume: cut where the boxes of the parts get smallest; "
                  "published: at the greatest jump of the cross-section")
      ->transform(CLI::CheckedTransformer(std::map<std::string, SlicingRule>{
          {"volume", SlicingRule::volume}, {"published", SlicingRule::published}}))
      ->default_str("volume")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--split", [&slicing](const std::string& how) { slicing.split_parts = how == "parts"; },
          "parts: each connected part of a half gets a box; binary: each half gets one")
      ->check(CLI::IsMember({"parts", "binary"}))
      ->default_str("parts")
      ->group(group);
  command
      .add_option(
          "--no-jump", slicing.no_jump,
          "With --slicing published, when no axis has a clear jump: middle cuts the longest "
          "edge in the middle, skip leaves the box whole")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, NoJump>{{"middle", NoJump::middle}, {"skip", NoJump::skip}}))
      ->default_str("middle")
      ->group(group);
  command
      .add_option("--min-jump", slicing.min_jump,
                  "With --slicing published: least clear jump, as a fraction of the greatest "
                  "cross-section")
      ->check(CLI::Range(0.0, 1.0))
      ->group(group);
  command
      .add_option("--min-gain", slicing.min_gain,
                  "With --slicing volume: least fraction of a box's volume that a cut must save")
      ->check(CLI::Range(0.0, 1.0))
      ->group(group);
  command
      .add_option("--eta", slicing.eta,
                  "Leave a box whole when (least / greatest cross-section) is above this, and "
                  "--zeta holds too; a value above 1 switches the test off")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command
      .add_option("--zeta", slicing.zeta,
                  "Leave a box whole when (shortest / longest edge) is above this, and --eta "
                  "holds too; a value above 1 switches the test off")
      ->check(CLI::PositiveNumber)
      ->group(group);
}

void add_pipeline_options(CLI::App& command, GenerateOptions& options) {
  const char* group = "Pipeline";
  command
      .add_option("--resolution", options.boxes.resolution,
                  "Voxels along the longest axis of the model's box")
      ->check(CLI::Range(8, 512))
      ->group(group);
  command
      .add_option_function<std::string>(
          "--registration",
          [&options](const std::string& how) { options.registration = how == "on"; },
          "Join the faces of neighbouring boxes where they fit")
      ->check(CLI::IsMember({"on", "off"}))
      ->default_str("on")
      ->group(group);
  command
      .add_option(
          "--pieces", options.boxes.pieces,
          "A model in several pieces gets one cage with thin bridges (together), or one for "
          "each group of pieces that are apart (apart)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Pieces>{{"together", Pieces::together}, {"apart", Pieces::apart}}))
      ->default_str("together")
      ->group(group);
}

void add_budget_options(CLI::App& command, Arguments& arguments) {
  const char* group = "Budget";
  BudgetCageOptions& budget = arguments.budget;
  const auto asked = [&arguments](const auto&) { arguments.has_budget = true; };
  command
      .add_option("--vertices", arguments.vertices,
                  "Make the best cage of at most so many vertices (100, if another option of this "
                  "group is given, and not --faces)")
      ->check(CLI::Range(4, 100000))
      ->default_str("")
      ->each(asked)
      ->group(group);
  command.add_option("--faces", budget.improve.faces, "The same for triangles; both may be given")
      ->check(CLI::Range(4, 200000))
      ->default_str("")
      ->each(asked)
      ->group(group);
  command
      .add_option("--method", budget.start,
                  "What a cage within a budget is made from: envelope, a surface of voxels of any "
                  "topology; or obb, the union of the boxes")
      ->transform(CLI::CheckedTransformer(std::map<std::string, CageStart>{
          {"envelope", CageStart::envelope}, {"obb", CageStart::obb}}))
      ->default_str("envelope")
      ->each(asked)
      ->group(group);
  command
      .add_option("--clearance", budget.improve.clearance,
                  "Least distance between cage and model, as a fraction of the model's diagonal")
      ->check(CLI::Range(1e-6, 0.5))
      ->each(asked)
      ->group(group);
  command
      .add_option(
          "--closing", budget.closing,
          "With --method envelope: fill holes and gaps narrower than twice this fraction of "
          "the model's diagonal")
      ->check(CLI::Range(0.0, 0.5))
      ->group(group);
  command
      .add_option("--envelope-resolution", budget.resolution,
                  "With --method envelope: voxels along the model's diagonal; 0: chosen by the "
                  "budget and the model")
      ->check(CLI::Range(0, 512))
      ->group(group);
}

} // namespace

void add_generate(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("generate", "Make a valid cage for a model");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("MODEL", arguments->model, "OBJ, PLY, STL, OFF, GLB or glTF file")
      ->required();
  command->add_option("-o,--output", arguments->output, "OBJ, PLY, STL or OFF file to write")
      ->required();
  command->add_option("--json", arguments->json,
                      "File for all figures: every box, axis, cross-section and cut");
  command
      ->add_option("--emit", arguments->emit,
                   "What to write: the cage, the boxes (one object each), or the voxels")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Emit>{
          {"cage", Emit::cage}, {"boxes", Emit::boxes}, {"voxels", Emit::voxels}}))
      ->default_str("cage");
  add_slicing_options(*command, arguments->options.boxes.slicing);
  add_pipeline_options(*command, arguments->options);
  add_budget_options(*command, *arguments);
  command->callback([arguments, &session] {
    session.run = [arguments, &session] { return run(*arguments, session); };
  });
}

} // namespace cagewright::cli
