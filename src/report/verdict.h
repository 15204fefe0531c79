/// \file
/// The verdict on a cage, for programs.
#pragma once

#include "report/cage_words.h"
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/validate/validate_cage.h>

#include <nlohmann/json.hpp>

#include <span>

namespace cagewright {

/// Whether it is valid, counts of all kinds of violations, and those that are listed, each with its
/// elements, place, file, message and remedy.
nlohmann::json json_of(const ValidityReport& report, const JudgedFiles& files);

/// Triangles of the model were judged; the user knows its faces.
/// \param face_of  for each triangle the face it was cut from; none: they are the faces
void name_model_faces(ValidityReport& report, std::span<const Index> face_of);

/// The same for vertices of the model, where a part of it was judged.
void name_model_vertices(ValidityReport& report, std::span<const Index> vertex_of);

} // namespace cagewright
