/// \file
/// Which part of a model file a command is about, and in which pose.
#pragma once

#include "mesh/mesh_part.h"
#include <cagewright/core/result.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/pose.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <vector>

namespace cagewright::cli {

/// What the options --pose, --only, --ignore-specks and --cage-object say.
struct ModelChoice {
  Pose pose = Pose::shown;
  std::vector<std::string> only;         ///< objects or groups by name; none: the whole model
  std::vector<std::string> cage_objects; ///< of the cage's file; none: all of it
  bool ignore_specks = false;            ///< see find_specks()
};

/// Declares --pose.
void add_pose_option(CLI::App& command, ModelChoice& choice);

/// Declares --only, with what it is for.
void add_only_option(CLI::App& command, ModelChoice& choice, const std::string& purpose);

/// Declares --ignore-specks.
void add_specks_option(CLI::App& command, ModelChoice& choice, const std::string& purpose);

/// Declares --cage-object.
void add_cage_object_option(CLI::App& command, ModelChoice& choice);

/// Whether each of the F faces of the file belongs to an object or group of the names. A name
/// stands for all that have it, NAME#2 for the second of them in the order of the file, unless one
/// is called so. In OBJ an object may have groups: its name stands for all of them.
///
/// \param option  for the message: "--only"
/// Errors: invalid_option (nothing has such a name; the message lists those there are).
Result<std::vector<bool>> faces_named(const ModelFile& file, std::span<const std::string> names,
                                      const std::string& option);

/// Reads a model and takes the chosen part of it.
Result<PolygonMesh> load_chosen(const std::string& path, const ModelChoice& choice);

/// Several models as one, in this order: what one cage is to be made for. The chosen parts of each.
Result<PolygonMesh> load_chosen(const std::vector<std::string>& paths, const ModelChoice& choice);

/// Reads a cage: the objects chosen for it.
Result<PolygonMesh> load_cage(const std::string& path, const ModelChoice& choice);

/// A model and its cage, which may be objects of one file.
struct ModelAndCage {
  ModelFile file;
  MeshPart bound; ///< what the cage is for: the chosen objects; where there are none and the
                  ///< cage is an object of the same file, the others; else all. Without specks,
                  ///< where they are to be ignored
  PolygonMesh cage;

  [[nodiscard]] const PolygonMesh& model() const { return file.mesh(); } ///< all of the file
};
Result<ModelAndCage> load_model_and_cage(const std::string& model, const std::string& cage,
                                         const ModelChoice& choice);

} // namespace cagewright::cli
