/// \file
/// The invariant of the improvement: valid before, valid after every step.
#pragma once

#include "improve/cage_mesh.h"
#include "spatial/surface_tree.h"

#include <vector>

namespace cagewright {

/// The boxes of a cage's faces, kept beside it, to find the faces near a place.
///
/// A flat array of floats: for the few thousand faces of a cage, a scan of all of them beats
/// every hierarchy that must be kept up to date.
class FaceBoxes {
public:
  explicit FaceBoxes(const CageMesh& cage);

  /// Call after each change, with the numbers of the faces that changed, came or went.
  void update(const CageMesh& cage, Index face);

  /// Appends the faces whose boxes meet the box, in rising order.
  void find(const Box3& box, std::vector<Index>& found) const;

private:
  Vec3 origin_; // floats are taken relative to it, so that distant models keep their precision
  std::vector<float> low_[3];
  std::vector<float> high_[3];
};

/// What the improvement knows about the model: made once for all that is made round it.
struct ModelSurface {
  /// \param unit  the length that others are fractions of; 0: the diagonal of the model's box
  /// Cost: O(T log T); some 0.3 s for 350,000 triangles.
  explicit ModelSurface(TriangleView model, double unit = 0);

  /// The model with a triangle without extent for every vertex that no triangle uses: it must be
  /// inside the cage too.
  TriangleMesh mesh;
  SurfaceTree tree;
  double diagonal = 0;
  Box3 box;
  /// A connected part of the model: a face of the cage that keeps clear of the model has either
  /// all of it on one side or all on the other.
  struct Part {
    Box3 box;
    Vec3 point; ///< one of its own
  };
  std::vector<Part> parts;
};

/// How far vertices of a half that are not on its plane keep from it, in clearances.
inline constexpr double plane_gap = 0.5;

/// Decides whether a change leaves the cage valid.
class Guard {
public:
  /// \param clearance least distance from every face of the cage to the model, in its units, > 0
  Guard(const ModelSurface& model, double clearance) : model_(&model), clearance_(clearance) {}

  [[nodiscard]] const ModelSurface& model() const { return *model_; }
  [[nodiscard]] double clearance() const { return clearance_; }

  /// The place where the patch's new faces come too near to the model, if there is one. Depends on
  /// the new faces alone, not on the rest of the cage.
  [[nodiscard]] std::optional<ClosestPoints> too_near(const CageMesh& cage,
                                                      const Patch& patch) const;

  /// True when the patch's new faces cross each other or other faces of the cage: by exact
  /// predicates. Goes stale when any other part of the cage changes.
  [[nodiscard]] bool crosses(const CageMesh& cage, const FaceBoxes& boxes,
                             const Patch& patch) const;

  /// True when some part of the model lies between the patch's old faces and its new ones: it was
  /// inside the cage and would be outside.
  [[nodiscard]] bool loses_a_part(const CageMesh& cage, const Patch& patch) const;

private:
  const ModelSurface* model_;
  double clearance_;
};

/// The corners of a face of the patch, the moved vertex at its new position.
Corners corners_after(const CageMesh& cage, const Patch& patch, const Triangle& t);

/// True when two faces have a point in common beyond the corners they share by index. Corners that
/// are not shared must differ in index, shared ones agree in position.
bool faces_cross(const Triangle& s, const Corners& at_s, const Triangle& t, const Corners& at_t);

/// See mesh/solid_angle.h.
double solid_angle(const Vec3& p, const Corners& t);

/// The same for a face of the cage, together with its mirror image if the cage is a half.
double solid_angle(const CageMesh& cage, const Vec3& p, const Corners& t);

} // namespace cagewright
