/// \file
/// Small glTF files, put together from parts.
#pragma once

#include "io/files.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cagewright::test {

/// Collects accessors, each in a buffer view of its own, and the JSON of the rest.
class GltfBuilder {
public:
  std::string scenes = R"([{"nodes":[0]}])";
  std::string nodes = R"([{"mesh":0}])";
  std::string meshes;
  std::string more; ///< further members of the file, each after a comma

  /// An accessor of floats; its number.
  std::size_t floats(const std::string& type, const std::vector<float>& values) {
    return add(type, 5126, values, components(type));
  }
  /// An accessor of integers of the type that glTF's number names.
  template <class Integer>
  std::size_t integers(const std::string& type, int component, const std::vector<Integer>& values,
                       const std::string& further = "") {
    return add(type, component, values, components(type), further);
  }
  /// An accessor as it stands in the JSON.
  std::size_t accessor(const std::string& json) {
    accessors_ += (accessors_.empty() ? "" : ",") + json;
    return count_++;
  }
  /// A buffer view of the bytes; its number.
  std::size_t view(const std::string& bytes, const std::string& further = "") {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    views_ += (views_.empty() ? "" : ",") +
              (R"({"buffer":0,"byteOffset":)" + std::to_string(bytes_.size()) +
               R"(,"byteLength":)" + std::to_string(bytes.size()) + further + "}");
    bytes_ += bytes;
    return view_count_++;
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::string json(const std::string& uri = "") const {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":)" + scenes + R"(,"nodes":)" + nodes +
           R"(,"meshes":)" + meshes + R"(,"accessors":[)" + accessors_ + R"(],"bufferViews":[)" +
           views_ + R"(],"buffers":[{)" + uri + R"("byteLength":)" + std::to_string(bytes_.size()) +
           "}]" + more + "}";
  }
  [[nodiscard]] std::string glb() const { return make_glb(json(), bytes_); }

private:
  static std::size_t components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
  }

  // Elements are padded to multiples of four bytes, as glTF asks of vertices.
  template <class Number>
  std::size_t add(const std::string& type, int component, const std::vector<Number>& values,
                  std::size_t per_element, const std::string& further = "") {
    std::string bytes;
    const std::size_t size = per_element * sizeof(Number);
    const std::size_t stride = per_element == 1 ? size : (size + 3) / 4 * 4;
    for (std::size_t i = 0; i < values.size(); ++i) {
      bytes += binary(values[i]);
      bytes.resize(bytes.size() + ((i + 1) % per_element == 0 ? stride - size : 0));
    }
    const bool pads = stride != size;
    const std::size_t index =
        view(bytes, pads ? R"(,"byteStride":)" + std::to_string(stride) : std::string());
    return accessor(R"({"bufferView":)" + std::to_string(index) + R"(,"componentType":)" +
                    std::to_string(component) + R"(,"count":)" +
                    std::to_string(values.size() / per_element) + R"(,"type":")" + type + '"' +
                    further + "}");
  }

  std::string bytes_;
  std::string views_;
  std::string accessors_;
  std::size_t count_ = 0;
  std::size_t view_count_ = 0;
};

} // namespace cagewright::test
