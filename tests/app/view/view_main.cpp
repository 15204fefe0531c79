// Tests in a window.
#include "keep_libraries.h"
#include "mouse.h"

#include <QApplication>
#include <QDir>
#include <QStandardPaths>

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QStandardPaths::setTestModeEnabled(true);
  QApplication application(argc, argv);
  QDir().mkpath(CAGEWRIGHT_SCREENSHOTS);
  cagewright::app::test::park_cursor();
  return RUN_ALL_TESTS();
}
