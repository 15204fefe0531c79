/// \file
/// The application, which knows how long its window did not answer.
#pragma once

#include <QApplication>

#include <chrono>
#include <optional>

namespace cagewright::app {

/// A window answers between the turns of its event loop, and in none of them. Each is measured.
class Application final : public QApplication {
public:
  /// Turns that are longer than CAGEWRIGHT_TURNS (an environment variable), in milliseconds, are
  /// told on the standard error output.
  Application(int& argc, char** argv);

  /// One event and all that came of it at once.
  struct Turn {
    double milliseconds = 0;
    double work = 0; ///< milliseconds of the processor, of this thread alone
    QString what;    ///< the kind of event and of receiver
  };

  /// The longest turn since the last forget_turns(): by the clock, and by its work.
  [[nodiscard]] const Turn& longest_turn() const { return longest_; }
  [[nodiscard]] const Turn& hardest_turn() const { return hardest_; }
  void forget_turns();

  bool notify(QObject* receiver, QEvent* event) override;

private:
  struct Moment {
    std::chrono::steady_clock::time_point time;
    double work = 0;
  };
  static Moment now();
  void keep_turn(const Moment& end, const char* receiver, int event);

  std::optional<double> told_from_; // milliseconds
  int loop_level_ = -1;             // of the turn under way; -1: none
  Moment begin_;
  Turn longest_, hardest_;
};

} // namespace cagewright::app
