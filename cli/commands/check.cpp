#include "cage_figures.h"
#include "load.h"
#include "model_choice.h"
#include "session.h"

#include "io/atomic_file.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace cagewright::cli {
namespace {

struct Options {
  std::string model;
  std::string cage;
  std::string json;
  ValidateOptions validate;
  ModelChoice choice;
};

/// What the elements of a violation are, in words.
struct Wording {
  const char* title;  // after the count
  const char* first;  // before the first element
  const char* second; // before the second, if there is one
};

Wording wording_of(ViolationKind kind) {
  switch (kind) {
  case ViolationKind::no_faces:
    return {"the cage has no usable face", "", ""};
  case ViolationKind::bad_corner:
    return {"faces with fewer than three corners, or corners that are no vertices", "face", ""};
  case ViolationKind::not_finite:
    return {"cage vertices whose position is not a number", "vertex", ""};
  case ViolationKind::unused_vertex:
    return {"cage vertices that no face uses", "vertex", ""};
  case ViolationKind::coincident_vertices:
    return {"cage vertices on top of another", "vertices", "and"};
  case ViolationKind::degenerate_face:
    return {"degenerate cage faces", "face", ""};
  case ViolationKind::duplicate_face:
    return {"cage faces that repeat an earlier one", "face", ""};
  case ViolationKind::open_edge:
    return {"open edges", "edge", "-"};
  case ViolationKind::nonmanifold_edge:
    return {"edges of more than two faces", "edge", "-"};
  case ViolationKind::flipped_edge:
    return {"edges between faces of opposite orientation", "edge", "-"};
  case ViolationKind::nonmanifold_vertex:
    return {"vertices where the cage touches itself in a point", "vertex", ""};
  case ViolationKind::self_intersection:
    return {"pairs of cage faces that cross or touch", "faces", "and"};
  case ViolationKind::inverted_piece:
    return {"closed pieces oriented inward", "piece with face", ""};
  case ViolationKind::several_pieces:
    return {"pieces too many (--allow-pieces accepts them)", "piece with face", ""};
  case ViolationKind::nested_piece:
    return {"closed pieces within another", "piece with face", ""};
  case ViolationKind::vertex_outside:
    return {"model vertices outside the cage", "model vertex", ""};
  case ViolationKind::vertex_on_cage:
    return {"model vertices on the cage", "model vertex", "on cage face"};
  case ViolationKind::face_contact:
    return {"contacts of model faces and cage faces", "model face", "and cage face"};
  }
  return {"", "", ""}; // no default above: the compiler points here when a kind is added
}

std::string describe(const Violation& violation) {
  const Wording wording = wording_of(violation.kind);
  std::string text;
  if (violation.elements[0] != Violation::none) {
    text += fmt::format("    {} {}", wording.first, violation.elements[0]);
  }
  if (violation.elements[1] != Violation::none) {
    text += fmt::format(" {} {}", wording.second, violation.elements[1]);
  }
  if (!text.empty() && violation.kind != ViolationKind::bad_corner) {
    text += fmt::format("  at ({}, {}, {})", violation.place.x(), violation.place.y(),
                        violation.place.z());
  }
  return text.empty() ? text : text + "\n";
}

std::string describe(const ValidityReport& report) {
  std::string text =
      "not valid (vertices and faces are counted from 0, in the order of the files)\n";
  std::size_t next = 0;
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    const auto kind = static_cast<ViolationKind>(k);
    if (report.counts[k] == 0) {
      continue;
    }
    text += fmt::format("  {} {}{}\n", report.counts[k], wording_of(kind).title,
                        kind == ViolationKind::vertex_outside && report.containment_approximate
                            ? " (the cage is not closed: by its winding number, approximately)"
                            : "");
    std::size_t listed = 0;
    for (; next < report.violations.size() && report.violations[next].kind == kind; ++next) {
      text += describe(report.violations[next]);
      ++listed;
    }
    if (listed < report.counts[k] && kind != ViolationKind::no_faces) {
      text += fmt::format("    ... and {} more\n", report.counts[k] - listed);
    }
  }
  return text;
}

nlohmann::json to_json(const ValidityReport& report) {
  nlohmann::json json = {{"valid", report.valid()},
                         {"containment_approximate", report.containment_approximate},
                         {"counts", nlohmann::json::object()},
                         {"violations", nlohmann::json::array()}};
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    json["counts"][name_of(static_cast<ViolationKind>(k))] = report.counts[k];
  }
  for (const Violation& violation : report.violations) {
    nlohmann::json elements = nlohmann::json::array();
    for (const Index element : violation.elements) {
      if (element != Violation::none) {
        elements.push_back(element);
      }
    }
    const Vec3& at = violation.place;
    json["violations"].push_back({{"kind", name_of(violation.kind)},
                                  {"elements", elements},
                                  {"place", {at.x(), at.y(), at.z()}}});
  }
  return json;
}

/// Triangles of the model were judged; the user knows its faces.
void name_model_faces(ValidityReport& report, const Triangulation& model) {
  for (Violation& violation : report.violations) {
    if (violation.kind == ViolationKind::face_contact) {
      violation.elements[0] = model.face_of[violation.elements[0]];
    }
  }
}

int run(const Options& options, const Session& session) {
  const Result<ModelAndCage> meshes =
      load_model_and_cage(options.model, options.cage, options.choice);
  if (!meshes) {
    return fail(meshes.error());
  }
  const PolygonMesh* const model = &meshes->bound.mesh;
  const PolygonMesh* const cage = &meshes->cage;
  const Triangulation triangles = triangulate(*model);
  const TriangleView view{model->positions, triangles.triangles};
  auto report = validate_cage(*cage, view, options.validate, session.progress());
  if (!report) {
    return fail(report.error());
  }
  name_model_faces(*report, triangles);
  const CageMetrics metrics = measure_cage(*cage, view);
  if (!options.json.empty()) {
    nlohmann::json json = to_json(*report);
    json["cage"] = figures_as_json(metrics);
    json["notes"] = notes_as_json();
    if (const Status status = write_file_atomically(options.json, json.dump(2) + "\n"); !status) {
      return fail(status.error());
    }
  }
  if (!session.quiet) {
    const std::string text =
        report->valid() ? "valid\n" + figures_as_text(metrics) : describe(*report);
    std::fputs(text.c_str(), stdout);
  }
  return report->valid() ? done : could_not;
}

} // namespace

void add_check(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "check",
      "Judge a cage: valid, or what is wrong with it and where. Exit code 0 only if valid");
  auto options = std::make_shared<Options>();
  command->add_option("model", options->model, "The model that the cage is for")->required();
  command->add_option("cage", options->cage, "The cage to judge")->required();
  add_pose_option(*command, options->choice);
  add_only_option(*command, options->choice,
                  "The cage is for this object or group of the model; its vertices and faces are "
                  "counted on their own");
  add_cage_object_option(*command, options->choice);
  command->add_option("--json", options->json, "Write the verdict to this file as JSON");
  command->add_flag("--allow-pieces", options->validate.allow_pieces,
                    "Accept a cage of several closed pieces");
  command->add_option("--max-listed", options->validate.max_listed,
                      "Violations of each kind to list; all are counted");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
