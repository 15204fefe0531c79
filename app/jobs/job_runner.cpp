#include "app/jobs/job_runner.h"

#include <utility>

namespace cagewright::app {

JobRunner::JobRunner(QObject* parent)
    : QObject(parent), job_(nullptr, [](Job* job) { delete job; }) {}

bool JobRunner::run(const QString& title, Job::Work work) {
  if (job_) {
    return false;
  }
  job_.reset(new Job(title));
  Job* job = job_.get();
  connect(job, &Job::progressed, this,
          [this, job, left = TimeLeft()](double fraction, const QString& step) mutable {
            if (job == job_.get()) {
              Q_EMIT progressed(fraction, step, left.say(job->seconds(), fraction));
            }
          });
  connect(job, &Job::failed, this,
          [this, job](const QString& message) { Q_EMIT failed(job->title(), message); });
  connect(job, &Job::finished, this, [this, job] {
    const bool stopped = job->cancelled();
    const QString name = job->title();
    job_.release()->deleteLater(); // it is in the middle of emitting
    if (stopped) {
      Q_EMIT cancelled(name);
    }
    Q_EMIT finished();
  });
  Q_EMIT started(title);
  job->start(std::move(work));
  return true;
}

void JobRunner::cancel() {
  if (job_) {
    job_->cancel();
  }
}

} // namespace cagewright::app
