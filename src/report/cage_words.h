/// \file
/// What is wrong with a cage, in words: the same for check, bind, deform and compare.
#pragma once

#include <cagewright/io/model_file.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/validate/validate_cage.h>

#include <cstddef>
#include <string>
#include <vector>

namespace cagewright {

/// The files that a verdict is about.
struct JudgedFiles {
  std::string model;
  std::string cage;
};

/// How many of a kind there are and what they are: "4 open edges", "1 open edge".
std::string headline(ViolationKind kind, std::size_t count);

/// One violation with its elements and its place: "edge 3 - 7 at (1, 2, 0.5)".
std::string describe(const Violation& violation);

/// What helps against a kind; with the files, a command that does it where there is one.
std::string remedy(ViolationKind kind, const JudgedFiles& files);

/// Which of the files a kind's elements are counted in.
const std::string& file_of(ViolationKind kind, const JudgedFiles& files);

/// "cage.obj: not a valid cage of this model: 4 open_edge ..."
std::string not_valid_in_words(const ValidityReport& report, const JudgedFiles& files);

/// What a user should know beside the verdict: vertices merged or left out, and a cage that is in
/// another unit, turned, or beside the model, with what would make it fit.
std::vector<FileNote> hints(const ValidityReport& report, const PolygonMesh& cage,
                            TriangleView model, const JudgedFiles& files);

} // namespace cagewright
