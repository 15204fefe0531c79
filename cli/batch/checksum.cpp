#include "batch/checksum.h"

#include "io/uri.h"
#include <cagewright/io/mesh_format.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <vector>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

/// The files in which a .gltf file keeps its numbers.
std::vector<fs::path> buffers_of(const fs::path& model) {
  std::vector<fs::path> files;
  std::ifstream file(model);
  const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) {
    return files; // GLB, or no glTF at all: the reader will say so
  }
  for (const nlohmann::json& buffer : json["buffers"]) {
    if (buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string()) {
      const std::string uri = buffer["uri"];
      if (!is_data_uri(uri)) {
        files.push_back(model.parent_path() / decode_percent(uri));
      }
    }
  }
  return files;
}

} // namespace

void Checksum::add(std::string_view bytes) {
  constexpr std::uint64_t prime = 0x100000001b3ULL;
  for (const char byte : bytes) {
    state_ = (state_ ^ static_cast<unsigned char>(byte)) * prime;
  }
}

bool Checksum::add_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return false;
  }
  constexpr std::size_t some = 1U << 20U;
  std::vector<char> bytes(some);
  std::uint64_t size = 0;
  while (file.read(bytes.data(), some) || file.gcount() > 0) {
    const auto count = static_cast<std::size_t>(file.gcount());
    add({bytes.data(), count});
    size += count;
  }
  add(std::to_string(size));
  return file.eof();
}

std::string Checksum::text() const {
  return fmt::format("{:016x}", state_);
}

std::optional<std::string> checksum_of_model(const fs::path& model) {
  Checksum sum;
  if (!sum.add_file(model)) {
    return std::nullopt;
  }
  if (format_of_name(model) == MeshFormat::gltf) {
    for (const fs::path& buffer : buffers_of(model)) {
      sum.add_file(buffer); // one that is missing is the reader's business
    }
  }
  return sum.text();
}

} // namespace cagewright::cli
