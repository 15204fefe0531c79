/// \file
/// Where a closed surface is made: on the whole model, or on one side of a mirror plane. What is
/// done there is the same for both. Internal to this module.
#pragma once

#include "cage/engine_runs.h"
#include "cage/start.h"
#include "improve/cage_extent.h"
#include "improve/guard.h"
#include "improve/improve.h"
#include "spatial/bvh.h"
#include "symmetry/half.h"
#include "validate/greatest_gap.h"
#include <cagewright/cage/generated_cage.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/validate/webbing.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace cagewright {

/// Coordinates, what has to be enclosed there, and how what is made there becomes a whole cage. Of
/// a half the coordinates are those in which the mirror plane is x = 0.
class Ground {
public:
  /// The whole model, or with a plane one side of it. All that is referred to must live as long as
  /// the ground.
  Ground(TriangleView model, const GenerateOptions& options,
         const std::optional<MirrorPlane>& plane, EngineRuns& runs);
  Ground(const Ground&) = delete;
  Ground& operator=(const Ground&) = delete;
  virtual ~Ground() = default;

  [[nodiscard]] bool is_half() const { return frame_.has_value(); }
  [[nodiscard]] CageExtent extent() const {
    return is_half() ? CageExtent::half : CageExtent::whole;
  }
  [[nodiscard]] const MirrorFrame& frame() const { return *frame_; }

  /// The model in its own coordinates, and in those of the ground.
  [[nodiscard]] TriangleView model() const { return model_; }
  [[nodiscard]] TriangleView model_here() const { return is_half() ? TriangleView(here_) : model_; }
  /// What is to be enclosed here: the model, or what half a cage must enclose.
  [[nodiscard]] TriangleView enclosed() const {
    return is_half() ? TriangleView(half_.mesh) : model_;
  }
  /// Of what is to be enclosed.
  [[nodiscard]] const ModelSurface& surface() const;
  /// The joints of the options, in the coordinates of the ground.
  [[nodiscard]] std::vector<LimbJoint> joints_here() const;
  /// The space between the model's limbs, in the ground's coordinates.
  [[nodiscard]] const SpaceBetween& between() const;
  /// Of a half what of it lies on its side.
  [[nodiscard]] const SpaceBetween& between_on_side() const;
  /// Of the model: what all lengths are fractions of.
  [[nodiscard]] double diagonal() const { return diagonal_; }

  /// Runs the engine, and counts that.
  [[nodiscard]] Result<Improved> improved(TriangleView start, const ImproveOptions& budget,
                                          const Progress& progress) const;
  /// The same for a draft: round all of the model here, to see what a start is worth.
  [[nodiscard]] Result<Improved> drafted(TriangleView start, const ImproveOptions& budget,
                                         const Progress& progress) const;
  [[nodiscard]] const EngineRuns& runs() const { return runs_; }

  /// What is asked of the improvement here. The density lives as long as the ground.
  [[nodiscard]] ImproveOptions budget(double clearance) const;
  /// As many vertices and faces as the whole has.
  [[nodiscard]] std::size_t vertices_of(std::span<const Vec3> positions) const {
    return whole_vertices(positions, extent());
  }
  [[nodiscard]] std::size_t faces_of(std::size_t faces) const {
    return (is_half() ? 2 : 1) * faces;
  }

  /// The whole cage of what was made here, in the model's coordinates.
  struct WholeCage {
    PolygonMesh faces;
    std::optional<MirrorPairing> mirror;
  };
  [[nodiscard]] WholeCage whole(const PolygonMesh& made) const;
  [[nodiscard]] TriangleMesh whole(const TriangleMesh& made) const;
  /// What was made here, and of a half its mirror image beside it: in the coordinates of the
  /// ground, not joined.
  [[nodiscard]] TriangleMesh with_image(TriangleMesh made) const;

  /// Bounds the distance from the whole cage to the model: what counts is the model alone, also of
  /// half a cage, which encloses the model and its mirror image. To within `tolerance`, both in the
  /// model's units; of quads along any diagonals.
  [[nodiscard]] virtual GreatestGap gap_of(const TriangleMesh& made, double tolerance) const;
  [[nodiscard]] virtual double gap_of(const PolygonMesh& made, double tolerance) const;

private:
  const TriangleBvh& hierarchy() const;
  const ModelSurface& surface_here() const;

  TriangleView model_;
  const GenerateOptions& options_;
  EngineRuns& runs_;
  double diagonal_ = 0;
  std::optional<MirrorFrame> frame_;
  TriangleMesh here_; // the model in the frame, if there is one
  HalfModel half_;
  std::vector<double> density_of_half_;
  // Made when they are first asked for.
  mutable std::unique_ptr<const TriangleBvh> hierarchy_;
  mutable std::unique_ptr<const ModelSurface> surface_;
  mutable std::unique_ptr<const ModelSurface> surface_here_;
  mutable std::unique_ptr<const SpaceBetween> between_;
  mutable std::unique_ptr<const SpaceBetween> between_on_side_;
};

} // namespace cagewright
