// Tests of the whole window.
#include "app/application.h"
#include "keep_libraries.h"
#include "mouse.h"

#include <QDir>
#include <QSettings>
#include <QStandardPaths>
#include <QSurfaceFormat>
#include <QTemporaryDir>

#include <gtest/gtest.h>

#include <cstdio>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  QSurfaceFormat format;
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);
  QApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  cagewright::app::Application application(argc, argv);
  if (QGuiApplication::platformName() == "offscreen") { // it ends badly with OpenGL in a window
    std::puts("these tests need a display: run them with xvfb-run");
    return 1;
  }
  QCoreApplication::setOrganizationName("Cagewright");
  QCoreApplication::setApplicationName("CagewrightTest");
  const QTemporaryDir settings; // nobody's own settings are touched
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, settings.path());
  QDir().mkpath(CAGEWRIGHT_SCREENSHOTS);
  cagewright::app::test::park_cursor();
  return RUN_ALL_TESTS();
}
