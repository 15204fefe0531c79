/// \file
/// The computation the user waits for: one at a time.
#pragma once

#include "app/jobs/job.h"

#include <memory>

namespace cagewright::app {

/// Runs one job at a time and says how it is getting on. The window stays usable meanwhile.
class JobRunner final : public QObject {
  Q_OBJECT

public:
  explicit JobRunner(QObject* parent = nullptr);

  /// Starts the work, unless another is under way. \returns whether it was started
  bool run(const QString& title, Job::Work work);
  void cancel();

  [[nodiscard]] bool busy() const { return job_ != nullptr; }
  [[nodiscard]] QString title() const { return job_ ? job_->title() : QString(); }

Q_SIGNALS:
  void started(const QString& title);
  void progressed(double fraction, const QString& step, const QString& time_left);
  void cancelled(const QString& title);
  void failed(const QString& title, const QString& message);
  void finished();

private:
  std::unique_ptr<Job, void (*)(Job*)> job_;
};

} // namespace cagewright::app
