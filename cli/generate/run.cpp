#include "generate/run.h"

#include "generate/density.h"
#include "joints.h"
#include "json.h"
#include "load.h"
#include "model_choice.h"
#include "report/cage_report.h"

#include "cage/decompose.h"
#include "cage/hexahedron.h"
#include "io/atomic_file.h"
#include "io/source.h"
#include "io/write_gltf.h"
#include "voxel/voxel_mesh.h"
#include <cagewright/cage/generate_for_polygons.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/skinned_cage.h>
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <array>
#include <cassert>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

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

/// For messages about what was made of all of them.
std::string name_of_models(const GenerateArguments& arguments) {
  const std::size_t others = arguments.models.size() - 1;
  return arguments.models.front() + (others == 0 ? "" : " and " + std::to_string(others) + " more");
}

/// The cage with the rig of its model. It is placed by joints, in floats: so it is judged once more
/// as the file shows it.
Result<std::string> skinned(const GenerateArguments& arguments, const PolygonMesh& cage,
                            const TriangleMesh& model) {
  const Pose pose = arguments.choice.pose;
  Result<std::string> bytes = format_skinned_cage(arguments.models.front(), pose, cage,
                                                  is_gltf_json_name(arguments.output));
  if (!bytes) {
    return bytes.error();
  }
  const Result<ModelFile> file = ModelFile::parse(*bytes, MeshFormat::gltf, arguments.output, pose);
  if (!file) {
    return file.error();
  }
  const Result<ValidityReport> report = validate_cage(
      file->mesh(), model, {.allow_pieces = true, .allow_inner_shells = true, .first_only = true});
  if (!report) {
    return report.error();
  }
  if (!report->valid()) {
    return Error{
        ErrorCode::no_valid_cage,
        one_line(arguments.output) +
            ": placed by its joints, in the floats of glTF, the cage is not valid; give it "
            "more clearance (--clearance 1%), or write it without --skin-cage"};
  }
  return bytes;
}

Result<std::string> bytes_of(const GenerateArguments& arguments, const PolygonMesh& mesh,
                             const TriangleMesh& model) {
  if (arguments.skin_cage) {
    return skinned(arguments, mesh, model);
  }
  const std::optional<MeshFormat> format = format_of_name(arguments.output);
  assert(format); // run_generate() has asked can_write()
  Result<std::string> bytes = format_mesh(mesh, *format);
  return bytes ? std::move(bytes) : in_file(arguments.output, bytes.error());
}

/// The mesh and its description: both or neither.
Status write_outputs(const GenerateArguments& arguments, const PolygonMesh& mesh,
                     const TriangleMesh& model, const nlohmann::json& description) {
  const Result<std::string> bytes = bytes_of(arguments, mesh, model);
  if (!bytes) {
    return bytes.error();
  }
  nlohmann::json all = description;
  all["notes"] = notes_as_json();
  const std::string json = text_of(all, 1);
  std::vector<NamedBytes> files;
  if (arguments.json == "-") {
    if (Status written = write_json(arguments.json, all); !written) {
      return written;
    }
  } else if (!arguments.json.empty()) {
    files.push_back({arguments.json, json});
  }
  files.push_back({arguments.output, *bytes});
  return write_files_atomically(files);
}

int emit_stage(const GenerateArguments& arguments, const Session& session,
               const TriangleMesh& model) {
  const Result<BoxDecomposition> boxes =
      decompose(model, decompose_options(arguments.options), session.progress());
  if (!boxes) {
    return fail(in_file(name_of_models(arguments), boxes.error()));
  }
  const std::vector<int> cover = boxes->tree.cover();
  const PolygonMesh mesh =
      arguments.emit == Emit::boxes ? box_objects(*boxes, cover) : voxel_objects(*boxes);
  if (const Status written = write_outputs(arguments, mesh, model, to_json(*boxes, cover));
      !written) {
    return fail(written.error());
  }
  session.say(summary(*boxes, cover));
  return done;
}

void tell_of_specks(const GeneratedCage& made, const GenerateArguments& arguments) {
  for (const Remark& remark : made.remarks) {
    if (remark.reason == Reason::specks_enclosed) {
      const FileNote note{"specks", one_line(name_of_models(arguments)) + ": " + remark.message +
                                        "; leave them out with --ignore-specks"};
      tell({&note, 1});
    }
  }
}

int make_cage(const GenerateArguments& arguments, const Session& session, const PolygonMesh& model,
              const PolygonMesh* start, const std::vector<double>& density,
              const std::vector<LimbJoint>& joints) {
  GenerateOptions options = arguments.options;
  options.joints = joints;
  options.start = start;
  options.density = density;
  const Result<GeneratedCage> made = generate_for_polygons(model, options, session.progress());
  if (!made) {
    const bool is_about_start = made.error().code == ErrorCode::invalid_cage;
    return fail(
        in_file(is_about_start ? arguments.start : name_of_models(arguments), made.error()));
  }
  tell_of_specks(*made, arguments);
  if (const Status written =
          write_outputs(arguments, made->faces, to_triangle_mesh(model), to_json(*made, options));
      !written) {
    return fail(written.error());
  }
  session.say(summary(*made, options));
  if (made->is_as_asked()) {
    return done;
  }
  std::fprintf(stderr, "cagewright: not as asked for: %s\n", made->remarks.front().message.c_str());
  return not_satisfiable;
}

Status can_write(const GenerateArguments& arguments, const std::vector<std::string>& inputs) {
  if (!arguments.skin_cage) {
    return can_write_cage(arguments.output, inputs);
  }
  if (format_of_name(arguments.output) != MeshFormat::gltf) {
    return Error{ErrorCode::unsupported, one_line(arguments.output) +
                                             ": with --skin-cage the cage is written as .glb or "
                                             ".gltf, which hold joints"};
  }
  if (arguments.models.size() > 1) {
    return Error{ErrorCode::invalid_option,
                 "--skin-cage: one model has the rig; give one, or leave it out"};
  }
  if (arguments.emit != Emit::cage) {
    return Error{ErrorCode::invalid_option, "--skin-cage: only cages follow joints; leave it out, "
                                            "or leave out --emit"};
  }
  return can_write_output(arguments.output, inputs);
}

} // namespace

int run_generate(const GenerateArguments& arguments, const Session& session) {
  std::fputs(without_effect(arguments).c_str(), stderr);
  std::vector<std::string> inputs = arguments.models;
  inputs.insert(inputs.end(), {arguments.density, arguments.joints, arguments.start});
  if (const Status writable = can_write(arguments, inputs); !writable) {
    return fail(writable.error());
  }
  if (!arguments.json.empty()) {
    inputs.push_back(arguments.output);
    const Status writable = can_write_output(arguments.json, inputs);
    if (!writable) {
      return fail(writable.error());
    }
  }
  const Result<PolygonMesh> mesh = load_chosen(arguments.models, arguments.choice);
  if (!mesh) {
    return fail(mesh.error());
  }
  if (arguments.emit != Emit::cage) {
    return emit_stage(arguments, session, to_triangle_mesh(*mesh));
  }
  std::vector<double> density;
  if (!arguments.density.empty()) {
    Result<std::vector<double>> asked = density_of(arguments.density, *mesh);
    if (!asked) {
      return fail(asked.error());
    }
    density = std::move(*asked);
  }
  const Result<std::vector<LimbJoint>> joints =
      limb_joints(arguments.joints, arguments.choice.pose);
  if (!joints) {
    return fail(joints.error());
  }
  std::optional<PolygonMesh> start;
  if (!arguments.start.empty()) {
    Result<PolygonMesh> read = load_mesh(arguments.start);
    if (!read) {
      return fail(read.error());
    }
    start = std::move(*read);
  }
  return make_cage(arguments, session, *mesh, start ? &*start : nullptr, density, *joints);
}

} // namespace cagewright::cli
