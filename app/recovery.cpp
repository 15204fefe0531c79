#include "app/recovery.h"

#include <QFile>
#include <QFileInfo>
#include <QUuid>

namespace cagewright::app {
namespace {

QString lock_of(const QString& path) {
  return path + ".lock";
}

} // namespace

Recovery::Recovery(Session& session, const QDir& folder, QObject* parent)
    : QObject(parent), session_(session), folder_(folder) {
  folder_.mkpath(".");
  path_ = folder_.filePath(QUuid::createUuid().toString(QUuid::WithoutBraces) + ".cagewright");
  lock_ = std::make_unique<QLockFile>(lock_of(path_));
  lock_->setStaleLockTime(0);
  lock_->tryLock(0);
  connect(&timer_, &QTimer::timeout, this, &Recovery::save);
  connect(&session, &Session::titleChanged, this, [this] {
    if (!session_.modified()) {
      QFile::remove(path_);
    }
  });
}

Recovery::~Recovery() {
  QFile::remove(path_);
}

void Recovery::set_interval(int seconds) {
  if (seconds > 0) {
    timer_.start(seconds * 1000);
  } else {
    timer_.stop();
  }
}

void Recovery::save() {
  const int step = session_.editor().undo_stack().index();
  if (!session_.modified() || session_.editor().moving() ||
      (step == saved_step_ && QFile::exists(path_))) {
    return;
  }
  if (session_.autosave(path_.toStdString())) {
    saved_step_ = step;
  }
}

std::vector<QString> Recovery::abandoned() const {
  std::vector<QString> found;
  for (const QFileInfo& file : folder_.entryInfoList({"*.cagewright"}, QDir::Files, QDir::Time)) {
    if (file.filePath() == path_) {
      continue;
    }
    QLockFile lock(lock_of(file.filePath()));
    lock.setStaleLockTime(0);
    if (lock.tryLock(0)) {
      found.push_back(file.filePath());
    }
  }
  return found;
}

QString Recovery::subject_of(const QString& path) {
  const Result<Project> project = read_project(path.toStdString());
  if (!project) {
    return tr("a project that was not saved");
  }
  const QString model = QString::fromStdString(project->model_path.filename().string());
  return project->saved_as.empty()
             ? tr("%1, not saved as a project yet").arg(model)
             : tr("the project %1 (model %2)")
                   .arg(QString::fromStdString(project->saved_as.string()), model);
}

void Recovery::recover(const QString& path) {
  connect(
      &session_.jobs(), &JobRunner::finished, this,
      [this, path] {
        save();
        if (QFile::exists(path_)) { // else it could not be opened: it may be tried again
          discard(path);
        }
      },
      Qt::SingleShotConnection);
  session_.recover(path.toStdString());
}

void Recovery::discard(const QString& path) {
  QFile::remove(path);
  QFile::remove(lock_of(path));
}

} // namespace cagewright::app
