/// \file
/// Work that survives a crash.
#pragma once

#include "app/session.h"

#include <QDir>
#include <QLockFile>
#include <QObject>
#include <QTimer>

#include <memory>
#include <vector>

namespace cagewright::app {

/// Saves the session beside its project now and then, in a folder of the application. A file whose
/// program no longer runs is work to recover.
class Recovery final : public QObject {
  Q_OBJECT

public:
  /// \param folder  where the files are; made if need be
  Recovery(Session& session, const QDir& folder, QObject* parent = nullptr);
  ~Recovery() override; ///< the program ends as it should: its own file goes

  /// 0: never.
  void set_interval(int seconds);
  /// Saves now, if there is anything unsaved.
  void save();

  /// Files that programs left which are no longer running, the newest first.
  [[nodiscard]] std::vector<QString> abandoned() const;
  /// The path of the project that the work belongs to, and the name of the model: for people.
  static QString subject_of(const QString& path);
  /// Goes on with it; the file goes as soon as the work is kept as this program's own.
  void recover(const QString& path);
  static void discard(const QString& path);

private:
  Session& session_;
  QDir folder_;
  QString path_;
  std::unique_ptr<QLockFile> lock_;
  QTimer timer_;
  int saved_step_ = -1; // of the undo stack
};

} // namespace cagewright::app
