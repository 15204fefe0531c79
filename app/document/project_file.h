/// \file
/// Projects as files: all that a session has made, apart from the model itself.
#pragma once

#include "app/document/generate_settings.h"
#include "app/document/layers.h"
#include "app/document/state.h"
#include "app/edit/tool_settings.h"
#include <cagewright/core/result.h>

#include <QByteArray>
#include <QJsonObject>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cagewright::app {

struct Project {
  std::filesystem::path model_path;               ///< absolute; empty: no model
  std::uint64_t model_checksum = 0;               ///< of its positions
  std::vector<std::filesystem::path> more_models; ///< parts of it besides, absolute
  State state;                                    ///< without binding and stages; read: region
  QString region_name;                            ///< read: of the region
  std::vector<Index> region_faces;                ///< and its faces, ascending; none: no region
  bool bound = false;                             ///< the model is to be bound again
  GenerateSettings settings;
  Layers layers;
  ToolSettings tools;
  QJsonObject camera;
  std::optional<double> frame;    ///< where the time line stands; none: at its first
  bool shows_frame = false;       ///< what it has there, and not the edited pose
  std::filesystem::path saved_as; ///< of work kept aside: the project it belongs to; or empty
  std::vector<std::string> notes; ///< what was read was out of range and keeps its default
};

/// The path of the model is kept both absolute and relative to the project, so that both may move
/// together. Numbers read back as the same doubles. The file is complete or not there.
/// Errors: cannot_write.
Status write_project(const Project& project, const std::filesystem::path& path);

/// Every number has a range; one that is missing keeps its default. Out of range, numbers of cage,
/// poses and time line are an error that names them, those of the view keep their default and are
/// noted.
///
/// Errors: cannot_open, malformed (no project, numbers out of range or that do not fit together),
/// unsupported (of a later version).
Result<Project> read_project(const std::filesystem::path& path);

/// The bytes of such a file; `path` is where they are to be, or were read from.
QByteArray format_project(const Project& project, const std::filesystem::path& path);
Result<Project> parse_project(const QByteArray& bytes, const std::filesystem::path& path);

} // namespace cagewright::app
