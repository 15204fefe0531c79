/// \file
/// Normals that follow a moving mesh, with its hard edges and seams.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace cagewright {

/// How much a face counts for the normals at its corners.
enum class NormalWeighting {
  area,  ///< by its area: quick, no trigonometry
  angle, ///< by the angle at the corner: does not depend on how the surface is cut into faces
};

/// Which corners share a normal. Corners of one vertex that do not share theirs meet in a hard
/// edge; where they do but a file lists them apart (a UV seam), they stay alike.
struct NormalSlots {
  static constexpr Index none = std::numeric_limits<Index>::max();

  std::vector<Index> of_corner; ///< for each corner of the mesh, in order, its slot < count, or
                                ///< `none`
  std::size_t count = 0;        ///< K
  std::vector<Vec3> given;      ///< K unit normals at rest, or none to compute them
};

/// One slot for each vertex: smooth everywhere.
NormalSlots smooth_normals(const PolygonMesh& mesh);

/// Keeps the normals of a mesh whose vertices move.
///
/// A normal is the weighted mean of the normals of the faces whose corners share its slot. Where
/// normals are given with the mesh, each follows the rotation of that mean from the rest: normals
/// painted or transferred by an artist keep their deviation.
class NormalField {
public:
  NormalField() = default;
  /// \param mesh  the mesh at rest
  NormalField(const PolygonMesh& mesh, NormalSlots slots,
              NormalWeighting weighting = NormalWeighting::area);

  /// Brings the normals up to date where vertices have moved. `positions` are V positions;
  /// moved_tiles tells for each 16 vertices whether any of them moved since the last call; empty
  /// means that all did. No memory is taken. Cost: O(faces at moved vertices), and a look at all
  /// tiles.
  void update(std::span<const Vec3> positions, std::span<const std::uint8_t> moved_tiles = {});

  /// K unit normals, or zero where all faces of a slot are degenerate.
  [[nodiscard]] std::span<const Vec3> normals() const { return normals_; }
  [[nodiscard]] const NormalSlots& slots() const { return slots_; }

private:
  void list_faces_of_tiles();
  void find_changed(std::span<const std::uint8_t> moved_tiles);
  void update_face(std::size_t face, std::span<const Vec3> positions);
  void update_slot(std::size_t slot, std::span<const Vec3> positions);
  [[nodiscard]] Vec3 mean_normal(std::size_t slot, std::span<const Vec3> positions) const;

  std::vector<Index> corners_;           // of all faces, one after the other
  std::vector<std::size_t> face_begins_; // F + 1 offsets into corners_
  std::vector<Index> slot_corners_;      // positions in corners_, slot after slot
  std::vector<std::size_t> slot_begins_; // K + 1 offsets into slot_corners_
  std::vector<Index> face_of_corner_;
  std::vector<Vec3> face_normals_; // F: length twice the area, or 1 for angle weights
  std::vector<Index> tile_faces_;  // faces with a corner in a tile of vertices, tile after tile
  std::vector<std::size_t> tile_begins_;
  // Room for update(): which faces and slots change, as lists and as flags.
  std::vector<Index> changed_faces_, changed_slots_;
  std::vector<std::uint8_t> face_changes_, slot_changes_;
  std::vector<Vec3> rest_means_; // K, when normals are given
  std::vector<Vec3> normals_;
  NormalSlots slots_;
  NormalWeighting weighting_ = NormalWeighting::area;
};

} // namespace cagewright
