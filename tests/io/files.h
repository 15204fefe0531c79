/// \file
/// Files for the tests of readers and writers: folders that vanish, and small valid files.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright::test {

/// A new folder that is removed with all it holds.
class TemporaryFolder {
public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const {
    return path_ / name;
  }

  /// Writes a file in the folder.
  std::filesystem::path add(std::string_view name, std::string_view bytes) const;

  /// Names of what the folder holds, sorted.
  [[nodiscard]] std::vector<std::string> names() const;

private:
  std::filesystem::path path_;
};

std::string bytes_of(const std::filesystem::path& path);

/// The bytes of the numbers, lowest first, one after the other.
template <class... Numbers> std::string binary(Numbers... numbers);

/// A small valid file of every kind that can be read.
struct Sample {
  std::string name;
  MeshFormat format;
  std::string bytes;
};
std::vector<Sample> samples();

inline void PrintTo(const Sample& sample, std::ostream* out) {
  *out << sample.name;
}

/// A GLB file of the JSON and the binary chunk, padded as the format asks.
std::string make_glb(std::string json, std::string binary);

/// Reads from memory under the name "file".
Result<PolygonMesh> read(std::string_view bytes, MeshFormat format);

/// The message of the error of reading, or "read" where there is none.
std::string message_of(std::string_view bytes, MeshFormat format);

/// Faces as lists, easy to compare and to print.
std::vector<std::vector<Index>> faces_of(const PolygonMesh& mesh);

template <class... Numbers> std::string binary(Numbers... numbers) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&numbers), sizeof numbers), ...); // little endian
  return bytes;
}

} // namespace cagewright::test
