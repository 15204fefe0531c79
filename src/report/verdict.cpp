#include "report/verdict.h"

#include "report/json.h"

namespace cagewright {
namespace {

nlohmann::json violation_json(const Violation& violation, const JudgedFiles& files) {
  nlohmann::json elements = nlohmann::json::array();
  for (const Index element : violation.elements) {
    if (element != Violation::none) {
      elements.push_back(element);
    }
  }
  const std::string what = headline(violation.kind, 1).substr(2); // without the count
  const std::string where = describe(violation);
  return {{"kind", name_of(violation.kind)},
          {"elements", elements},
          {"place", json_of(violation.place)},
          {"file", file_of(violation.kind, files)},
          {"message", where.empty() ? what : what + ": " + where},
          {"remedy", remedy(violation.kind, files)}};
}

} // namespace

nlohmann::json json_of(const ValidityReport& report, const JudgedFiles& files) {
  nlohmann::json json = {{"valid", report.valid()},
                         {"containment_approximate", report.containment_approximate},
                         {"merged_vertices", report.merged_vertices},
                         {"loose_vertices", report.loose_vertices},
                         {"loose_model_vertices", report.loose_model_vertices},
                         {"counts", nlohmann::json::object()},
                         {"violations", nlohmann::json::array()}};
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    json["counts"][name_of(static_cast<ViolationKind>(k))] = report.counts[k];
  }
  for (const Violation& violation : report.violations) {
    json["violations"].push_back(violation_json(violation, files));
  }
  return json;
}

void name_model_vertices(ValidityReport& report, std::span<const Index> vertex_of) {
  for (Violation& violation : report.violations) {
    const bool is_of_model = violation.kind == ViolationKind::vertex_outside ||
                             violation.kind == ViolationKind::vertex_on_cage;
    if (is_of_model && !vertex_of.empty()) {
      violation.elements[0] = vertex_of[violation.elements[0]];
    }
  }
}

void name_model_faces(ValidityReport& report, std::span<const Index> face_of) {
  for (Violation& violation : report.violations) {
    if (violation.kind == ViolationKind::face_contact && !face_of.empty()) {
      violation.elements[0] = face_of[violation.elements[0]];
    }
  }
}

} // namespace cagewright
