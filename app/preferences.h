/// \file
/// What the user prefers, kept between runs.
#pragma once

#include <QDialog>
#include <QString>
#include <QStringList>

namespace cagewright::app {

struct Preferences {
  QString theme = "light";   ///< "light" or "dark"
  int autosave_seconds = 60; ///< 0: never
  bool ask_before_closing = true;
  bool z_up = false;               ///< models stand upright along z, not y
  bool coarse_while_moving = true; ///< large models, where drawing them is slow
  QString key_map = "blender";     ///< see key_map.h
  bool wheel_reversed = false;
  bool hints = true; ///< the bar with the next step

  static Preferences load();
  void save() const;
};

/// The files opened last, the newest first; those that are gone are left out.
QStringList recent_files();
void add_recent_file(const QString& path);
void clear_recent_files();

class PreferencesDialog final : public QDialog {
  Q_OBJECT

public:
  explicit PreferencesDialog(const Preferences& preferences, QWidget* parent = nullptr);
  [[nodiscard]] const Preferences& preferences() const { return preferences_; }

private:
  Preferences preferences_;
};

} // namespace cagewright::app
