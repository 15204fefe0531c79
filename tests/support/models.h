/// \file
/// Real models, where there are any: in the directory named by the environment variable
/// CAGEWRIGHT_MODELS.
#pragma once

#include "io/read_mesh.h"
#include "mesh/triangulate.h"

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>

namespace cagewright::test {

/// The first of the files that exists, as triangles; nothing if none does.
inline std::optional<TriangleMesh> real_model(std::initializer_list<std::string> names) {
  const char* directory = std::getenv("CAGEWRIGHT_MODELS");
  for (const std::string& name : names) {
    const std::filesystem::path path = std::filesystem::path(directory ? directory : "") / name;
    if (directory && std::filesystem::exists(path)) {
      if (const Result<PolygonMesh> mesh = read_mesh(path)) {
        return to_triangle_mesh(*mesh);
      }
    }
  }
  return std::nullopt;
}

} // namespace cagewright::test
