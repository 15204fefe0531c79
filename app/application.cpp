#include "app/application.h"

#include <QEvent>
#include <QMetaEnum>
#include <QThread>

#include <cstdio>
#include <ctime>
#include <utility>

namespace cagewright::app {
namespace {

QString named(const char* receiver, int event) {
  const char* kind = QMetaEnum::fromType<QEvent::Type>().valueToKey(event);
  return QString("%1 to %2")
      .arg(kind != nullptr ? QString(kind) : QString::number(event), QString(receiver));
}

} // namespace

Application::Application(int& argc, char** argv) : QApplication(argc, argv) {
  bool is_number = false;
  const double from = qEnvironmentVariable("CAGEWRIGHT_TURNS").toDouble(&is_number);
  if (is_number) {
    told_from_ = from;
  }
}

void Application::forget_turns() {
  longest_ = hardest_ = {};
}

Application::Moment Application::now() {
  Moment moment{std::chrono::steady_clock::now(), 0};
#ifdef CLOCK_THREAD_CPUTIME_ID
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  moment.work = 1000 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) / 1e6;
#endif
  return moment;
}

bool Application::notify(QObject* receiver, QEvent* event) {
  // Of an event that is sent from within another's handling the turn is that other's; a loop within
  // the loop, as that of a dialog, has turns of its own, and answers between them.
  const int level = QThread::currentThread()->loopLevel();
  if (thread() != QThread::currentThread() || level <= loop_level_) {
    return QApplication::notify(receiver, event);
  }
  const int outer = std::exchange(loop_level_, level);
  const char* name = receiver->metaObject()->className(); // it may be gone afterwards
  const int type = event->type();
  begin_ = now();
  const bool result = QApplication::notify(receiver, event);
  const Moment end = now();
  keep_turn(end, name, type);
  loop_level_ = outer;
  begin_ = end; // the outer one goes on from here
  return result;
}

void Application::keep_turn(const Moment& end, const char* receiver, int event) {
  const std::chrono::duration<double, std::milli> time = end.time - begin_.time;
  const double work = end.work - begin_.work;
  if (time.count() > longest_.milliseconds) {
    longest_ = {time.count(), work, named(receiver, event)};
  }
  if (work > hardest_.work) {
    hardest_ = {time.count(), work, named(receiver, event)};
  }
  if (told_from_ && time.count() > *told_from_) {
    std::fprintf(stderr, "turn of %.0f ms (%.0f of this thread): %s\n", time.count(), work,
                 qPrintable(named(receiver, event)));
  }
}

} // namespace cagewright::app
