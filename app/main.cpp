#include "app/application.h"
#include "app/main_window.h"
#include <cagewright/version.h>

#include <QCommandLineParser>
#include <QStandardPaths>
#include <QSurfaceFormat>
#include <QTimer>

int main(int argc, char** argv) {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 3);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setDepthBufferSize(24);
  QSurfaceFormat::setDefaultFormat(format);

  cagewright::app::Application application(argc, argv);
  QCoreApplication::setOrganizationName("Cagewright");
  QCoreApplication::setApplicationName("Cagewright");
  QCoreApplication::setApplicationVersion(CAGEWRIGHT_VERSION);
  QGuiApplication::setDesktopFileName("org.cagewright.Cagewright"); // whose icon the window has

  QCommandLineParser parser;
  parser.setApplicationDescription(
      "Builds a cage round a 3D model and deforms the model with it, in a window.");
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument("MODEL", "An OBJ, PLY, STL, OFF or glTF file, or a project",
                               "[MODEL [CAGE]]");
  parser.process(application);
  const QStringList files = parser.positionalArguments();
  if (files.size() > 2) {
    parser.showHelp(2);
  }

  cagewright::app::MainWindow window(
      QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/autosave");
  window.show();
  QTimer::singleShot(0, &window, [&] {
    if (!files.isEmpty()) {
      window.open(files[0], files.value(1));
    } else {
      window.offer_recovery();
    }
  });
  return QApplication::exec();
}
