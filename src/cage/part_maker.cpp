#include "cage/part_maker.h"

#include "cage/best_of.h"
#include "cage/budget.h"
#include "cage/part_options.h"
#include "cage/quad_cuts.h"
#include "cage/surface.h"
#include "quads/quads.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr double least_room = 2; // between model and plane, in clearances

/// The rings, and their mirror images.
std::vector<std::vector<Index>> with_images(std::vector<std::vector<Index>> rings,
                                            const MirrorPairing& pairing) {
  const std::size_t count = rings.size();
  for (std::size_t r = 0; r < count; ++r) {
    std::vector<Index> image;
    for (const Index v : rings[r]) {
      image.push_back(pairing.vertex_partners[v]);
    }
    std::reverse(image.begin(), image.end());
    rings.push_back(std::move(image));
  }
  return rings;
}

void join_with_image(GeneratedCage& side, const MirrorFrame& frame) {
  Whole<PolygonMesh> both = join_halves(side.faces, frame);
  side.faces = std::move(both.mesh);
  side.triangles = to_triangle_mesh(side.faces);
  side.mirror = std::move(both.pairing);
  if (side.quads) {
    side.quads = report_of(side.faces);
  }
  side.limb_rings = with_images(std::move(side.limb_rings), *side.mirror);
  for (Remark& remark : side.remarks) {
    if (remark.place) {
      remark.place = frame.from_frame(*remark.place)[0];
    }
  }
  side.objective *= 2;
  side.start_vertices *= 2;
  side.bridges *= 2;
  side.pieces = 2;
}

} // namespace

PartMaker::PartMaker(TriangleView model, const GenerateOptions& options,
                     const std::optional<MirrorPlane>& plane)
    : plane_(plane) {
  if (!plane) {
    return;
  }
  frame_ = MirrorFrame(*plane, bounding_box(model.positions));
  keep_off_ = least_room * options.clearance * diagonal(model.positions);
  const int vertices = vertex_limit(options);
  may_be_two_ = (vertices == 0 || vertices >= 2 * vertices_for_a_piece) &&
                (options.faces == 0 || options.faces >= 2 * faces_for_a_piece);
}

AlikeSurfaces PartMaker::surfaces(TriangleView part) const {
  if (may_be_two_) {
    HalfModel side = half_model(part, frame_);
    if (std::all_of(side.mesh.positions.begin(), side.mesh.positions.end(),
                    [&](const Vec3& p) { return p.x() > keep_off_; })) {
      return {std::move(side.mesh), 2};
    }
  }
  return {{{part.positions.begin(), part.positions.end()},
           {part.triangles.begin(), part.triangles.end()}},
          1};
}

Result<GeneratedCage> PartMaker::make(TriangleView part, const GenerateOptions& options,
                                      const Progress& progress) const {
  if (surfaces(part).count == 1) {
    return make_surface(part, options, {plane_, true, ""}, progress);
  }
  constexpr double usual = 0.9; // of the time: a side hardly ever reaches across the plane
  Result<GeneratedCage> two = make_two(part, options, progress.part(0, usual));
  if (two || two.error().code == ErrorCode::cancelled) {
    return two;
  }
  return make_surface(part, options, {plane_, true, ""}, progress.part(usual, 1));
}

// A cage of what is on one side, and its mirror image. The side is that of the model and its image
// together; the gap that counts is the one to the model alone.
Result<GeneratedCage> PartMaker::make_two(TriangleView part, const GenerateOptions& options,
                                          const Progress& progress) const {
  const int attempts = options.max_gap > 0 ? 4 : 1;
  double max_gap = options.max_gap;
  const auto cost_of = [](const GeneratedCage& made) {
    return Cost{false, made.gap.value_or(0), 0};
  };
  BestOf<GeneratedCage, decltype(cost_of)> tries(cost_of);
  for (int k = 0; k < attempts; ++k) {
    GenerateOptions own = options;
    own.max_gap = max_gap;
    Result<GeneratedCage> made = make_two_once(
        part, own, progress.part(static_cast<double>(k) / attempts, (k + 1.0) / attempts));
    if (!made || !made->gap) {
      tries.add(std::move(made));
      break;
    }
    const double gap = *made->gap;
    const bool is_near = gap <= options.max_gap;
    const bool has_side = is_within_budget(*made); // within max_gap of the model and its image
    if (has_side && !is_near) {
      add(*made, {Reason::gap_not_kept, "the model is farther than that from its own mirror image",
                  true, std::nullopt});
    }
    tries.add(std::move(made));
    const double off = gap - max_gap; // what the image costs, about
    if (is_near || !has_side || off + options.clearance >= options.max_gap) {
      break;
    }
    constexpr double less = 0.98;
    max_gap = std::max(1.05 * options.clearance, less * (options.max_gap - off));
  }
  return tries.taken();
}

Result<GeneratedCage> PartMaker::make_two_once(TriangleView part, const GenerateOptions& options,
                                               const Progress& progress) const {
  HalfModel half = half_model(part, frame_);
  const ModelPart side{std::move(half.mesh), std::move(half.vertices)};
  const double whole = diagonal(part.positions);
  PartOptions own = options_for(side, whole, options);
  own.options.vertices = vertex_limit(options) / 2;
  own.options.faces /= 2;
  Result<GeneratedCage> made = make_surface(side.mesh, own.options, {}, progress);
  if (!made) {
    return made;
  }
  if (std::any_of(made->faces.positions.begin(), made->faces.positions.end(),
                  [](const Vec3& p) { return !(p.x() > 0); })) {
    return Error{ErrorCode::no_valid_cage, "the cage of one side reaches across the mirror plane"};
  }
  restate(*made, diagonal(side.mesh.positions) / whole);
  join_with_image(*made, frame_);
  if (made->gap) {
    constexpr double width = 0.002; // of the greatest gap: how well it is bounded
    const double tolerance = width * options.max_gap * whole;
    made->gap = greatest_gap_along_any(made->faces, TriangleBvh(part), tolerance) / whole;
  }
  return made;
}

} // namespace cagewright
