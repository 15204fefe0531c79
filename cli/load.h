/// \file
/// Models from the command line's paths.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <vector>

namespace cagewright::cli {

/// Says on stderr what was noted while a file was read or written, a line for each, and keeps it
/// for
/// --json. That something was lost is a warning.
void tell(std::span<const FileNote> notes);

/// All that tell() has said in this run: an array of objects with a code and a message.
nlohmann::json notes_as_json();

/// Reads a model, and tells what was noted.
Result<ModelFile> load_model(const std::string& path, Pose pose = Pose::shown);

/// The mesh alone.
Result<PolygonMesh> load_mesh(const std::string& path, Pose pose = Pose::shown);

/// The error, with the file it is about in front of the message.
Error in_file(const std::string& path, Error error);

/// Whether a file of that name can be written, asked before minutes are spent on making it, and is
/// none of those that the command reads: they would be lost. "-" and devices may always be written.
Status can_write_output(const std::string& path, const std::vector<std::string>& inputs);

/// The same for a model: its extension is that of a format.
Status can_write_model(const std::string& path, const std::vector<std::string>& inputs = {});

/// The same for a cage, which must stay valid to the last digit: that of a format with doubles.
Status can_write_cage(const std::string& path, const std::vector<std::string>& inputs = {});

/// Says which files beside the model (images, material libraries) the written one refers to in
/// vain, as it is in another folder.
void warn_of_links(const ModelFile& model, const std::string& written);

} // namespace cagewright::cli
