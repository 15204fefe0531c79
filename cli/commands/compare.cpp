#include "coordinate_options.h"
#include "joints.h"
#include "json.h"
#include "load.h"
#include "model_choice.h"
#include "report/compared_cage.h"
#include "session.h"

#include <cagewright/deform/choose_coordinates.h>
#include <cagewright/deform/standard_poses.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/model_volume.h>
#include <cagewright/validate/validate_cage.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

struct Options {
  std::string model;
  std::vector<std::string> cages;
  std::string json;
  bool no_poses = false;
  CoordinateArguments coordinates;
  std::string joints;
  ModelChoice choice;
};

const char* first_violation(const ValidityReport& report) {
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (report.counts[k] > 0) {
      return name_of(static_cast<ViolationKind>(k)).data();
    }
  }
  return "";
}

/// The rows of the table: what it is, and how it reads for a cage.
struct Row {
  std::string title;
  std::string (*cell)(const ComparedCage& cage);
};

std::string percent(double fraction) {
  return fmt::format("{:.3f}", 100 * fraction);
}

std::string pose_cell(const ComparedCage& cage, StandardPose pose, double PoseError::*which) {
  return cage.poses ? percent(cage.poses->of[static_cast<std::size_t>(pose)].*which) : "-";
}

std::string bend_cell(const ComparedCage& cage, double LimbBendError::*which) {
  return cage.bends.empty() ? "-" : percent(summed(cage.bends).*which);
}

const std::vector<Row>& rows() {
  static const std::vector<Row> table = {
      {"valid",
       [](const ComparedCage& c) -> std::string { return c.validity.valid() ? "yes" : "NO"; }},
      {"vertices", [](const ComparedCage& c) { return fmt::format("{}", c.metrics.vertices); }},
      {"faces", [](const ComparedCage& c) { return fmt::format("{}", c.faces); }},
      {"quads", [](const ComparedCage& c) { return fmt::format("{}", c.quads); }},
      {"volume ratio",
       [](const ComparedCage& c) {
         return c.metrics.volume_ratio != 0 ? fmt::format("{:.3f}", c.metrics.volume_ratio) : "-";
       }},
      {"least gap %", [](const ComparedCage& c) { return percent(c.metrics.clearance); }},
      {"mean gap %", [](const ComparedCage& c) { return percent(c.metrics.mean_distance); }},
      {"greatest gap %", [](const ComparedCage& c) { return percent(c.metrics.max_distance); }},
      {"webbing %",
       [](const ComparedCage& c) { return fmt::format("{:.1f}", 100 * c.metrics.webbing); }},
      {"2r/R least",
       [](const ComparedCage& c) { return fmt::format("{:.3f}", c.metrics.min_quality); }},
      {"2r/R 5th percentile",
       [](const ComparedCage& c) { return fmt::format("{:.3f}", c.metrics.low_quality); }},
      {"valence, greatest",
       [](const ComparedCage& c) { return fmt::format("{}", c.metrics.max_valence); }},
      {"bend: mean error %",
       [](const ComparedCage& c) { return pose_cell(c, StandardPose::bend, &PoseError::mean); }},
      {"bend: greatest %",
       [](const ComparedCage& c) { return pose_cell(c, StandardPose::bend, &PoseError::max); }},
      {"twist: mean error %",
       [](const ComparedCage& c) { return pose_cell(c, StandardPose::twist, &PoseError::mean); }},
      {"twist: greatest %",
       [](const ComparedCage& c) { return pose_cell(c, StandardPose::twist, &PoseError::max); }},
      {"bend, twist: in contact",
       [](const ComparedCage& c) -> std::string {
         return c.poses ? fmt::format("{}, {}", c.posed[0].in_contact, c.posed[1].in_contact) : "-";
       }},
      {"limbs bent: mean error %",
       [](const ComparedCage& c) { return bend_cell(c, &LimbBendError::mean); }},
      {"limbs bent: greatest %",
       [](const ComparedCage& c) { return bend_cell(c, &LimbBendError::max); }},
      {"limbs bent: drag of the rest %",
       [](const ComparedCage& c) { return bend_cell(c, &LimbBendError::drag); }},
      {"limbs bent: leave the cage %",
       [](const ComparedCage& c) { return bend_cell(c, &LimbBendError::left); }},
      {"limbs bent: of 45 degrees",
       [](const ComparedCage& c) -> std::string {
         return c.bends.empty() ? "-" : fmt::format("{:.1f}", summed(c.bends).reached);
       }},
      {"pull of unseen vertices %",
       [](const ComparedCage& c) -> std::string {
         return c.poses ? fmt::format("{:.2f}", 100 * c.unseen.mean) : "-";
       }},
  };
  return table;
}

/// \param is_auto  each cage has coordinates of its own
/// \param limbs    that were bent; null: none
std::string as_text(const std::vector<ComparedCage>& cages, bool is_auto,
                    const BendableLimbs* limbs) {
  std::vector<Row> table = rows();
  if (is_auto) {
    table.push_back({"coordinates", [](const ComparedCage& c) -> std::string {
                       return c.coordinates.empty() ? "-" : c.coordinates;
                     }});
  }
  std::size_t left = 0;
  for (const Row& row : table) {
    left = std::max(left, row.title.size());
  }
  std::vector<std::size_t> widths;
  std::string text(left, ' ');
  for (const ComparedCage& cage : cages) {
    const std::string name = std::filesystem::path(cage.name).filename().string();
    widths.push_back(std::max<std::size_t>(9, name.size()));
    for (const Row& row : table) {
      widths.back() = std::max(widths.back(), row.cell(cage).size());
    }
    text += fmt::format("  {:>{}}", name, widths.back());
  }
  text += "\n";
  for (const Row& row : table) {
    text += fmt::format("{:<{}}", row.title, left);
    for (std::size_t i = 0; i < cages.size(); ++i) {
      text += fmt::format("  {:>{}}", row.cell(cages[i]), widths[i]);
    }
    text += "\n";
  }
  for (const ComparedCage& cage : cages) {
    if (!cage.validity.valid()) {
      text +=
          fmt::format("{}: not a valid cage of this model ({}); 'cagewright check' says where\n",
                      cage.name, first_violation(cage.validity));
    }
  }
  text += limbs == nullptr ? ""
                           : fmt::format("limbs bent by 45 degrees, in four directions each: {}\n",
                                         limbs->count());
  return text + "Gaps and errors are in % of the model's diagonal.\n";
}

/// With --coordinates auto those that carry the model best in this cage; none if it cannot.
/// Errors: cancelled.
Result<std::optional<CoordinateSettings>>
settings_for(const Options& options, const CoordinateSettings& given, const PolygonMesh& cage,
             const TriangleMesh& model, const Progress& progress) {
  if (options.no_poses || options.coordinates.kind != best_kind) {
    return options.no_poses ? std::nullopt : std::optional(given);
  }
  Result<ChosenCoordinates> chosen = choose_coordinates(cage, model.positions, progress);
  if (chosen) {
    return std::optional(std::move(chosen->settings));
  }
  if (chosen.error().code == ErrorCode::cancelled) {
    return chosen.error();
  }
  return std::optional<CoordinateSettings>();
}

int run(const Options& options, const Session& session) {
  const bool is_auto = options.coordinates.kind == best_kind;
  const Result<CoordinateSettings> settings =
      is_auto ? CoordinateSettings() : settings_of(options.coordinates);
  if (!settings) {
    return fail(settings.error());
  }
  const Result<PolygonMesh> mesh = load_chosen(options.model, options.choice);
  if (!mesh) {
    return fail(mesh.error());
  }
  const TriangleMesh model = to_triangle_mesh(*mesh);
  const ModelVolume volume = model_volume(model);
  const Progress progress = session.progress();
  const Result<std::vector<LimbJoint>> joints = limb_joints(options.joints, options.choice.pose);
  if (!joints) {
    return fail(joints.error());
  }
  std::optional<BendableLimbs> limbs;
  if (!options.no_poses) {
    Result<BendableLimbs> found = BendableLimbs::of(model, *joints, progress.quiet());
    if (found) { // else the model has no extent, and no limbs
      limbs = std::move(*found);
    } else if (found.error().code == ErrorCode::cancelled) {
      return fail(found.error());
    }
  }
  const BendableLimbs* const bent = limbs && limbs->count() > 0 ? &*limbs : nullptr;
  std::vector<ComparedCage> cages;
  const auto count = static_cast<double>(options.cages.size());
  for (std::size_t i = 0; i < options.cages.size(); ++i) {
    const Result<PolygonMesh> cage = load_mesh(options.cages[i]);
    if (!cage) {
      return fail(cage.error());
    }
    const Progress share =
        progress.part(static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
    const auto own = settings_for(options, *settings, *cage, model, share.part(0, 0.5));
    if (!own) {
      return fail(own.error());
    }
    Result<ComparedCage> compared =
        compare_cage(options.cages[i], *cage, model, volume, *own ? &**own : nullptr, bent,
                     is_auto ? share.part(0.5, 1) : share);
    if (!compared) {
      return fail(compared.error());
    }
    cages.push_back(std::move(*compared));
  }
  progress(1, "done");
  if (!options.json.empty()) {
    nlohmann::json json = {
        {"format", "cagewright-compare"}, {"version", 1},
        {"model", options.model},         {"coordinates", options.coordinates.kind},
        {"notes", notes_as_json()},       {"cages", nlohmann::json::array()}};
    for (const ComparedCage& cage : cages) {
      json["cages"].push_back(json_of(cage, bent));
    }
    if (const Status written = write_json(options.json, json); !written) {
      return fail(written.error());
    }
  }
  session.say(as_text(cages, is_auto && !options.no_poses, bent));
  return done;
}

} // namespace

void add_compare(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "compare",
      "Figures of several cages of a model side by side, valid or not, and how well "
      "the model follows each through a standard bend and twist, and a bend of each limb");
  auto options = std::make_shared<Options>();
  command->add_option("model", options->model, "The model that the cages are for")->required();
  command->add_option("cages", options->cages, "The cages")->required();
  add_pose_option(*command, options->choice);
  add_only_option(*command, options->choice, "The cages are for this object or group of the model");
  add_specks_option(*command, options->choice, "Compare the cages for the model");
  add_coordinate_options(*command, options->coordinates, true);
  add_joints_option(*command, options->joints,
                    "Where limbs are bent, instead of where the shape says");
  command->add_option("--json", options->json, "Write the same and more to this file as JSON");
  command->add_flag("--no-poses", options->no_poses,
                    "Leave out the bends and the twist, which take longest on large models");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
