#include "json.h"
#include "load.h"
#include "model_choice.h"
#include "report/cage_figures.h"
#include "report/cage_words.h"
#include "report/verdict.h"
#include "session.h"

#include "io/source.h"
#include <cagewright/cage/specks.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace cagewright::cli {
namespace {

struct Options {
  JudgedFiles files;
  std::string json;
  ValidateOptions validate;
  ModelChoice choice;
};

std::string report_text(const ValidityReport& report, const JudgedFiles& files) {
  std::string text =
      "not valid (vertices and faces are counted from 0, in the order of the files)\n";
  std::size_t next = 0;
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    const auto kind = static_cast<ViolationKind>(k);
    if (report.counts[k] == 0) {
      continue;
    }
    text += fmt::format("  {}{}\n", headline(kind, report.counts[k]),
                        kind == ViolationKind::vertex_outside && report.containment_approximate
                            ? " (the cage is not closed: by its winding number, approximately)"
                            : "");
    std::size_t listed = 0;
    for (; next < report.violations.size() && report.violations[next].kind == kind; ++next) {
      const std::string violation = describe(report.violations[next]);
      text += violation.empty() ? "" : "    " + violation + "\n";
      ++listed;
    }
    if (listed < report.counts[k] && kind != ViolationKind::no_faces) {
      text +=
          fmt::format("    ... and {} more (--list all shows them)\n", report.counts[k] - listed);
    }
    text += fmt::format("    remedy: {}\n", remedy(kind, files));
  }
  return text;
}

int run(const Options& options, const Session& session) {
  const Result<ModelAndCage> meshes =
      load_model_and_cage(options.files.model, options.files.cage, options.choice);
  if (!meshes) {
    return fail(meshes.error());
  }
  const PolygonMesh* const model = &meshes->bound.mesh;
  const PolygonMesh* const cage = &meshes->cage;
  const Triangulation triangles = triangulate(*model);
  const TriangleView view{model->positions, triangles.triangles};
  const Triangulation cuttings = every_cutting(*model);
  auto report = validate_cage(*cage, {model->positions, cuttings.triangles}, options.validate,
                              session.progress());
  if (!report) {
    return fail(report.error());
  }
  name_model_faces(*report, cuttings.face_of);
  std::vector<FileNote> notes = hints(*report, *cage, view, options.files);
  if (report->count(ViolationKind::vertex_outside) > 0 && !options.choice.ignore_specks) {
    const Result<Specks> specks = find_specks(view, session.progress());
    if (specks && specks->count > 0) {
      notes.push_back(
          {"specks", fmt::format("{}: {} far from the rest of the model; judge the cage "
                                 "without with: cagewright check {} {} --ignore-specks",
                                 one_line(options.files.model),
                                 specks->count == 1 ? "a tiny piece lies" : "some tiny pieces lie",
                                 options.files.model, options.files.cage)});
    }
  }
  const CageMetrics metrics = measure_cage(report->merged_vertices > 0 ? weld(*cage) : *cage, view);
  if (!options.json.empty()) {
    nlohmann::json json = json_of(*report, options.files);
    json["cage"] = figures_as_json(metrics);
    json["notes"] = notes_as_json();
    for (const FileNote& note : notes) {
      json["notes"].push_back({{"code", note.code}, {"message", note.message}});
    }
    if (const Status status = write_json(options.json, json, 2); !status) {
      return fail(status.error());
    }
  }
  std::string text =
      report->valid() ? "valid\n" + figures_as_text(metrics) : report_text(*report, options.files);
  for (const FileNote& note : notes) {
    text += "note: " + note.message + "\n";
  }
  session.say(text);
  return report->valid() ? done : found_faults;
}

/// A number, or "all".
std::string parse_count(const std::string& text, std::size_t& count) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (text == "all") {
    count = std::numeric_limits<std::size_t>::max();
  } else if (error != std::errc() || end != text.data() + text.size()) {
    return text + " is no count; give a number, or all";
  }
  return {};
}

} // namespace

void add_check(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Judge a cage: valid, or what is wrong with it and where. Exit code 0 only if valid");
  auto options = std::make_shared<Options>();
  options->validate.weld = true;
  command->add_option("model", options->files.model, "The model that the cage is for")->required();
  command->add_option("cage", options->files.cage, "The cage to judge")->required();
  add_pose_option(*command, options->choice);
  add_only_option(*command, options->choice,
                  "The cage is for this object or group of the model; its vertices and faces are "
                  "counted on their own");
  add_specks_option(*command, options->choice, "Judge the cage for the model");
  add_cage_object_option(*command, options->choice);
  command->add_option("--json", options->json, "Write the verdict to this file as JSON");
  command->add_flag("--allow-pieces", options->validate.allow_pieces,
                    "Accept a cage of several closed pieces");
  command->add_flag("--allow-inner-shells", options->validate.allow_inner_shells,
                    "Accept closed pieces within others, oriented inward, as some use to steer an "
                    "eye; what they enclose counts as inside");
  command
      ->add_option_function<std::string>(
          "--list,--max-listed",
          [options](const std::string& text) {
            const std::string wrong = parse_count(text, options->validate.max_listed);
            if (!wrong.empty()) {
              throw CLI::ValidationError("--list", wrong);
            }
          },
          "Violations of each kind to list, or all; all are counted")
      ->option_text("N|all=20");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
