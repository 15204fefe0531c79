#include "batch/run.h"

#include "batch/checksum.h"
#include "batch/child_process.h"
#include "batch/journal.h"
#include "batch/plan.h"
#include "load.h"

#include "io/atomic_file.h"
#include "io/source.h"
#include <cagewright/version.h>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

nlohmann::json read_json(const fs::path& path) {
  std::ifstream file(path);
  return nlohmann::json::parse(file, nullptr, false);
}

/// The file of --density for a model: * stands for the model's name.
std::string density_for(const std::string& density, const fs::path& model) {
  std::string file = density;
  if (const std::size_t star = file.find('*'); star != std::string::npos) {
    file.replace(star, 1, model.stem().string());
  }
  return file;
}

/// The words after `cagewright generate MODEL -o CAGE --json REPORT` that are the same for all
/// models.
std::vector<std::string> words_of(const GenerateArguments& asked) {
  std::vector<std::string> words = asked.words;
  if (asked.choice.pose == Pose::bind) {
    words.emplace_back("--pose=bind");
  }
  for (const std::string& only : asked.choice.only) {
    words.push_back("--only=" + only);
  }
  return words;
}

/// A child at work.
struct Running {
  const BatchJob* job;
  std::string key;
  Clock::time_point start;
  ChildProcess process;
  bool is_overdue = false;
};

class Batch {
public:
  Batch(const BatchArguments& arguments, const Session& session, std::vector<BatchJob> jobs,
        BatchJournal journal)
      : arguments_(arguments), session_(session), jobs_(std::move(jobs)),
        journal_(std::move(journal)), words_(words_of(arguments.generate)) {
    const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    at_a_time_ = std::min(arguments.jobs > 0 ? arguments.jobs : cores,
                          std::max(1, static_cast<int>(jobs_.size())));
    threads_ = session.threads > 0 ? session.threads : std::max(1, cores / at_a_time_);
    // Unless it was asked for, the machine's memory is shared.
    bytes_ = session.limits.is_memory_given
                 ? session.limits.bytes
                 : session.limits.bytes / static_cast<std::uint64_t>(at_a_time_);
    limits_ = fmt::format("{} s, {} bytes", session.limits.seconds, bytes_);
    for (const BatchJob& job : jobs_) {
      unknown_ += journal_.find(job.name) == nullptr ? 1 : 0;
    }
  }

  int run();

private:
  Status start_some();
  Status start(const BatchJob& job, std::string key);
  [[nodiscard]] std::optional<BatchEntry> made_before(const BatchJob& job,
                                                      const std::string& key) const;
  [[nodiscard]] std::string key_of(const BatchJob& job) const;
  [[nodiscard]] std::vector<std::string> command_line(const BatchJob& job) const;
  Status collect();
  [[nodiscard]] BatchEntry entry_of(Running& child, const ChildExit& exit) const;
  void explain_failure(BatchEntry& entry, const Running& child, const ChildExit& exit,
                       const nlohmann::json& report) const;
  Status finish(BatchEntry entry, bool is_new);
  void stop_all();
  void stop_overdue();
  void wait();
  Status write_tables();
  void tell(const BatchEntry& entry) const;
  void tell_progress() const;
  [[nodiscard]] std::string summary() const;
  [[nodiscard]] std::size_t count(BatchStatus status) const;

  const BatchArguments& arguments_;
  const Session& session_;
  std::vector<BatchJob> jobs_;
  BatchJournal journal_;
  std::vector<std::string> words_;
  std::string limits_;
  int at_a_time_ = 1;
  int threads_ = 1;
  std::uint64_t bytes_ = 0;

  std::size_t next_ = 0; // of jobs_
  std::vector<Running> running_;
  std::vector<BatchEntry> entries_; // in the order in which they were finished
  std::size_t unknown_ = 0;         // jobs ahead of which the journal knows nothing
  std::size_t made_now_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point tables_written_ = Clock::now();
};

std::string Batch::key_of(const BatchJob& job) const {
  const std::optional<std::string> model = checksum_of_model(job.model);
  Checksum sum;
  sum.add(model.value_or("cannot be read"));
  sum.add(CAGEWRIGHT_VERSION);
  std::vector<std::string> words = words_;
  std::ranges::sort(words); // in whatever order they were given
  for (const std::string& word : words) {
    sum.add("\n" + word);
  }
  const std::string density = density_for(arguments_.generate.density, job.model);
  sum.add("\n" + density);
  if (!density.empty() && density != "colors") {
    sum.add_file(density);
  }
  return sum.text();
}

std::optional<BatchEntry> Batch::made_before(const BatchJob& job, const std::string& key) const {
  const BatchEntry* const known = journal_.find(job.name);
  if (known == nullptr || known->key != key) {
    return std::nullopt;
  }
  if (known->status == BatchStatus::failed) {
    const bool may_succeed = arguments_.retry ||
                             (known->hit_a_limit() && known->limits != limits_) ||
                             known->reason == "cannot_open" || known->reason == "cannot_write";
    return may_succeed ? std::nullopt : std::optional(*known);
  }
  Checksum sum;
  const bool is_there = sum.add_file(job.cage) && sum.text() == known->cage_checksum;
  return is_there ? std::optional(*known) : std::nullopt;
}

std::vector<std::string> Batch::command_line(const BatchJob& job) const {
  // A name that begins with a dash is no option.
  const std::string model = job.model.string();
  std::vector<std::string> words = {"generate",
                                    model.starts_with('-') ? "./" + model : model,
                                    "--output=" + job.cage.string(),
                                    "--json=" + job.report.string(),
                                    "--quiet",
                                    fmt::format("--threads={}", threads_),
                                    fmt::format("--time-limit={}", session_.limits.seconds),
                                    fmt::format("--memory-limit={}", bytes_)};
  const std::string density = density_for(arguments_.generate.density, job.model);
  if (!density.empty()) {
    words.push_back("--density=" + density);
  }
  words.insert(words.end(), words_.begin(), words_.end());
  return words;
}

Status Batch::start(const BatchJob& job, std::string key) {
  std::error_code error;
  fs::create_directories(job.cage.parent_path(), error);
  // What is left of an earlier run belongs to another file or other options.
  fs::remove(job.cage, error);
  fs::remove(job.report, error);
  Result<ChildProcess> process = ChildProcess::start(this_program(), command_line(job));
  if (!process) {
    return process.error();
  }
  running_.push_back({&job, std::move(key), Clock::now(), std::move(*process)});
  return success();
}

Status Batch::start_some() {
  while (next_ < jobs_.size() && running_.size() < static_cast<std::size_t>(at_a_time_) &&
         !session_.stop.stop_requested()) {
    const BatchJob& job = jobs_[next_++];
    unknown_ -= journal_.find(job.name) == nullptr ? 1 : 0;
    std::string key = key_of(job);
    if (std::optional<BatchEntry> before = made_before(job, key)) {
      before->is_from_before = true;
      if (Status finished = finish(std::move(*before), false); !finished) {
        return finished;
      }
    } else if (Status started = start(job, std::move(key)); !started) {
      return started;
    }
  }
  return success();
}

void Batch::explain_failure(BatchEntry& entry, const Running& child, const ChildExit& exit,
                            const nlohmann::json& report) const {
  const nlohmann::json error =
      report.is_object() ? report.value("error", nlohmann::json()) : nlohmann::json();
  if (child.is_overdue) {
    entry.exit_code = limit_reached;
    entry.reason = "time_limit";
    entry.message = fmt::format("the time limit of {} is reached; allow more with --time-limit",
                                seconds_as_text(session_.limits.seconds));
  } else if (exit.signal == SIGKILL) {
    entry.exit_code = limit_reached;
    entry.reason = "killed";
    entry.message = "the system has killed it, perhaps for want of memory; run fewer --jobs, or "
                    "give a --memory-limit";
  } else if (exit.signal != 0) {
    entry.reason = "crashed";
    entry.message = fmt::format("the program has crashed ({}); please report it with the model",
                                strsignal(exit.signal));
  } else if (error.is_object()) {
    entry.reason = error.value("code", "");
    entry.message = error.value("message", "");
  } else {
    std::string said = child.process.said();
    said.erase(said.find_last_not_of('\n') + 1);
    entry.reason = exit.code == limit_reached ? "too_large" : "failed";
    entry.message = one_line(said.substr(said.rfind('\n') + 1));
  }
}

BatchEntry Batch::entry_of(Running& child, const ChildExit& exit) const {
  BatchEntry entry;
  entry.model = child.job->name;
  entry.cage = child.job->cage.string();
  entry.exit_code = exit.signal != 0 ? 128 + exit.signal : exit.code;
  entry.seconds = seconds_since(child.start);
  entry.cpu_seconds = exit.cpu_seconds;
  entry.peak_bytes = exit.peak_bytes;
  entry.key = child.key;
  entry.limits = limits_;
  const nlohmann::json report = read_json(child.job->report);
  Checksum sum;
  const bool has_cage = exit.signal == 0 && (exit.code == done || exit.code == not_satisfiable) &&
                        report.is_object() && report.contains("cage") &&
                        sum.add_file(child.job->cage);
  if (!has_cage) {
    explain_failure(entry, child, exit, report);
    return entry;
  }
  entry.cage_checksum = sum.text();
  entry.figures = report["cage"];
  entry.figures["quads"] = report.contains("quads") ? report["quads"]["quads"] : nlohmann::json(0);
  entry.figures["mirrored"] = report["symmetry"]["mirrored"];
  entry.status = exit.code == done ? BatchStatus::done : BatchStatus::not_as_asked;
  if (entry.status == BatchStatus::not_as_asked && !report["remarks"].empty()) {
    entry.reason = report["remarks"][0].value("reason", "");
    entry.message = report["remarks"][0].value("message", "");
  }
  return entry;
}

Status Batch::collect() {
  for (std::size_t i = 0; i < running_.size();) {
    const std::optional<ChildExit> exit = running_[i].process.poll();
    if (!exit) {
      ++i;
      continue;
    }
    // Asked to stop, it has left nothing: next time it is made.
    const bool was_stopped = session_.stop.stop_requested() && !running_[i].is_overdue &&
                             (exit->code == interrupted || exit->signal != 0);
    std::optional<BatchEntry> entry;
    if (!was_stopped) {
      entry = entry_of(running_[i], *exit);
    }
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    if (entry) {
      if (Status finished = finish(std::move(*entry), true); !finished) {
        return finished;
      }
    }
  }
  return success();
}

Status Batch::finish(BatchEntry entry, bool is_new) {
  if (is_new) {
    ++made_now_;
    if (Status added = journal_.add(entry); !added) {
      return added;
    }
    tell(entry);
  }
  entries_.push_back(std::move(entry));
  // Often enough to look at, seldom enough for thousands of models.
  constexpr double some_time = 5;
  return is_new && seconds_since(tables_written_) > some_time ? write_tables() : success();
}

Status Batch::write_tables() {
  tables_written_ = Clock::now();
  std::vector<BatchEntry> sorted = entries_;
  std::ranges::sort(sorted, {}, &BatchEntry::model);
  return write_batch_tables(arguments_.out, sorted,
                            {{"format", "cagewright-batch"},
                             {"version", 1},
                             {"program", CAGEWRIGHT_VERSION},
                             {"options", words_},
                             {"limits", {{"seconds", session_.limits.seconds}, {"bytes", bytes_}}},
                             {"asked_for", jobs_.size()}});
}

void Batch::stop_all() {
  for (Running& child : running_) {
    child.process.ask_to_stop();
  }
}

/// A run ends itself at its time limit, unless it hangs.
void Batch::stop_overdue() {
  constexpr double patience = 10;
  const double limit = session_.limits.seconds;
  for (Running& child : running_) {
    if (limit > 0 && seconds_since(child.start) > 1.2 * limit + patience) {
      child.is_overdue = true;
      child.process.kill();
    }
  }
}

void Batch::wait() {
  std::vector<ChildProcess*> children;
  for (Running& child : running_) {
    children.push_back(&child.process);
  }
  ChildProcess::wait_for_any(children, std::chrono::milliseconds(200));
}

void Batch::tell(const BatchEntry& entry) const {
  const std::size_t digits = std::to_string(jobs_.size()).size();
  std::string text = fmt::format("[{:>{}}/{}] {}: ", entries_.size() + 1, digits, jobs_.size(),
                                 one_line(entry.model));
  if (entry.status == BatchStatus::failed) {
    text += "failed: " + entry.message + "\n";
  } else {
    text += fmt::format("{} vertices, {:.3f} times the volume, {:.1f} s{}\n",
                        entry.figures.value("vertices", 0),
                        entry.figures.value("volume_ratio", 0.0), entry.seconds,
                        entry.message.empty() ? "" : "; not as asked for: " + entry.message);
  }
  if (isatty(STDERR_FILENO) != 0 && !session_.quiet) {
    std::fputs("\r\033[K", stderr);
  }
  session_.say(text);
  std::fflush(stdout);
}

std::string time_left(double seconds) {
  return seconds < 90       ? fmt::format("{:.0f} s", seconds)
         : seconds < 5400   ? fmt::format("{:.0f} min", seconds / 60)
         : seconds < 172800 ? fmt::format("{:.1f} h", seconds / 3600)
                            : fmt::format("{:.1f} days", seconds / 86400);
}

void Batch::tell_progress() const {
  if (session_.quiet || isatty(STDERR_FILENO) == 0) {
    return;
  }
  std::string text = fmt::format("\r\033[K{} of {}", entries_.size(), jobs_.size());
  if (const std::size_t failed = count(BatchStatus::failed); failed > 0) {
    text += fmt::format(", {} failed", failed);
  }
  if (made_now_ > 0) {
    // Those that the journal knows are most likely passed over.
    const double left = static_cast<double>(unknown_ + running_.size());
    text += ", about " + time_left(seconds_since(begin_) / static_cast<double>(made_now_) * left) +
            " left";
  }
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

std::size_t Batch::count(BatchStatus status) const {
  return static_cast<std::size_t>(std::ranges::count(entries_, status, &BatchEntry::status));
}

std::string Batch::summary() const {
  const auto before = std::ranges::count(entries_, true, &BatchEntry::is_from_before);
  std::string text = fmt::format("{} of {} models: {} cages", entries_.size(), jobs_.size(),
                                 count(BatchStatus::done) + count(BatchStatus::not_as_asked));
  if (const std::size_t other = count(BatchStatus::not_as_asked); other > 0) {
    text += fmt::format(", {} of them not as asked for", other);
  }
  if (const std::size_t failed = count(BatchStatus::failed); failed > 0) {
    text += fmt::format("; {} failed", failed);
  }
  if (before > 0) {
    text += fmt::format("; {} known from before{}", before,
                        arguments_.retry ? "" : " (--retry tries the failed ones again)");
  }
  const fs::path out = arguments_.out;
  return text +
         fmt::format("\n{}, {}\n", (out / "batch.csv").string(), (out / "batch.json").string());
}

int Batch::run() {
  bool is_stopping = false;
  Status status = success();
  while (status && (next_ < jobs_.size() || !running_.empty())) {
    status = start_some();
    if (session_.stop.stop_requested() && !std::exchange(is_stopping, true)) {
      stop_all();
    }
    if (is_stopping && running_.empty()) {
      break;
    }
    if (status && !running_.empty()) {
      tell_progress();
      wait();
      stop_overdue();
      status = collect();
    }
  }
  if (isatty(STDERR_FILENO) != 0 && !session_.quiet) {
    std::fputs("\r\033[K", stderr);
  }
  const Status written = write_tables();
  if (!status) {
    return fail(status.error());
  }
  if (!written) {
    return fail(written.error());
  }
  session_.say(summary());
  if (is_stopping) {
    fail(Error{ErrorCode::cancelled, "stopped; the same command goes on where this one was"});
    return interrupted;
  }
  return count(BatchStatus::done) == entries_.size() ? done : not_satisfiable;
}

} // namespace

int run_batch(const BatchArguments& arguments, const Session& session) {
  std::fputs(without_effect(arguments.generate).c_str(), stderr);
  std::error_code error;
  fs::create_directories(arguments.out, error);
  if (error) {
    return fail(cannot_write(arguments.out, error.value()));
  }
  Result<std::vector<BatchJob>> jobs =
      plan_batch(arguments.inputs, arguments.out, "." + arguments.format);
  if (!jobs) {
    return fail(jobs.error());
  }
  for (const BatchJob& job : *jobs) {
    if (Status fine = can_write_output(job.cage.string(), {job.model.string()}); !fine) {
      // Not for folders that are made only when they are needed.
      if (fs::exists(job.cage.parent_path())) {
        return fail(fine.error());
      }
    }
  }
  Result<BatchJournal> journal = BatchJournal::open(arguments.out);
  if (!journal) {
    return fail(journal.error());
  }
  return Batch(arguments, session, std::move(*jobs), std::move(*journal)).run();
}

} // namespace cagewright::cli
