/// \file
/// What a batch has done so far, in a file that survives whatever happens to the program.
#pragma once

#include "batch/entry.h"

#include <cagewright/core/result.h>

#include <filesystem>
#include <map>
#include <string>

namespace cagewright::cli {

/// A file with a line of JSON for each model that was dealt with, the last word on a model being
/// the one that counts. A line that was cut off by a crash is passed over.
class BatchJournal {
public:
  /// Opens or begins OUT/batch.jsonl. While it is open no other batch can work there.
  /// Errors: cannot_open, cannot_write (also: another batch is at work).
  static Result<BatchJournal> open(const std::filesystem::path& out);

  BatchJournal(BatchJournal&& other) noexcept;
  BatchJournal& operator=(BatchJournal&&) = delete;
  ~BatchJournal();

  /// What is known of a model; null: nothing.
  [[nodiscard]] const BatchEntry* find(const std::string& model) const;

  /// Adds a line, on the disk before it returns. Errors: cannot_write.
  Status add(const BatchEntry& entry);

private:
  BatchJournal() = default;

  std::filesystem::path path_;
  int file_ = -1;
  std::map<std::string, BatchEntry> entries_;
};

/// Writes OUT/batch.csv, a row for each entry, and OUT/batch.json, with what the options were.
/// Errors: cannot_write.
Status write_batch_tables(const std::filesystem::path& out, const std::vector<BatchEntry>& entries,
                          const nlohmann::json& description);

} // namespace cagewright::cli
