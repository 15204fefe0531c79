#include "batch/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

namespace cagewright::cli {
namespace {

constexpr std::size_t kept_words = 8192; // bytes of what a program says

Error cannot_start(const std::filesystem::path& program) {
  return {ErrorCode::not_available,
          program.string() + " cannot be started: " + std::strerror(errno)};
}

/// Between fork and exec only what signal handlers may do is allowed.
[[noreturn]] void become(const char* program, char* const* words, int errors, pid_t parent) {
  ::setpgid(0, 0); // the terminal's Ctrl-C is for the parent, which passes it on
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) { // it has died meanwhile
    ::_exit(1);
  }
#else
  (void)parent;
#endif
  const int nowhere = ::open("/dev/null", O_RDWR);
  if (nowhere < 0 || ::dup2(nowhere, STDIN_FILENO) < 0 || ::dup2(nowhere, STDOUT_FILENO) < 0 ||
      ::dup2(errors, STDERR_FILENO) < 0) {
    ::_exit(1);
  }
  ::execv(program, words);
  static constexpr std::array<char, 22> failed = {"cannot be started\n"};
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, failed.data(), 18);
  ::_exit(127);
}

double seconds_of(const timeval& time) {
  constexpr double micro = 1e-6;
  return static_cast<double>(time.tv_sec) + micro * static_cast<double>(time.tv_usec);
}

} // namespace

struct ChildProcess::State {
  pid_t process = -1;
  int errors = -1; // the end of the pipe that we read
  std::string said;
  std::optional<ChildExit> exit;

  /// Takes what is in the pipe, without waiting.
  void listen() {
    std::array<char, 4096> bytes{};
    ssize_t count = 0;
    while (errors >= 0 && (count = ::read(errors, bytes.data(), bytes.size())) != 0) {
      if (count < 0 && errno == EINTR) {
        continue;
      }
      if (count < 0) {
        return; // nothing now
      }
      said.append(bytes.data(), static_cast<std::size_t>(count));
      if (said.size() > 2 * kept_words) {
        said.erase(0, said.size() - kept_words);
      }
    }
    hang_up();
  }
  void hang_up() {
    if (errors >= 0) {
      ::close(errors);
      errors = -1;
    }
  }
};

std::filesystem::path this_program() {
  return "/proc/self/exe"; // also when the file has been replaced by a newer build
}

ChildProcess::ChildProcess(std::unique_ptr<State> state) : state_(std::move(state)) {}
ChildProcess::ChildProcess(ChildProcess&&) noexcept = default;

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

ChildProcess::~ChildProcess() {
  if (state_ && !poll()) {
    kill();
    while (::waitpid(state_->process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  if (state_) {
    state_->hang_up();
  }
}

Result<ChildProcess> ChildProcess::start(const std::filesystem::path& program,
                                         const std::vector<std::string>& words) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) {
    return cannot_start(program);
  }
  ::fcntl(pipe[0], F_SETFL, O_NONBLOCK);
  std::vector<std::string> line = {"cagewright"};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : line) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  const std::string path = program.string();
  auto state = std::make_unique<State>();
  state->errors = pipe[0];
  const pid_t parent = ::getpid();
  state->process = ::fork();
  if (state->process == 0) {
    become(path.c_str(), pointers.data(), pipe[1], parent);
  }
  ::close(pipe[1]);
  if (state->process < 0) {
    state->hang_up();
    return cannot_start(program);
  }
  ::setpgid(state->process, state->process); // whoever is first
  return ChildProcess(std::move(state));
}

std::optional<ChildExit> ChildProcess::poll() {
  if (state_->exit) {
    return state_->exit;
  }
  state_->listen();
  int status = 0;
  struct rusage used {};
  if (::wait4(state_->process, &status, WNOHANG, &used) != state_->process) {
    return std::nullopt;
  }
  state_->listen();
  state_->hang_up();
  ChildExit exit;
  exit.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  exit.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  exit.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  constexpr std::uint64_t kilo = 1024;
  exit.peak_bytes = static_cast<std::uint64_t>(used.ru_maxrss) * kilo;
  state_->exit = exit;
  return exit;
}

const std::string& ChildProcess::said() const {
  return state_->said;
}

void ChildProcess::ask_to_stop() {
  if (!state_->exit) {
    ::kill(state_->process, SIGTERM);
  }
}

void ChildProcess::kill() {
  if (!state_->exit) {
    ::kill(state_->process, SIGKILL);
  }
}

void ChildProcess::wait_for_any(std::span<ChildProcess* const> children,
                                std::chrono::milliseconds time) {
  std::vector<pollfd> ends;
  for (const ChildProcess* const child : children) {
    if (child->state_->errors < 0 && !child->state_->exit) {
      time = std::min(time, std::chrono::milliseconds(10)); // it has closed its end, and will die
    }
    ends.push_back({child->state_->errors, POLLIN, 0});
  }
  ::poll(ends.data(), ends.size(), static_cast<int>(time.count())); // a signal ends it early
}

} // namespace cagewright::cli
