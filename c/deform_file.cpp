#include "deform_file.h"

#include "io/source.h"
#include "report/cage_words.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/match_pose.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/write_movement.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>

namespace cagewright::c {
namespace {

namespace fs = std::filesystem;

Status is_no_input(const DeformedFiles& files, const fs::path& out) {
  std::vector<fs::path> inputs = files.posed;
  inputs.insert(inputs.end(), {files.model, files.cage});
  for (const fs::path& input : inputs) {
    std::error_code none; // a file that is not there yet is no input
    if (fs::equivalent(out, input, none)) {
      return Error{ErrorCode::cannot_write,
                   one_line(out.string()) +
                       ": this file is read and would be written over; give the output another "
                       "name"};
    }
  }
  return success();
}

/// Whether so many poses go into these files.
Status are_outputs(const DeformedFiles& files, std::size_t poses) {
  if (poses == 0) {
    return Error{ErrorCode::mismatch, "there is no pose of the cage"};
  }
  if (files.outs.size() != poses && files.outs.size() != 1) {
    return Error{ErrorCode::mismatch, counted(poses, "pose") + ", but " +
                                          counted(files.outs.size(), "file") +
                                          " to write; give one for each, or one that holds the "
                                          "movement (.pc2, .mdd, .glb)"};
  }
  if (files.outs.size() < poses && !holds_movement(files.outs.front(), poses)) {
    return Error{ErrorCode::unsupported, one_line(files.outs.front().string()) +
                                             ": such a file holds one pose; give a file that holds "
                                             "a movement (.pc2, .mdd, .glb), or a file for each"};
  }
  std::set<fs::path> taken;
  for (const fs::path& out : files.outs) {
    if (!taken.insert(out).second) {
      return Error{ErrorCode::mismatch,
                   one_line(out.string()) + ": two poses would be written to this file"};
    }
    if (Status fine = is_no_input(files, out); !fine) {
      return fine;
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
  const Triangulation cuttings = every_cutting(model);
  const TriangleView triangles{model.positions, cuttings.triangles};
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

/// All poses, each with the vertices of the cage in the order of its rest.
Result<std::vector<std::vector<Vec3>>> poses_of(const DeformedFiles& files, const PolygonMesh& rest,
                                                std::vector<FileNote>& notes) {
  for (std::size_t i = 0; i < files.positions.size(); ++i) {
    if (files.positions[i].size() != rest.positions.size()) {
      return Error{ErrorCode::mismatch, "pose " + std::to_string(i) + " has " +
                                            counted(files.positions[i].size(), "vertex") +
                                            ", but the cage " +
                                            std::to_string(rest.positions.size())};
    }
  }
  std::vector<std::vector<Vec3>> poses = files.positions;
  std::set<std::string> told; // once for a sequence
  for (const fs::path& path : files.posed) {
    const Result<ModelFile> file = ModelFile::open(path);
    if (!file) {
      return file.error();
    }
    add(notes, file->notes());
    const std::string name = one_line(path.string());
    Result<MatchedPose> pose = match_pose(rest, file->mesh(), name);
    if (!pose) {
      return pose.error();
    }
    if (!pose->note.empty() && told.insert(pose->note).second) {
      notes.push_back({"pose_matched", name + ": " + pose->note});
    }
    poses.push_back(std::move(pose->positions));
  }
  return poses;
}

/// A file for each pose: the model's own normals follow its surface.
Status write_each(const ModelFile& model, const std::vector<std::vector<Vec3>>& moved,
                  const std::vector<fs::path>& outs, std::vector<FileNote>& notes) {
  Result<FileNormals> stored = model.normals();
  if (!stored &&
      std::ranges::none_of(outs, [&](const fs::path& out) { return model.keeps_format(out); })) {
    stored = FileNormals(); // broken ones are left out of other formats, and told
  }
  if (!stored) {
    return stored.error();
  }
  NormalField field;
  if (!stored->normals.empty()) {
    const std::size_t count = stored->normals.size();
    field = NormalField(model.mesh(), {stored->of_corner, count, std::move(stored->normals)});
  }
  for (std::size_t i = 0; i < outs.size(); ++i) {
    field.update(moved[i]);
    const Result<std::vector<FileNote>> written =
        model.write_moved(moved[i], field.normals(), outs[i]);
    if (!written) {
      return written.error();
    }
    if (i == 0) { // the others lose the same
      add(notes, *written);
    }
  }
  return success();
}

} // namespace

Result<std::vector<FileNote>> deform_files(const DeformedFiles& files, const Progress& progress) {
  const std::size_t count = files.posed.size() + files.positions.size();
  if (const Status fine = are_outputs(files, count); !fine) {
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
  add(notes, model->notes());
  add(notes, cage->notes());
  const PolygonMesh& rest = cage->mesh();
  const Result<std::vector<std::vector<Vec3>>> poses = poses_of(files, rest, notes);
  if (!poses) {
    return poses.error();
  }
  const auto judged = judge(files, model->mesh(), rest, progress.part(0, 0.3));
  if (!judged) {
    return judged.error();
  }
  add(notes, *judged);
  CoordinateSettings settings = files.coordinates;
  settings.allow_open = true;
  const auto coordinates = prepare_coordinates(rest, settings, progress.part(0.3, 0.4));
  if (!coordinates) {
    return Error{coordinates.error().code,
                 files.cage.string() + ": " + coordinates.error().message};
  }
  PointCounts points;
  const Mover move = [&](std::span<const std::vector<Vec3>> some) {
    // (Of a long sequence each part computes weights anew: it is told once how far the first is.)
    Result<StreamedPoses> streamed =
        deform_streaming(**coordinates, some, model->mesh().positions, progress.part(0.4, 0.9));
    if (streamed) {
      points = streamed->counts;
    }
    return streamed ? Result<std::vector<std::vector<Vec3>>>(std::move(streamed->positions))
                    : streamed.error();
  };
  if (holds_movement(files.outs.front(), count) && files.outs.size() == 1) {
    const Result<std::vector<FileNote>> written = write_movement(
        *model, *poses, move, files.times, files.outs.front(), progress.part(0.9, 1));
    if (!written) {
      return written.error();
    }
    add(notes, *written);
  } else {
    const Result<std::vector<std::vector<Vec3>>> moved = move(*poses);
    if (!moved) {
      return moved.error();
    }
    if (const Status written = write_each(*model, *moved, files.outs, notes); !written) {
      return written.error();
    }
  }
  if (points.undefined > 0) {
    notes.push_back({"without_weights", files.cage.string() + ": " +
                                            counted(points.undefined, "model vertex") +
                                            " without weights: left at rest"});
  }
  return notes;
}

} // namespace cagewright::c
