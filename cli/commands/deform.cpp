#include "binding.h"
#include "json.h"
#include "load.h"
#include "movement.h"
#include "session.h"

#include "deform/apply.h"
#include "io/atomic_file.h"
#include "io/source.h"
#include "report/following.h"
#include <cagewright/deform/following.h>
#include <cagewright/deform/match_pose.h>
#include <cagewright/deform/normals.h>
#include <cagewright/deform/stream.h>
#include <cagewright/deform/weights_file.h>
#include <cagewright/deform/write_movement.h>
#include <cagewright/io/model_file.h>
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  BindingOptions binding;
  std::vector<std::string> poses;
  std::string output;
  std::string weights;
  std::string json;
  FrameTimes times;
};

struct Pose {
  std::string path;
  std::string output;
};

/// Names with * or ? that the shell has left alone, for example because they were quoted; what
/// matches one is in the order of its numbers.
Result<std::vector<std::string>> expand(const std::vector<std::string>& names) {
  std::vector<std::string> paths;
  for (const std::string& name : names) {
    glob_t found{};
    if (name.find_first_of("*?[") == std::string::npos || fs::exists(name)) {
      paths.push_back(name);
    } else if (glob(name.c_str(), 0, nullptr, &found) == 0) {
      std::vector<std::string> matching(found.gl_pathv, found.gl_pathv + found.gl_pathc);
      std::ranges::sort(matching, comes_before);
      paths.insert(paths.end(), matching.begin(), matching.end());
    } else {
      return Error{ErrorCode::cannot_open, name + ": no file has such a name"};
    }
    globfree(&found);
  }
  return paths;
}

/// Where each pose goes: OUT itself for a single one, and for all where it holds a movement; else
/// OUT is a folder, or a name in which * stands for the name of the pose.
Result<std::vector<Pose>> plan_outputs(const Options& options, std::vector<std::string> paths) {
  std::vector<Pose> poses;
  if (is_one_movement(options.output, paths.size())) {
    in_order_of_frames(paths);
    for (const std::string& path : paths) {
      poses.push_back({path, options.output});
    }
    return poses;
  }
  const std::string extension = fs::path(options.binding.model).extension().string();
  const std::size_t star = options.output.find('*');
  const bool is_folder = fs::is_directory(options.output) || options.output.ends_with('/');
  if (paths.size() > 1 && star == std::string::npos && !is_folder) {
    return Error{ErrorCode::invalid_option,
                 fmt::format("--output: {} is one file, but there are {} deformed cages; give a "
                             "folder, a name with * for the name of the cage, or a file that holds "
                             "a movement (.pc2, .mdd, .glb)",
                             options.output, paths.size())};
  }
  std::set<std::string> taken;
  for (const std::string& path : paths) {
    const std::string stem = fs::path(path).stem().string();
    std::string output = options.output;
    if (is_folder) {
      output = (fs::path(output) / (stem + extension)).string();
    } else if (star != std::string::npos) {
      output.replace(star, 1, stem);
    }
    if (!taken.insert(output).second) {
      return Error{ErrorCode::invalid_option,
                   "--output: two deformed cages would both be written to " + output};
    }
    poses.push_back({path, output});
  }
  if (is_folder) {
    std::error_code error;
    fs::create_directories(options.output, error);
    if (error) {
      return cannot_write(options.output, error.value());
    }
  }
  return poses;
}

/// Whether all outputs can be written, and none over a file that is read.
Status can_write_all(const Options& options, const std::vector<Pose>& poses) {
  std::vector<std::string> inputs = {options.binding.model, options.binding.cage, options.weights,
                                     options.binding.coordinates.mix_weights};
  for (const Pose& pose : poses) {
    inputs.push_back(pose.path);
  }
  for (const Pose& pose : poses) {
    if (Status status = can_write_output(pose.output, inputs); !status) {
      return status;
    }
  }
  return success();
}

/// A deformed cage: it may stand in a file of its own, though the cage at rest was one of several
/// objects.
Result<PolygonMesh> load_posed(const std::string& path, const PolygonMesh& rest,
                               const ModelChoice& choice) {
  Result<PolygonMesh> whole = load_mesh(path, choice.pose);
  const bool is_cage = !whole || choice.cage_objects.empty() ||
                       (whole->positions.size() == rest.positions.size() &&
                        whole->face_count() == rest.face_count());
  return is_cage ? std::move(whole) : load_cage(path, choice);
}

Result<std::vector<std::vector<Vec3>>>
read_poses(const std::vector<Pose>& poses, const PolygonMesh& rest, const ModelChoice& choice) {
  std::vector<std::vector<Vec3>> positions;
  std::set<std::string> noted;
  for (const Pose& pose : poses) {
    Result<PolygonMesh> cage = load_posed(pose.path, rest, choice);
    if (!cage) {
      return cage.error();
    }
    Result<MatchedPose> matched = match_pose(rest, *cage, one_line(pose.path));
    if (!matched) {
      return matched.error();
    }
    if (!matched->note.empty() && noted.insert(matched->note).second) { // once for a sequence
      const FileNote note{"pose_matched", one_line(pose.path) + ": " + matched->note};
      tell({&note, 1});
    }
    positions.push_back(std::move(matched->positions));
  }
  return positions;
}

/// All positions of the model: the given ones of its bound part, the others at rest.
std::vector<Vec3> with_part(const ModelAndCage& meshes, std::span<const Vec3> moved) {
  std::vector<Vec3> positions = meshes.model().positions;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    positions[meshes.bound.vertices[i]] = moved[i];
  }
  return positions;
}

/// Vertices outside the chosen groups go back to rest.
void keep_others(std::span<const Vec3> rest, std::span<const Index> chosen,
                 std::vector<Vec3>& positions) {
  std::vector<Vec3> result(rest.begin(), rest.end());
  for (const Index v : chosen) {
    result[v] = positions[v];
  }
  positions = std::move(result);
}

/// Moves with the weights of a file.
Result<Mover> stored_mover(const Options& options, const ModelAndCage& meshes) {
  auto read = read_weights(options.weights);
  if (!read) {
    return read.error();
  }
  const auto stored = std::make_shared<StoredWeights>(*std::move(read));
  if (Status status = take_settings(options.binding.coordinates, *stored); !status) {
    return about_file(options.weights, status.error());
  }
  // Made for all of the model, or for the part that is chosen now too.
  const bool for_all = stored->weights.points() == meshes.model().positions.size();
  const std::vector<Vec3>& bound = for_all ? meshes.model().positions : meshes.bound.mesh.positions;
  if (Status status = belongs_to(*stored, bound, meshes.cage); !status) {
    return about_file(options.weights, status.error());
  }
  const auto rule = coordinate_rule(meshes.cage, stored->settings);
  if (!rule) {
    return about_file(options.binding.cage, rule.error());
  }
  return Mover(
      [stored, for_all, &bound, &meshes, rule = *rule](std::span<const std::vector<Vec3>> poses) {
        std::vector<std::vector<Vec3>> results;
        for (const std::vector<Vec3>& pose : poses) {
          std::vector<Vec3> moved = bound;
          move_to_pose(stored->weights, PosedColumns(*rule, pose), bound, moved);
          results.push_back(for_all ? std::move(moved) : with_part(meshes, moved));
        }
        return Result<std::vector<std::vector<Vec3>>>(std::move(results));
      });
}

/// Moves without stored weights.
Result<Mover> direct_mover(const Options& options, const ModelAndCage& meshes,
                           const Session& session) {
  const Result<CoordinateSettings> settings = chosen_settings(options.binding, meshes, session);
  if (!settings) {
    return settings.error();
  }
  const auto coordinates = make_coordinates(meshes, *settings, options.binding, session);
  if (!coordinates) {
    return coordinates.error();
  }
  const auto has_warned = std::make_shared<bool>(false); // the same points in every call
  return Mover(
      [coordinates = *coordinates, has_warned, &options, &meshes, &session](
          std::span<const std::vector<Vec3>> poses) -> Result<std::vector<std::vector<Vec3>>> {
        Result<StreamedPoses> streamed =
            deform_streaming(*coordinates, poses, meshes.bound.mesh.positions, session.progress());
        if (!streamed) {
          return streamed.error();
        }
        if (!std::exchange(*has_warned, true)) {
          warn_of_points(options.binding.cage, streamed->counts);
        }
        std::vector<std::vector<Vec3>> results;
        for (const std::vector<Vec3>& moved : streamed->positions) {
          results.push_back(with_part(meshes, moved));
        }
        return results;
      });
}

/// Either, with vertices that are not chosen left at rest.
Result<Mover> make_mover(const Options& options, const ModelAndCage& meshes,
                         const Session& session) {
  Result<Mover> mover = options.weights.empty() ? direct_mover(options, meshes, session)
                                                : stored_mover(options, meshes);
  if (!mover) {
    return mover.error();
  }
  return Mover([move = *mover, &meshes](std::span<const std::vector<Vec3>> poses) {
    auto results = move(poses);
    if (results) {
      for (std::vector<Vec3>& positions : *results) {
        keep_others(meshes.model().positions, meshes.bound.vertices, positions);
      }
    }
    return results;
  });
}

std::string summary(std::span<const Vec3> rest, std::span<const Vec3> positions,
                    const std::string& output) {
  double farthest = 0;
  std::size_t moved = 0;
  for (std::size_t v = 0; v < rest.size(); ++v) {
    const double distance = (positions[v] - rest[v]).norm();
    farthest = std::max(farthest, distance);
    moved += distance > 0 ? 1U : 0U;
  }
  return fmt::format("{}: {} of {} vertices moved, by up to {:.3g} % of the diagonal\n", output,
                     moved, rest.size(), 100 * farthest / diagonal(rest));
}

/// The figures of one pose.
nlohmann::json figures_of(TriangleView rest, std::span<const Vec3> positions, const Pose& pose) {
  nlohmann::json json = json_of(deformed_figures(rest, positions));
  double farthest = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    farthest = std::max(farthest, (positions[v] - rest.positions[v]).norm());
  }
  json["deformed_cage"] = pose.path;
  json["output"] = pose.output;
  json["farthest_move"] = farthest;
  return json;
}

/// Once for each folder of a sequence.
void warn_of_links(const ModelFile& model, const std::vector<Pose>& poses) {
  std::set<fs::path> told;
  for (const Pose& pose : poses) {
    if (model.keeps_format(pose.output) &&
        told.insert(fs::path(pose.output).parent_path()).second) {
      cli::warn_of_links(model, pose.output);
    }
  }
}

/// Whether all formats can be written, asked before the work.
Status can_write_formats(const ModelFile& file, const std::vector<Pose>& poses) {
  for (const Pose& pose : poses) {
    const Status writable =
        file.keeps_format(pose.output) ? success() : can_write_model(pose.output);
    if (!writable) {
      return writable;
    }
  }
  return success();
}

/// What --json tells of the model in each pose, if it was asked for.
class PoseFigures {
public:
  PoseFigures(const Options& options, const PolygonMesh& rest, const std::vector<Pose>& poses)
      : options_(options), poses_(poses),
        triangles_(options.json.empty() ? TriangleMesh() : to_triangle_mesh(rest)) {}

  void add(std::size_t pose, std::span<const Vec3> positions) {
    if (!options_.json.empty()) {
      figures_.push_back(figures_of(triangles_, positions, poses_[pose]));
    }
  }

  Status write() const {
    return options_.json.empty() ? success()
                                 : write_json(options_.json, {{"format", "cagewright-deform"},
                                                              {"version", 1},
                                                              {"model", options_.binding.model},
                                                              {"cage", options_.binding.cage},
                                                              {"poses", figures_},
                                                              {"notes", notes_as_json()}});
  }

private:
  const Options& options_;
  const std::vector<Pose>& poses_;
  TriangleMesh triangles_;
  nlohmann::json figures_ = nlohmann::json::array();
};

/// Each pose of the model in a file of its own.
int write_models(const std::vector<Pose>& poses, const ModelAndCage& meshes,
                 const std::vector<std::vector<Vec3>>& cages, const Mover& move,
                 const FrameSeen& seen, const Session& session) {
  const ModelFile& file = meshes.file;
  const std::vector<Vec3>& rest = file.mesh().positions;
  const bool keeps_format =
      std::ranges::any_of(poses, [&](const Pose& pose) { return file.keeps_format(pose.output); });
  Result<FileNormals> stored_normals = file.normals();
  if (!stored_normals && !keeps_format) {
    stored_normals = FileNormals(); // broken ones are left out of other formats, and told
  }
  if (!stored_normals) {
    return fail(stored_normals.error());
  }
  const Result<std::vector<std::vector<Vec3>>> results = move(cages);
  if (!results) {
    return fail(results.error());
  }
  NormalField normals;
  if (!stored_normals->normals.empty()) {
    normals = NormalField(file.mesh(), {stored_normals->of_corner, stored_normals->normals.size(),
                                        stored_normals->normals});
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    normals.update((*results)[i]);
    const Result<std::vector<FileNote>> notes =
        file.write_moved((*results)[i], normals.normals(), poses[i].output);
    if (!notes) {
      return fail(notes.error());
    }
    if (i == 0) { // the others of a sequence lose the same
      tell(*notes);
    }
    seen(i, (*results)[i]);
    session.say(summary(rest, (*results)[i], poses[i].output));
  }
  warn_of_links(file, poses);
  return done;
}

/// All poses of the model in one file.
int write_frames(const Options& options, const ModelAndCage& meshes,
                 const std::vector<std::vector<Vec3>>& cages, const Mover& move,
                 const FrameSeen& seen, const Session& session) {
  const Result<std::vector<FileNote>> notes = write_movement(
      meshes.file, cages, move, options.times, options.output, session.progress(), seen);
  if (!notes) {
    return fail(notes.error());
  }
  tell(*notes);
  session.say(fmt::format("{}: {} frames of {} vertices\n", options.output, cages.size(),
                          meshes.model().positions.size()));
  return done;
}

int run(const Options& options, const Session& session) {
  const auto start = std::chrono::steady_clock::now();
  const Result<std::vector<std::string>> paths = expand(options.poses);
  if (!paths) {
    return fail(paths.error());
  }
  const Result<std::vector<Pose>> poses = plan_outputs(options, *paths);
  if (!poses) {
    return fail(poses.error());
  }
  if (const Status writable = can_write_all(options, *poses); !writable) {
    return fail(writable.error());
  }
  const Result<ModelAndCage> meshes = read_model_and_cage(options.binding);
  if (!meshes) {
    return fail(meshes.error());
  }
  const Result<std::vector<std::vector<Vec3>>> cages =
      read_poses(*poses, meshes->cage, options.binding.choice);
  if (!cages) {
    return fail(cages.error());
  }
  const bool is_movement = is_one_movement(options.output, poses->size());
  if (!is_movement) {
    if (const Status writable = can_write_formats(meshes->file, *poses); !writable) {
      return fail(writable.error());
    }
  }
  // With weights from a file the cage was judged when they were made.
  if (options.weights.empty() || options.binding.strict) {
    if (Status status = judge(*meshes, options.binding, session); !status) {
      return fail_of_judge(status.error());
    }
  }
  const Result<Mover> move = make_mover(options, *meshes, session);
  if (!move) {
    return fail(move.error());
  }
  PoseFigures figures(options, meshes->file.mesh(), *poses);
  const FrameSeen seen = [&](std::size_t frame, std::span<const Vec3> positions) {
    figures.add(frame, positions);
  };
  if (!is_movement) {
    if (const int exit_code = write_models(*poses, *meshes, *cages, *move, seen, session);
        exit_code != done) {
      return exit_code;
    }
  } else if (const int exit_code = write_frames(options, *meshes, *cages, *move, seen, session);
             exit_code != done) {
    return exit_code;
  }
  if (const Status written = figures.write(); !written) {
    return fail(written.error());
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  session.say(fmt::format("{:.2f} s in all\n", seconds.count()));
  return done;
}

} // namespace

void add_deform(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand("deform", "Move a model as its cage has moved");
  command->alias("sequence"); // what people look for who have many poses
  auto options = std::make_shared<Options>();
  add_binding_options(*command, options->binding);
  command
      ->add_option("deformed-cage", options->poses,
                   "The cage with its vertices moved; several, or a quoted pattern such as "
                   "'frame_*.obj', for a sequence: in the order of its numbers")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "The model to write, with all that the original holds. For a sequence a folder, "
                   "or a name with * for the name of the deformed cage; or one file that holds the "
                   "movement: a point cache (.pc2, .mdd) or an animated .glb")
      ->required();
  command->add_option("--weights", options->weights, "Use the weights that bind has stored");
  command->add_option("--json", options->json,
                      "Write to this file as JSON what became of the model in each pose: stretch, "
                      "change of volume, triangles that were flipped or have come to touch others");
  add_time_options(*command, options->times);
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
