#include "app/samples.h"

#include <QDir>
#include <QFile>
#include <QStandardPaths>
#include <QString>

namespace cagewright::app {
namespace {

Result<std::filesystem::path> unpacked(const QString& name, const QDir& folder) {
  QFile packed(":/samples/" + name);
  packed.open(QIODevice::ReadOnly); // of the program itself
  const QByteArray content = packed.readAll();
  QFile file(folder.filePath(name));
  if (file.open(QIODevice::ReadOnly) && file.readAll() == content) {
    return std::filesystem::path(file.fileName().toStdString());
  }
  file.close();
  if (!folder.mkpath(".") || !file.open(QIODevice::WriteOnly) || file.write(content) < 0 ||
      !file.flush()) {
    return Error{ErrorCode::cannot_write,
                 file.fileName().toStdString() +
                     ": cannot write the file: " + file.errorString().toStdString()};
  }
  return std::filesystem::path(file.fileName().toStdString());
}

} // namespace

Result<SampleFiles> sample_files(const std::filesystem::path& folder) {
  const QDir place(QString::fromStdString(folder.string()));
  const Result<std::filesystem::path> model = unpacked("creature.obj", place);
  if (!model) {
    return model.error();
  }
  const Result<std::filesystem::path> cage = unpacked("creature-cage.obj", place);
  if (!cage) {
    return cage.error();
  }
  return SampleFiles{*model, *cage};
}

Result<SampleFiles> sample_files() {
  const QString folder = QStandardPaths::writableLocation(QStandardPaths::AppDataLocation);
  return sample_files((folder + "/samples").toStdString());
}

} // namespace cagewright::app
