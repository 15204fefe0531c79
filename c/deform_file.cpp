#include "deform_file.h"

#include "io/source.h"
#include "report/cage_words.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/match_pose.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/stream.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <string>
#include <system_error>
#include <utility>

namespace cagewright::c {
namespace {

namespace fs = std::filesystem;

Status is_no_input(const DeformedFiles& files) {
  for (const fs::path& input : {files.model, files.cage, files.posed}) {
    std::error_code none; // a file that is not there yet is no input
    if (fs::equivalent(files.out, input, none)) {
      return Error{ErrorCode::cannot_write,
                   one_line(files.out.string()) +
                       ": this file is read and would be written over; give the output another "
                       "name"};
    }
  }
  return success();
}

void add(std::vector<FileNote>& notes, std::span<const FileNote> more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

/// What is wrong with the cage for this model: it is told, and no reason to stop.
Result<std::vector<FileNote>> judge(const DeformedFiles& files, const PolygonMesh& model,
                                    const PolygonMesh& cage, const Progress& progress) {
  const TriangleMesh triangles = to_triangle_mesh(model);
  const Result<ValidityReport> report = validate_cage(
      cage, triangles,
      {.allow_pieces = true, .allow_inner_shells = true, .weld = true, .max_listed = 0}, progress);
  if (!report) {
    return report.error();
  }
  const JudgedFiles names{files.model.string(), files.cage.string()};
  std::vector<FileNote> notes;
  for (const FileNote& note : hints(*report, cage, triangles, names)) {
    if (note.code != "loose_model_vertices") { // they move along: nothing to warn of
      notes.push_back(note);
    }
  }
  if (!report->valid()) {
    notes.push_back({"cage_not_valid", not_valid_in_words(*report, names)});
  }
  return notes;
}

/// The model's own normals, following its surface.
Result<std::vector<Vec3>> turned_normals(const ModelFile& model, std::span<const Vec3> positions) {
  Result<FileNormals> stored = model.normals();
  if (!stored) {
    return stored.error();
  }
  if (stored->normals.empty()) {
    return std::vector<Vec3>();
  }
  const std::size_t count = stored->normals.size();
  NormalField field(model.mesh(), {stored->of_corner, count, std::move(stored->normals)});
  field.update(positions);
  return std::vector<Vec3>(field.normals().begin(), field.normals().end());
}

} // namespace

Result<std::vector<FileNote>> deform_file(const DeformedFiles& files, const Progress& progress) {
  if (const Status fine = is_no_input(files); !fine) {
    return fine.error();
  }
  std::vector<FileNote> notes;
  const Result<ModelFile> model = ModelFile::open(files.model);
  if (!model) {
    return model.error();
  }
  const Result<ModelFile> cage = ModelFile::open(files.cage);
  if (!cage) {
    return cage.error();
  }
  const Result<ModelFile> posed = ModelFile::open(files.posed);
  if (!posed) {
    return posed.error();
  }
  for (const ModelFile* const file : {&*model, &*cage, &*posed}) {
    add(notes, file->notes());
  }
  const PolygonMesh& rest = cage->mesh();
  const std::string posed_name = one_line(files.posed.string());
  const Result<MatchedPose> pose = match_pose(rest, posed->mesh(), posed_name);
  if (!pose) {
    return pose.error();
  }
  if (!pose->note.empty()) {
    notes.push_back({"pose_matched", posed_name + ": " + pose->note});
  }
  const auto judged = judge(files, model->mesh(), rest, progress.part(0, 0.3));
  if (!judged) {
    return judged.error();
  }
  add(notes, *judged);
  CoordinateSettings settings;
  settings.allow_open = true;
  const auto coordinates = prepare_coordinates(rest, settings, progress.part(0.3, 0.4));
  if (!coordinates) {
    return Error{coordinates.error().code,
                 files.cage.string() + ": " + coordinates.error().message};
  }
  const std::vector<std::vector<Vec3>> poses = {pose->positions};
  const Result<StreamedPoses> moved =
      deform_streaming(**coordinates, poses, model->mesh().positions, progress.part(0.4, 0.95));
  if (!moved) {
    return moved.error();
  }
  if (moved->counts.undefined > 0) {
    notes.push_back({"without_weights", files.cage.string() + ": " +
                                            counted(moved->counts.undefined, "model vertex") +
                                            " without weights: left at rest"});
  }
  const std::vector<Vec3>& positions = moved->positions.front();
  const Result<std::vector<Vec3>> normals = turned_normals(*model, positions);
  if (!normals) {
    return normals.error();
  }
  const Result<std::vector<FileNote>> written = model->write_moved(positions, *normals, files.out);
  if (!written) {
    return written.error();
  }
  add(notes, *written);
  return notes;
}

} // namespace cagewright::c
