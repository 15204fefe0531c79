/// \file
/// Real models, where there are any: in the directory named by the environment variable
/// CAGEWRIGHT_MODELS.
#pragma once

#include <cagewright/io/read_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

namespace cagewright::test {

/// The first of the files that exists, as it stands in the file; nothing if none does.
inline std::optional<PolygonMesh> real_polygons(std::initializer_list<std::string> names) {
  const char* directory = std::getenv("CAGEWRIGHT_MODELS");
  for (const std::string& name : names) {
    const std::filesystem::path path = std::filesystem::path(directory ? directory : "") / name;
    if (directory && std::filesystem::exists(path)) {
      if (Result<PolygonMesh> mesh = read_mesh(path)) {
        return std::move(*mesh);
      }
    }
  }
  return std::nullopt;
}

/// The same as triangles.
inline std::optional<TriangleMesh> real_model(std::initializer_list<std::string> names) {
  const std::optional<PolygonMesh> mesh = real_polygons(names);
  return mesh ? std::optional(to_triangle_mesh(*mesh)) : std::nullopt;
}

} // namespace cagewright::test
