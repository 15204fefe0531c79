#include "cage/ground.h"

#include "cage/quad_cuts.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <utility>

namespace cagewright {

Ground::Ground(TriangleView model, const GenerateOptions& options,
               const std::optional<MirrorPlane>& plane, EngineRuns& runs)
    : model_(model), options_(options), runs_(runs),
      diagonal_(cagewright::diagonal(model.positions)) {
  if (!plane) {
    return;
  }
  frame_.emplace(*plane, bounding_box(model.positions));
  here_ = in_frame(model, *frame_);
  half_ = half_model(model, *frame_);
  if (!options.density.empty()) {
    for (const Index v : half_.vertices) {
      density_of_half_.push_back(options.density[v]);
    }
  }
}

std::vector<LimbJoint> Ground::joints_here() const {
  std::vector<LimbJoint> joints(options_.joints.begin(), options_.joints.end());
  for (LimbJoint& joint : joints) {
    if (is_half()) {
      const Vec3 end = frame_->to_frame(joint.position + joint.along);
      joint.position = frame_->to_frame(joint.position);
      joint.along = end - joint.position;
      if (joint.position.x() < 0) { // the half is at x > 0
        joint.position.x() *= -1;
        joint.along.x() *= -1;
      }
    }
  }
  return joints;
}

const ModelSurface& Ground::surface() const {
  if (!surface_) {
    surface_ = std::make_unique<const ModelSurface>(enclosed(), diagonal_);
  }
  return *surface_;
}

const ModelSurface& Ground::surface_here() const {
  if (!is_half()) {
    return surface();
  }
  if (!surface_here_) {
    surface_here_ = std::make_unique<const ModelSurface>(here_, diagonal_);
  }
  return *surface_here_;
}

const SpaceBetween& Ground::between() const {
  if (!between_) {
    between_ = std::make_unique<const SpaceBetween>(model_here());
  }
  return *between_;
}

const SpaceBetween& Ground::between_on_side() const {
  if (!is_half()) {
    return between();
  }
  if (!between_on_side_) {
    between_on_side_ = std::make_unique<const SpaceBetween>(between().right_half());
  }
  return *between_on_side_;
}

Result<Improved> Ground::improved(TriangleView start, const ImproveOptions& budget,
                                  const Progress& progress) const {
  runs_.use_one();
  return improve(start, surface(), budget, progress);
}

Result<Improved> Ground::drafted(TriangleView start, const ImproveOptions& budget,
                                 const Progress& progress) const {
  runs_.use_one();
  return improve(start, surface_here(), budget, progress);
}

ImproveOptions Ground::budget(double clearance) const {
  ImproveOptions budget;
  budget.vertices = vertex_limit(options_);
  budget.faces = options_.faces;
  budget.rounds = options_.rounds;
  budget.clearance = clearance;
  budget.density = is_half() ? std::span<const double>(density_of_half_) : options_.density;
  budget.extent = extent();
  budget.diagonal = diagonal_;
  return budget;
}

Ground::WholeCage Ground::whole(const PolygonMesh& made) const {
  if (!is_half()) {
    return {made, std::nullopt};
  }
  Whole<PolygonMesh> both = join_halves(made, *frame_);
  return {std::move(both.mesh), std::move(both.pairing)};
}

TriangleMesh Ground::whole(const TriangleMesh& made) const {
  return is_half() ? join_halves(made, *frame_).mesh : made;
}

TriangleMesh Ground::with_image(TriangleMesh made) const {
  if (!is_half()) {
    return made;
  }
  const std::size_t vertices = made.positions.size();
  const std::size_t triangles = made.triangles.size();
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3 p = made.positions[v];
    made.positions.emplace_back(-p.x(), p.y(), p.z());
  }
  const auto image = static_cast<Index>(vertices);
  for (std::size_t f = 0; f < triangles; ++f) {
    const auto [a, b, c] = made.triangles[f];
    made.triangles.push_back({a + image, c + image, b + image});
  }
  return made;
}

const TriangleBvh& Ground::hierarchy() const {
  if (!hierarchy_) {
    hierarchy_ = std::make_unique<const TriangleBvh>(model_);
  }
  return *hierarchy_;
}

GreatestGap Ground::gap_of(const TriangleMesh& made, double tolerance) const {
  return greatest_gap(whole(made), hierarchy(), tolerance);
}

double Ground::gap_of(const PolygonMesh& made, double tolerance) const {
  return greatest_gap_along_any(whole(made).faces, hierarchy(), tolerance);
}

} // namespace cagewright
