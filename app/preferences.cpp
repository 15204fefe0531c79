#include "app/preferences.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFileInfo>
#include <QFormLayout>
#include <QSettings>
#include <QSpinBox>

#include <algorithm>

namespace cagewright::app {
namespace {

constexpr int most_recent = 10;

} // namespace

Preferences Preferences::load() {
  const QSettings settings;
  Preferences p;
  p.theme = settings.value("theme", p.theme).toString();
  p.autosave_seconds =
      std::clamp(settings.value("autosave_seconds", p.autosave_seconds).toInt(), 0, 3600);
  p.ask_before_closing = settings.value("ask_before_closing", p.ask_before_closing).toBool();
  p.z_up = settings.value("z_up", p.z_up).toBool();
  p.coarse_while_moving = settings.value("coarse_while_moving", p.coarse_while_moving).toBool();
  p.key_map = settings.value("key_map", p.key_map).toString();
  p.wheel_reversed = settings.value("wheel_reversed", p.wheel_reversed).toBool();
  p.hints = settings.value("hints", p.hints).toBool();
  return p;
}

void Preferences::save() const {
  QSettings settings;
  settings.setValue("theme", theme);
  settings.setValue("autosave_seconds", autosave_seconds);
  settings.setValue("ask_before_closing", ask_before_closing);
  settings.setValue("z_up", z_up);
  settings.setValue("coarse_while_moving", coarse_while_moving);
  settings.setValue("key_map", key_map);
  settings.setValue("wheel_reversed", wheel_reversed);
  settings.setValue("hints", hints);
}

QStringList recent_files() {
  QStringList files = QSettings().value("recent_files").toStringList();
  files.removeIf([](const QString& file) { return !QFileInfo::exists(file); });
  return files;
}

void add_recent_file(const QString& path) {
  const QString absolute = QFileInfo(path).absoluteFilePath();
  QStringList files = recent_files();
  files.removeAll(absolute);
  files.prepend(absolute);
  QSettings().setValue("recent_files", files.mid(0, most_recent));
}

void clear_recent_files() {
  QSettings().remove("recent_files");
}

PreferencesDialog::PreferencesDialog(const Preferences& preferences, QWidget* parent)
    : QDialog(parent), preferences_(preferences) {
  setWindowTitle(tr("Preferences"));
  auto* form = new QFormLayout(this);
  auto* theme = new QComboBox;
  theme->setObjectName("theme");
  theme->addItem(tr("Light"), "light");
  theme->addItem(tr("Dark"), "dark");
  theme->setCurrentIndex(theme->findData(preferences_.theme));
  form->addRow(tr("Colors"), theme);
  auto* up = new QComboBox;
  up->setObjectName("up_axis");
  up->addItems({tr("Y, as in most programs"), tr("Z, as in Blender and CAD")});
  up->setCurrentIndex(preferences_.z_up ? 1 : 0);
  up->setToolTip(tr("How models stand in the view. Files are written as they were read"));
  form->addRow(tr("Up"), up);
  auto* keys = new QComboBox;
  keys->setObjectName("key_map");
  keys->addItem(tr("As in Blender"), "blender");
  keys->addItem(tr("As in Maya"), "maya");
  keys->addItem(tr("Three buttons: turn, pan, zoom"), "three_button");
  keys->setCurrentIndex(std::max(0, keys->findData(preferences_.key_map)));
  keys->setToolTip(tr("Which buttons and keys do what; Help, Keys and Mouse has them all"));
  form->addRow(tr("Keys and mouse"), keys);
  auto* wheel = new QComboBox;
  wheel->setObjectName("wheel");
  wheel->addItems({tr("Forward: nearer"), tr("Forward: farther")});
  wheel->setCurrentIndex(preferences_.wheel_reversed ? 1 : 0);
  form->addRow(tr("Wheel"), wheel);
  auto* autosave = new QSpinBox;
  autosave->setRange(0, 3600);
  autosave->setSuffix(tr(" s"));
  autosave->setSpecialValueText(tr("never"));
  autosave->setValue(preferences_.autosave_seconds);
  autosave->setToolTip(tr("How often work is kept aside, to be recovered after a crash"));
  form->addRow(tr("Keep work aside every"), autosave);
  auto* ask = new QCheckBox(tr("Ask about unsaved work before closing"));
  ask->setChecked(preferences_.ask_before_closing);
  form->addRow(ask);
  auto* hints = new QCheckBox(tr("Show what to do next"));
  hints->setChecked(preferences_.hints);
  form->addRow(hints);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  form->addRow(buttons);
  connect(theme, &QComboBox::currentIndexChanged, this,
          [this, theme] { preferences_.theme = theme->currentData().toString(); });
  connect(up, &QComboBox::currentIndexChanged, this,
          [this](int at) { preferences_.z_up = at == 1; });
  connect(keys, &QComboBox::currentIndexChanged, this,
          [this, keys] { preferences_.key_map = keys->currentData().toString(); });
  connect(wheel, &QComboBox::currentIndexChanged, this,
          [this](int at) { preferences_.wheel_reversed = at == 1; });
  connect(autosave, &QSpinBox::valueChanged, this,
          [this](int value) { preferences_.autosave_seconds = value; });
  connect(ask, &QCheckBox::toggled, this,
          [this](bool on) { preferences_.ask_before_closing = on; });
  connect(hints, &QCheckBox::toggled, this, [this](bool on) { preferences_.hints = on; });
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
}

} // namespace cagewright::app
