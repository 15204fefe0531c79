#include "interruption.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <utility>

namespace cagewright::cli {
namespace {

constexpr long moment = 200'000'000; // nanoseconds: with it, a stop takes less than 0.3 s

// A signal handler can reach nothing but globals, and do little more than post a semaphore.
std::atomic<const StopFlag*> stop_at_hand = nullptr;
std::atomic<sem_t*> semaphore_at_hand = nullptr;

void interrupt(int signal) {
  const int error = errno;
  if (const StopFlag* stop = stop_at_hand.load()) {
    stop->request_stop();
  }
  if (sem_t* semaphore = semaphore_at_hand.load()) {
    sem_post(semaphore);
  }
  std::signal(signal, SIG_DFL); // a second one ends the program at once
  errno = error;
}

void wait(sem_t& semaphore) {
  while (sem_wait(&semaphore) != 0 && errno == EINTR) {
  }
}

/// \returns whether it was posted before that
bool wait(sem_t& semaphore, long nanoseconds) {
  constexpr long second = 1'000'000'000;
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += nanoseconds;
  until.tv_sec += until.tv_nsec / second;
  until.tv_nsec %= second;
  int waited = 0;
  do {
    waited = sem_timedwait(&semaphore, &until);
  } while (waited != 0 && errno == EINTR);
  return waited == 0;
}

} // namespace

Interruption::Interruption(const StopFlag& stop, std::function<void()> overdue)
    : stop_(stop), overdue_(std::move(overdue)) {
  sem_init(&asked_, 0, 0);
  stop_at_hand = &stop_;
  if (overdue_) {
    semaphore_at_hand = &asked_;
    thread_ = std::thread([this] {
      wait(asked_);
      while (stop_.stop_requested() && !wait(asked_, moment)) {
        overdue_();
      }
    });
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, interrupt) == SIG_IGN) { // as under nohup
      std::signal(signal, SIG_IGN);
    }
  }
}

Interruption::~Interruption() {
  stop_at_hand = nullptr;
  semaphore_at_hand = nullptr;
  if (thread_.joinable()) {
    sem_post(&asked_);
    thread_.join();
  }
  sem_destroy(&asked_);
}

} // namespace cagewright::cli
