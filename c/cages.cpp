#include "arrays.h"
#include "calls.h"
#include "handles.h"

#include "io/source.h"
#include "mesh/mesh_part.h"
#include "report/cage_figures.h"
#include "report/cage_report.h"
#include "report/compared_cage.h"
#include "report/json.h"
#include "report/model_info.h"
#include "report/verdict.h"
#include <cagewright/cage/density.h>
#include <cagewright/cage/generate.h>
#include <cagewright/cage/generate_for_polygons.h>
#include <cagewright/cage/option_table.h>
#include <cagewright/cage/specks.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace cagewright;
using namespace cagewright::c;

struct cw_options {
  GenerateOptions options;
  std::vector<double> density;
  std::vector<LimbJoint> joints;
  std::optional<PolygonMesh> start;
};

struct cw_cage {
  cw_mesh mesh;
  std::string report;
  bool is_as_asked = false;
};

struct cw_verdict {
  bool is_valid = false;
  std::string report;
};

namespace {

/// What the two meshes are called where a report names their files.
JudgedFiles names() {
  return {"model", "cage"};
}

Status describe_options(char** out) {
  nlohmann::json list = nlohmann::json::array();
  for (const CageOption& option : cage_options()) {
    list.push_back({{"name", option.name},
                    {"label", option.label},
                    {"help", option.help},
                    {"group", title_of(option.group)},
                    {"values", values_of(option)},
                    {"default", text_of(option, GenerateOptions())}});
  }
  *out = handed_out(text_of(list, -1));
  return success();
}

/// Bent polygons are enclosed whichever way they are cut. (Triangles are not copied for that.)
Result<GeneratedCage> cage_of(const MeshArgument& model, const GenerateOptions& options,
                              const Progress& progress) {
  const PolygonMesh* const polygons = model.if_polygons();
  return polygons != nullptr ? generate_for_polygons(*polygons, options, progress)
                             : generate(model.triangles(), options, progress);
}

Status make_cage(const cw_mesh_view* model, const cw_options* asked, const Progress& progress,
                 cw_cage** out) {
  const Result<MeshArgument> mesh = MeshArgument::of(model, "the model");
  if (!mesh) {
    return mesh.error();
  }
  GenerateOptions options = asked != nullptr ? asked->options : GenerateOptions();
  if (asked != nullptr && !asked->density.empty()) {
    const std::size_t vertices = mesh->triangles().positions.size();
    if (asked->density.size() != vertices) {
      return Error{ErrorCode::mismatch, "the density has " +
                                            counted(asked->density.size(), "weight") +
                                            ", but the model " + std::to_string(vertices) +
                                            " vertices; give one for each"};
    }
    options.density = asked->density;
  }
  if (asked != nullptr) {
    options.joints = asked->joints;
  }
  if (asked != nullptr && asked->start) {
    options.start = &*asked->start;
  }
  Result<GeneratedCage> made = cage_of(*mesh, options, progress);
  if (!made) {
    return made.error();
  }
  std::string report = text_of(to_json(*made, options), 1);
  const bool is_as_asked = made->is_as_asked();
  *out = new cw_cage{cw_mesh(std::move(made->faces)), std::move(report), is_as_asked};
  return success();
}

/// What a cage is judged for, in the model's own numbers.
struct Judged {
  TriangleView triangles;
  TriangleView cuttings;            ///< of its faces, whichever way they are cut
  std::span<const Index> face_of;   ///< of each of these its face in the model; none: the same
  std::span<const Index> vertex_of; ///< of each vertex its number in the model; none: the same
};

Status judge(const Judged& model, const PolygonMesh& cage, const ValidateOptions& options,
             const Progress& progress, cw_verdict** out) {
  const TriangleView triangles = model.triangles;
  Result<ValidityReport> report = validate_cage(cage, model.cuttings, options, progress);
  if (!report) {
    return report.error();
  }
  name_model_faces(*report, model.face_of);
  name_model_vertices(*report, model.vertex_of);
  nlohmann::json json = json_of(*report, names());
  json["cage"] =
      figures_as_json(measure_cage(report->merged_vertices > 0 ? weld(cage) : cage, triangles));
  json["notes"] = nlohmann::json::array();
  for (const FileNote& note : hints(*report, cage, triangles, names())) {
    json["notes"].push_back({{"code", note.code}, {"message", note.message}});
  }
  *out = new cw_verdict{report->valid(), text_of(json, 1)};
  return success();
}

Status judge_whole(const MeshArgument& model, const PolygonMesh& cage,
                   const ValidateOptions& options, const Progress& progress, cw_verdict** out) {
  const TriangleView triangles = model.triangles();
  if (model.if_polygons() == nullptr) {
    return judge({triangles, triangles, {}, {}}, cage, options, progress, out);
  }
  const Triangulation cuttings = every_cutting(*model.if_polygons());
  return judge({triangles, {triangles.positions, cuttings.triangles}, cuttings.face_of, {}}, cage,
               options, progress, out);
}

Status judge_without_specks(const MeshArgument& model, const PolygonMesh& cage,
                            const ValidateOptions& options, const Progress& progress,
                            cw_verdict** out) {
  const PolygonMesh whole = model.polygons();
  const Result<std::vector<bool>> is_kept = faces_in_no_speck(whole, progress.quiet());
  if (!is_kept) {
    return is_kept.error();
  }
  const MeshPart rest = part_of(whole, *is_kept);
  std::vector<Index> faces;
  for (Index f = 0; f < is_kept->size(); ++f) {
    if ((*is_kept)[f]) {
      faces.push_back(f);
    }
  }
  const Triangulation triangles = triangulate(rest.mesh);
  Triangulation cuttings = every_cutting(rest.mesh);
  for (Index& f : cuttings.face_of) {
    f = faces[f];
  }
  const std::vector<Vec3>& positions = rest.mesh.positions;
  return judge({{positions, triangles.triangles},
                {positions, cuttings.triangles},
                cuttings.face_of,
                rest.vertices},
               cage, options, progress, out);
}

Status compare(const MeshArgument& model, const cw_mesh_view* cages, const char* const* cage_names,
               std::size_t count, bool with_poses, const Progress& progress, char** out) {
  const ModelVolume volume = model_volume(model.triangles());
  const CoordinateSettings coordinates;
  nlohmann::json list = nlohmann::json::array();
  std::optional<BendableLimbs> limbs;
  if (with_poses) {
    Result<BendableLimbs> found = BendableLimbs::of(model.triangles(), {}, progress.quiet());
    if (found) { // else the model has no extent, and no limbs
      limbs = std::move(*found);
    } else if (found.error().code == ErrorCode::cancelled) {
      return found.error();
    }
  }
  const BendableLimbs* const bent = limbs && limbs->count() > 0 ? &*limbs : nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    if (cage_names != nullptr && cage_names[i] == nullptr) {
      return all_given({{nullptr, "the name of a cage"}});
    }
    const std::string name =
        cage_names != nullptr ? cage_names[i] : "cage " + std::to_string(i + 1);
    const Result<MeshArgument> cage = MeshArgument::of(&cages[i], name);
    if (!cage) {
      return cage.error();
    }
    const Progress share = progress.part(static_cast<double>(i) / static_cast<double>(count),
                                         static_cast<double>(i + 1) / static_cast<double>(count));
    const Result<ComparedCage> compared =
        compare_cage(name, cage->polygons(), model.triangles(), volume,
                     with_poses ? &coordinates : nullptr, bent, share);
    if (!compared) {
      return compared.error();
    }
    list.push_back(json_of(*compared, bent));
  }
  *out = handed_out(text_of(list, 1));
  return success();
}

} // namespace

cw_options* cw_options_new(void) {
  try {
    return new cw_options;
  } catch (...) {
    return nullptr;
  }
}

void cw_options_free(cw_options* options) {
  delete options;
}

cw_code cw_options_set(cw_options* options, const char* name, const char* value, cw_error** error) {
  return call(error, [&]() -> Status {
    const Status given = all_given(
        {{options, "the options"}, {name, "the name of the option"}, {value, "its value"}});
    if (!given) {
      return given;
    }
    const CageOption* const option = find_cage_option(name);
    if (option == nullptr) {
      std::string known;
      for (const CageOption& other : cage_options()) {
        known += (known.empty() ? "" : ", ") + std::string(other.name);
      }
      return Error{ErrorCode::invalid_option,
                   std::string(name) + " is no option of cages; there are " + known};
    }
    const Status set = set_from_text(*option, value, options->options);
    return set ? set : Error{set.error().code, std::string(name) + ": " + set.error().message};
  });
}

cw_code cw_options_set_joints(cw_options* options, const cw_array* joints, const cw_array* along,
                              cw_error** error) {
  return call(error, [&]() -> Status {
    if (Status given = all_given({{options, "the options"}, {joints, "the joints"}}); !given) {
      return given;
    }
    const Result<Points> points = Points::of(*joints, "the joints");
    if (!points) {
      return points.error();
    }
    const Result<Points> directions =
        along != nullptr ? Points::of(*along, "the directions of the joints") : Points();
    if (!directions) {
      return directions.error();
    }
    const auto positions = points->view();
    const auto vectors = directions->view();
    if (along != nullptr && vectors.size() != positions.size()) {
      return Error{ErrorCode::mismatch, "there are " + std::to_string(positions.size()) +
                                            " joints, but " + std::to_string(vectors.size()) +
                                            " directions; give one for each"};
    }
    std::vector<LimbJoint> limbs;
    for (std::size_t j = 0; j < positions.size(); ++j) {
      limbs.push_back({positions[j], along != nullptr ? vectors[j] : Vec3(Vec3::Zero())});
      if (!limbs.back().position.allFinite() || !limbs.back().along.allFinite()) {
        return Error{ErrorCode::malformed, "joint " + std::to_string(j) + " is not finite"};
      }
    }
    options->joints = std::move(limbs);
    return success();
  });
}

cw_code cw_options_set_density(cw_options* options, const cw_array* weights, cw_error** error) {
  return call(error, [&]() -> Status {
    if (Status given = all_given({{options, "the options"}, {weights, "the density"}}); !given) {
      return given;
    }
    Result<std::vector<double>> numbers = numbers_of(*weights, "the density");
    if (!numbers) {
      return numbers.error();
    }
    for (std::size_t v = 0; v < numbers->size(); ++v) {
      if (!(std::isfinite((*numbers)[v]) && (*numbers)[v] >= 0)) {
        return Error{ErrorCode::malformed,
                     "the density: the weight of vertex " + std::to_string(v) +
                         " is negative or not finite; give numbers from 0 on"};
      }
    }
    Result<std::vector<double>> density = density_of_weights(std::move(*numbers));
    if (!density) {
      return density.error();
    }
    options->density = std::move(*density);
    return success();
  });
}

cw_code cw_options_set_start(cw_options* options, const cw_mesh_view* cage, cw_error** error) {
  return call(error, [&]() -> Status {
    if (Status given = all_given({{options, "the options"}}); !given) {
      return given;
    }
    const Result<MeshArgument> mesh = MeshArgument::of(cage, "the cage to start from");
    if (!mesh) {
      return mesh.error();
    }
    options->start = mesh->polygons();
    return success();
  });
}

cw_code cw_options_describe(char** out, cw_error** error) {
  return call_for(out, error, [&] { return describe_options(out); });
}

void cw_cage_free(cw_cage* cage) {
  delete cage;
}

const cw_mesh* cw_cage_mesh(const cw_cage* cage) {
  return cage != nullptr ? &cage->mesh : nullptr;
}

const char* cw_cage_report(const cw_cage* cage) {
  return cage != nullptr ? cage->report.c_str() : "";
}

int cw_cage_is_as_asked(const cw_cage* cage) {
  return cage != nullptr && cage->is_as_asked ? 1 : 0;
}

cw_code cw_generate(const cw_mesh_view* model, const cw_options* options, const cw_control* control,
                    cw_cage** out, cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) {
    return make_cage(model, options, progress, out);
  });
}

void cw_verdict_free(cw_verdict* verdict) {
  delete verdict;
}

int cw_verdict_is_valid(const cw_verdict* verdict) {
  return verdict != nullptr && verdict->is_valid ? 1 : 0;
}

const char* cw_verdict_report(const cw_verdict* verdict) {
  return verdict != nullptr ? verdict->report.c_str() : "";
}

cw_code cw_check(const cw_mesh_view* model, const cw_mesh_view* cage, int flags, size_t max_listed,
                 const cw_control* control, cw_verdict** out, cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) -> Status {
    const Result<ModelAndCage> meshes = ModelAndCage::of(model, cage);
    if (!meshes) {
      return meshes.error();
    }
    const ValidateOptions options{.allow_pieces = (flags & CW_CHECK_PIECES) != 0,
                                  .allow_inner_shells = (flags & CW_CHECK_INNER_SHELLS) != 0,
                                  .weld = true,
                                  .max_listed = max_listed};
    const MeshArgument& mesh = meshes->model;
    const PolygonMesh around = meshes->cage.polygons();
    return (flags & CW_CHECK_IGNORE_SPECKS) != 0
               ? judge_without_specks(mesh, around, options, progress, out)
               : judge_whole(mesh, around, options, progress, out);
  });
}

cw_code cw_compare(const cw_mesh_view* model, const cw_mesh_view* cages, const char* const* names,
                   size_t count, int poses, const cw_control* control, char** out,
                   cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) -> Status {
    if (count > 0) {
      if (Status given = all_given({{cages, "the list of cages"}}); !given) {
        return given;
      }
    }
    const Result<MeshArgument> mesh = MeshArgument::of(model, "the model");
    return mesh ? compare(*mesh, cages, names, count, poses != 0, progress, out)
                : Status(mesh.error());
  });
}

cw_code cw_info(const cw_mesh_view* model, int resolution, const cw_control* control, char** out,
                cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) -> Status {
    const Result<MeshArgument> mesh = MeshArgument::of(model, "the model");
    if (!mesh) {
      return mesh.error();
    }
    VoxelizeOptions voxels;
    constexpr int least = 2;
    constexpr int most = 4096;
    if (resolution != 0) {
      voxels.resolution = resolution;
    }
    if (voxels.resolution < least || voxels.resolution > most) {
      return Error{ErrorCode::invalid_option,
                   "resolution: " + std::to_string(resolution) + " is not from 2 to 4096"};
    }
    const Result<ModelInfo> info = describe_model(mesh->polygons(), voxels, progress);
    if (!info) {
      return info.error();
    }
    *out = handed_out(text_of(json_of(*info), 1));
    return success();
  });
}
