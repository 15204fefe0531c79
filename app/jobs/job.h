/// \file
/// The one place where the application leaves the GUI thread.
#pragma once

#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <QElapsedTimer>
#include <QObject>
#include <QString>

#include <functional>
#include <optional>
#include <thread>

namespace cagewright::app {

/// Runs one computation of the library on a thread of its own.
///
/// `work` sees only what it captured by value, and returns a closure; the closure runs on the GUI
/// thread and is where the document changes. After cancel() it does not run, nor after destruction.
/// What the work throws (no memory is left) becomes a failure.
class Job final : public QObject {
  Q_OBJECT

public:
  using Apply = std::function<void()>;
  using Work = std::function<Result<Apply>(const Progress&)>;

  explicit Job(QString title, QObject* parent = nullptr);
  ~Job() override; ///< asks the work to stop, and waits for it

  void start(Work work);
  void cancel();

  [[nodiscard]] const QString& title() const { return title_; }
  [[nodiscard]] bool cancelled() const { return thread_.get_stop_token().stop_requested(); }
  [[nodiscard]] double seconds() const;

Q_SIGNALS:
  void progressed(double fraction, const QString& step);
  void failed(const QString& message); ///< not after cancel()
  void finished();                     ///< always, and last

private:
  QString title_;
  QElapsedTimer clock_;
  std::jthread thread_;
};

/// What is left of a job, in words that stay true: they count down, and never up again. Parts of
/// the work go faster than others; what turns out to take longer is said to take longer.
class TimeLeft {
public:
  /// \param seconds   since the start, rising
  /// \param fraction  of the work that is done
  /// \returns "about 2 minutes left"; empty while it is too early to tell
  QString say(double seconds, double fraction);

private:
  std::optional<double> end_; // in seconds since the start
};

} // namespace cagewright::app
