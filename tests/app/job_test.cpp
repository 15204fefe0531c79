#include "app/jobs/job.h"

#include "app/jobs/job_runner.h"
#include "waiting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <thread>
#include <vector>

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
  EXPECT_TRUE(TimeLeft().say(0.2, 0.5).isEmpty());
  EXPECT_TRUE(TimeLeft().say(60, 0.001).isEmpty());
  EXPECT_EQ(TimeLeft().say(10, 0.5), "about 10 seconds left");
  EXPECT_EQ(TimeLeft().say(100, 0.1), "about 15 minutes left");
}

/// As a number: of seconds, the last thing to be said counting as none.
double seconds_in(const QString& words) {
  if (words == "longer than expected") {
    return 0;
  }
  if (words == "a few seconds left") {
    return 4;
  }
  const double number = words.section(' ', 1, 1).toDouble();
  EXPECT_GT(number, 0) << words.toStdString();
  return words.contains("minute") ? 60 * number : number;
}

TEST(Job, TellsATimeLeftThatNeverClimbs) {
  // Work that is quick at first, even, slow at first, and that comes in jumps.
  const std::vector<std::function<double(double)>> courses = {
      [](double t) { return std::sqrt(t); }, [](double t) { return t; },
      [](double t) { return t * t; }, [](double t) { return std::floor(8 * t) / 8; }};
  for (std::size_t course = 0; course < courses.size(); ++course) {
    TimeLeft left;
    double before = std::numeric_limits<double>::infinity();
    int changes = 0;
    QString said;
    for (double t = 0; t < 1; t += 0.001) {
      const QString now = left.say(200 * t, courses[course](t));
      if (now.isEmpty()) {
        continue;
      }
      EXPECT_LE(seconds_in(now), before) << "course " << course << " at " << t;
      before = seconds_in(now);
      changes += now != said ? 1 : 0;
      said = now;
    }
    EXPECT_LT(changes, 25) << "course " << course;
    EXPECT_GT(changes, 2) << "course " << course;
  }
}

} // namespace
} // namespace cagewright::app
