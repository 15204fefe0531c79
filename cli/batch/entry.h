/// \file
/// What became of one model of a batch.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace cagewright::cli {

enum class BatchStatus {
  done,         ///< a cage, as asked
  not_as_asked, ///< a valid cage, but not all that was asked for holds
  failed        ///< no cage
};

/// As in the tables: "not_as_asked".
std::string_view name_of(BatchStatus status);

struct BatchEntry {
  std::string model; ///< as BatchJob names it
  std::string cage;  ///< path of the cage
  BatchStatus status = BatchStatus::failed;
  std::string reason; ///< a word for programs: "malformed", "time_limit", "crashed"; none: as asked
  std::string message; ///< a sentence for people; none: as asked
  int exit_code = 0;
  double seconds = 0; ///< by the wall clock
  double cpu_seconds = 0;
  std::uint64_t peak_bytes = 0;
  nlohmann::json figures;      ///< of the cage, as in its report; null: there is none
  std::string key;             ///< of the model, the options and the program: what it was made from
  std::string limits;          ///< that it ran under
  std::string cage_checksum;   ///< of the file that was written
  bool is_from_before = false; ///< an earlier run has made it

  /// Whether a limit of time or memory was the reason, which another may mend.
  [[nodiscard]] bool hit_a_limit() const;
};

nlohmann::json json_of(const BatchEntry& entry);

/// The entry that json_of() has written; a failed one without a name for anything else.
BatchEntry entry_of(const nlohmann::json& json);

} // namespace cagewright::cli
