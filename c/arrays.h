/// \file
/// Arrays of callers as the library takes them: where they are, if they are packed doubles and
/// 32-bit indices; else copied.
#pragma once

#include <cagewright/c/cagewright.h>

#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cagewright::c {

/// Positions in the caller's memory, or in ours.
class Points {
public:
  Points() = default;
  Points(Points&&) = default;
  Points& operator=(Points&&) = default;

  /// \param what  what they are, for messages: "the model's positions"
  /// Errors: malformed (not of three columns).
  static Result<Points> of(const cw_array& array, const std::string& what);

  [[nodiscard]] std::span<const Vec3> view() const { return view_; }

private:
  std::vector<Vec3> own_; // its buffer stays where it is when Points moves
  std::span<const Vec3> view_;
};

/// Numbers of one column. Errors: malformed.
Result<std::vector<double>> numbers_of(const cw_array& array, const std::string& what);

/// Indices of one column, each below `count`. Errors: malformed.
Result<std::vector<Index>> indices_of(const cw_array& array, std::size_t count,
                                      const std::string& what);

/// A mesh of the caller's, in the form that a function of the library asks for.
class MeshArgument {
public:
  MeshArgument() = default;
  MeshArgument(MeshArgument&&) = default;
  MeshArgument& operator=(MeshArgument&&) = default;

  /// \param name  "the model", "the cage"
  /// Errors: malformed, with the row of the fault; too_large.
  static Result<MeshArgument> of(const cw_mesh_view* view, const std::string& name);

  /// What triangulate() makes of the faces, without a copy where that can be.
  [[nodiscard]] TriangleView triangles() const { return {positions_.view(), triangles_}; }

  /// Faces as they were given.
  [[nodiscard]] PolygonMesh polygons() const;

  /// The same where they are not triangles; null if they are.
  [[nodiscard]] const PolygonMesh* if_polygons() const { return polygons_ ? &*polygons_ : nullptr; }

  /// For each of the triangles the face it was cut from; none: they are the faces.
  [[nodiscard]] std::span<const Index> face_of() const { return face_of_; }

private:
  static Result<MeshArgument> with_triangles(MeshArgument mesh, const cw_array& faces,
                                             const std::string& name);

  Points positions_;
  std::optional<PolygonMesh> polygons_; // none: the faces are the triangles
  std::vector<Triangle> own_;
  std::vector<Index> face_of_;
  std::span<const Triangle> triangles_;
};

/// The two that most functions are about.
struct ModelAndCage {
  MeshArgument model;
  MeshArgument cage;

  /// Errors: those of MeshArgument::of().
  static Result<ModelAndCage> of(const cw_mesh_view* model, const cw_mesh_view* cage);
};

} // namespace cagewright::c
