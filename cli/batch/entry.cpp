#include "batch/entry.h"

#include "session.h"

namespace cagewright::cli {

std::string_view name_of(BatchStatus status) {
  switch (status) {
  case BatchStatus::done:
    return "done";
  case BatchStatus::not_as_asked:
    return "not_as_asked";
  case BatchStatus::failed:
    return "failed";
  }
  return "unknown"; // no default above: the compiler points here when a status is added
}

bool BatchEntry::hit_a_limit() const {
  return exit_code == limit_reached;
}

nlohmann::json json_of(const BatchEntry& entry) {
  return {{"model", entry.model},
          {"cage", entry.cage},
          {"status", name_of(entry.status)},
          {"reason", entry.reason},
          {"message", entry.message},
          {"exit_code", entry.exit_code},
          {"seconds", entry.seconds},
          {"cpu_seconds", entry.cpu_seconds},
          {"peak_bytes", entry.peak_bytes},
          {"figures", entry.figures},
          {"key", entry.key},
          {"limits", entry.limits},
          {"cage_checksum", entry.cage_checksum}};
}

BatchEntry entry_of(const nlohmann::json& json) {
  BatchEntry entry;
  if (!json.is_object()) {
    return entry;
  }
  try {
    entry.model = json.value("model", "");
    entry.cage = json.value("cage", "");
    const std::string status = json.value("status", "");
    entry.status = status == name_of(BatchStatus::done)           ? BatchStatus::done
                   : status == name_of(BatchStatus::not_as_asked) ? BatchStatus::not_as_asked
                                                                  : BatchStatus::failed;
    entry.reason = json.value("reason", "");
    entry.message = json.value("message", "");
    entry.exit_code = json.value("exit_code", 0);
    entry.seconds = json.value("seconds", 0.0);
    entry.cpu_seconds = json.value("cpu_seconds", 0.0);
    entry.peak_bytes = json.value("peak_bytes", std::uint64_t(0));
    entry.figures = json.value("figures", nlohmann::json());
    entry.key = json.value("key", "");
    entry.limits = json.value("limits", "");
    entry.cage_checksum = json.value("cage_checksum", "");
  } catch (const nlohmann::json::exception&) { // a member of another type: not ours
    return {};
  }
  return entry;
}

} // namespace cagewright::cli
