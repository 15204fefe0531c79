#include "app/jobs/job.h"

#include <QMetaObject>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <stop_token>
#include <utility>

namespace cagewright::app {
namespace {

Result<Job::Apply> run(const Job::Work& work, const Progress& progress) {
  try {
    return work(progress);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::too_large, "there is not enough memory for this"};
  } catch (const std::exception& e) {
    return Error{ErrorCode::no_valid_cage, std::string("internal error: ") + e.what()};
  }
}

} // namespace

Job::Job(QString title, QObject* parent) : QObject(parent), title_(std::move(title)) {}

Job::~Job() = default; // std::jthread requests the stop, then joins

double Job::seconds() const {
  return clock_.isValid() ? static_cast<double>(clock_.elapsed()) / 1000 : 0;
}

void Job::start(Work work) {
  clock_.start();
  thread_ = std::jthread([this, work = std::move(work)](const std::stop_token& stop) {
    // Reports come one at a time; more than thirty a second would only burden the window.
    auto last = std::chrono::steady_clock::time_point();
    const StopFlag flag;
    const std::stop_callback link(stop, [flag] { flag.request_stop(); });
    const Progress progress(flag, [this, last](double fraction, std::string_view step) mutable {
      const auto now = std::chrono::steady_clock::now();
      if (now - last < std::chrono::milliseconds(33) && fraction < 1) {
        return;
      }
      last = now;
      const QString text = QString::fromUtf8(step.data(), static_cast<qsizetype>(step.size()));
      QMetaObject::invokeMethod(
          this, [this, fraction, text] { Q_EMIT progressed(fraction, text); },
          Qt::QueuedConnection);
    });
    Result<Apply> result = run(work, progress);
    QMetaObject::invokeMethod(
        this,
        [this, stop, result = std::move(result)] {
          if (!stop.stop_requested()) {
            if (!result) {
              Q_EMIT failed(QString::fromStdString(result.error().message));
            } else if (*result) {
              (*result)();
            }
          }
          Q_EMIT finished();
        },
        Qt::QueuedConnection);
  });
}

void Job::cancel() {
  thread_.request_stop();
}

QString TimeLeft::say(double seconds, double fraction) {
  // The first parts of a job tell little of the rest.
  constexpr double least_seconds = 1;
  constexpr double least_fraction = 0.05;
  if (seconds < least_seconds || fraction < least_fraction || fraction >= 1) {
    return {};
  }
  const double end = seconds / fraction;
  // Sooner than said only where it is much sooner: words that change all the time say nothing.
  if (!end_ || end - seconds < 0.7 * (*end_ - seconds)) {
    end_ = end;
  }
  const double left = *end_ - seconds;
  if (left <= 0) {
    return QObject::tr("longer than expected");
  }
  if (left < 5) {
    return QObject::tr("a few seconds left");
  }
  if (left < 75) {
    const double step = left < 20 ? 5 : 10;
    return QObject::tr("about %1 seconds left").arg(std::ceil(left / step) * step);
  }
  const double minutes = std::ceil(left / 60);
  return QObject::tr("about %1 minutes left").arg(minutes);
}

} // namespace cagewright::app
