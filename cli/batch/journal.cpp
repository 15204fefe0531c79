#include "batch/journal.h"

#include "report/json.h"

#include "io/atomic_file.h"
#include "io/source.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

std::map<std::string, BatchEntry> read_entries(const fs::path& path, bool& ends_in_a_line) {
  std::map<std::string, BatchEntry> entries;
  std::ifstream file(path);
  std::string line;
  ends_in_a_line = true;
  while (std::getline(file, line)) {
    ends_in_a_line = !file.eof();
    BatchEntry entry = entry_of(nlohmann::json::parse(line, nullptr, false));
    if (!entry.model.empty() && ends_in_a_line) {
      entries[entry.model] = std::move(entry);
    }
  }
  return entries;
}

/// A field of a table of comma-separated values (RFC 4180).
std::string field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    return std::string(text);
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + "\"";
}

/// The figures of cages that have a column of their own.
constexpr const char* figure_columns[] = {
    "vertices",      "faces",        "quads",   "volume_ratio", "clearance",
    "mean_distance", "max_distance", "webbing", "min_quality",  "mirrored"};

std::string as_csv(const std::vector<BatchEntry>& entries) {
  std::string text = "model,cage,status,reason,message";
  for (const char* const name : figure_columns) {
    text += std::string(",") + name;
  }
  text += ",seconds,cpu_seconds,peak_mb,exit_code,from_before\n";
  for (const BatchEntry& entry : entries) {
    text += field(entry.model) + "," + field(entry.cage) + "," +
            std::string(name_of(entry.status)) + "," + field(entry.reason) + "," +
            field(entry.message);
    for (const char* const name : figure_columns) {
      const bool has = entry.figures.is_object() && entry.figures.contains(name);
      text += "," + (has ? entry.figures[name].dump() : std::string());
    }
    constexpr double mega = 1024.0 * 1024.0;
    text += fmt::format(",{:.3f},{:.3f},{:.1f},{},{}\n", entry.seconds, entry.cpu_seconds,
                        static_cast<double>(entry.peak_bytes) / mega, entry.exit_code,
                        entry.is_from_before ? "yes" : "no");
  }
  return text;
}

} // namespace

Result<BatchJournal> BatchJournal::open(const fs::path& out) {
  BatchJournal journal;
  journal.path_ = out / "batch.jsonl";
  journal.file_ = ::open(journal.path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (journal.file_ < 0) {
    return cannot_write(journal.path_, errno);
  }
  if (::flock(journal.file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return Error{ErrorCode::cannot_write, one_line(out.string()) +
                                              ": another batch is at work there; wait for it, or "
                                              "give another folder"};
  }
  bool ends_in_a_line = true;
  journal.entries_ = read_entries(journal.path_, ends_in_a_line);
  if (!ends_in_a_line && ::write(journal.file_, "\n", 1) != 1) {
    return cannot_write(journal.path_, errno);
  }
  return journal;
}

BatchJournal::BatchJournal(BatchJournal&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)),
      entries_(std::move(other.entries_)) {}

BatchJournal::~BatchJournal() {
  if (file_ >= 0) {
    ::close(file_);
  }
}

const BatchEntry* BatchJournal::find(const std::string& model) const {
  const auto found = entries_.find(model);
  return found == entries_.end() ? nullptr : &found->second;
}

Status BatchJournal::add(const BatchEntry& entry) {
  const std::string line = text_of(json_of(entry), -1);
  errno = ENOSPC; // where less is written than asked for
  if (::write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return cannot_write(path_, errno);
  }
  ::fdatasync(file_);
  entries_[entry.model] = entry;
  return success();
}

Status write_batch_tables(const fs::path& out, const std::vector<BatchEntry>& entries,
                          const nlohmann::json& description) {
  nlohmann::json json = description;
  json["models"] = nlohmann::json::array();
  for (const BatchEntry& entry : entries) {
    json["models"].push_back(json_of(entry));
    json["models"].back()["from_before"] = entry.is_from_before;
  }
  const std::string csv = as_csv(entries);
  const std::string text = text_of(json, 1);
  const NamedBytes files[] = {{out / "batch.csv", csv}, {out / "batch.json", text}};
  return write_files_atomically(files);
}

} // namespace cagewright::cli
