/// \file
/// A mesh as it stands in a file: faces of any number of sides.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace cagewright {

/// V vertices and F faces of three or more corners each. Vertices keep the order of the file.
class PolygonMesh {
public:
  std::vector<Vec3> positions; ///< V positions, in the file's own coordinates
  std::vector<std::array<float, 4>>
      colors; ///< V colours (red, green, blue, alpha in [0, 1]), or none
  std::vector<std::string>
      group_names;                ///< named parts of the mesh (OBJ objects and groups), or none
  std::vector<Index> face_groups; ///< F indices into group_names, or none

  PolygonMesh() = default;
  explicit PolygonMesh(const TriangleMesh& mesh) : positions(mesh.positions) {
    for (const Triangle& t : mesh.triangles) {
      add_face(t);
    }
  }

  [[nodiscard]] std::size_t face_count() const { return begins_.size() - 1; }

  /// The corners of face f, counter-clockwise from outside; each is < V.
  [[nodiscard]] std::span<const Index> face(std::size_t f) const {
    return std::span(corners_).subspan(begins_[f], begins_[f + 1] - begins_[f]);
  }

  void add_face(std::span<const Index> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    begins_.push_back(corners_.size());
  }
  void add_face(std::initializer_list<Index> corners) {
    add_face(std::span(corners.begin(), corners.size()));
  }

  /// All corners, face after face.
  [[nodiscard]] std::span<const Index> corners() const { return corners_; }

private:
  std::vector<Index> corners_;
  std::vector<std::size_t> begins_ = {0}; // F + 1 offsets into corners_
};

} // namespace cagewright
