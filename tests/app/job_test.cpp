#include "app/jobs/job.h"

#include "app/jobs/job_runner.h"
#include "waiting.h"

#include <gtest/gtest.h>

#include <new>
#include <thread>

namespace cagewright::app {
namespace {

using test::wait_until;

TEST(Job, AppliesItsResultOnTheGuiThread) {
  Job job("answer");
  std::thread::id worked_on;
  std::thread::id applied_on;
  job.start([&](const Progress&) -> Result<Job::Apply> {
    worked_on = std::this_thread::get_id();
    return Job::Apply([&] { applied_on = std::this_thread::get_id(); });
  });
  ASSERT_TRUE(wait_until([&] { return applied_on != std::thread::id(); }));
  EXPECT_EQ(applied_on, std::this_thread::get_id());
  EXPECT_NE(worked_on, applied_on);
}

Result<Job::Apply> until_cancelled(const Progress& progress, bool& applied) {
  while (!progress.cancelled()) {
    std::this_thread::yield();
  }
  return Job::Apply([&applied] { applied = true; });
}

TEST(Job, AppliesNothingOnceCancelled) {
  JobRunner runner;
  bool applied = false;
  bool finished = false;
  QObject::connect(&runner, &JobRunner::finished, [&] { finished = true; });
  runner.run("endless", [&](const Progress& p) { return until_cancelled(p, applied); });
  EXPECT_TRUE(runner.busy());
  EXPECT_FALSE(runner.run("second", {})) << "two at a time";
  runner.cancel();
  ASSERT_TRUE(wait_until([&] { return finished; }));
  EXPECT_FALSE(applied);
  EXPECT_FALSE(runner.busy());
}

TEST(Job, StopsItsWorkWhenDestroyed) {
  bool applied = false;
  {
    Job job("abandoned");
    job.start([&](const Progress& p) { return until_cancelled(p, applied); });
  } // returns only because the work was told to stop
  QCoreApplication::processEvents();
  EXPECT_FALSE(applied);
}

TEST(Job, MakesAFailureOfWhatItsWorkThrows) {
  JobRunner runner;
  QString message;
  QObject::connect(&runner, &JobRunner::failed,
                   [&](const QString&, const QString& text) { message = text; });
  runner.run("greedy", [](const Progress&) -> Result<Job::Apply> { throw std::bad_alloc(); });
  ASSERT_TRUE(wait_until([&] { return !runner.busy(); }));
  EXPECT_TRUE(message.contains("memory")) << message.toStdString();
}

TEST(Job, TellsTheTimeThatIsLeftOnceItCan) {
  EXPECT_TRUE(time_left(0.2, 0.5).isEmpty());
  EXPECT_TRUE(time_left(60, 0.001).isEmpty());
  EXPECT_EQ(time_left(10, 0.5), "about 10 seconds left");
  EXPECT_EQ(time_left(100, 0.1), "about 15 minutes left");
}

} // namespace
} // namespace cagewright::app
