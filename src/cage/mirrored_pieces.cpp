#include "cage/mirrored_pieces.h"

#include "cage/part_options.h"
#include "cage/quad_stage.h"
#include "mesh/disjoint_sets.h"
#include "mesh/shapes.h"
#include "spatial/bvh.h"
#include "symmetry/half.h"
#include "validate/greatest_gap.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// Each with its mirror image.
struct MirroredGroups {
  PieceGroups groups;
  std::size_t apart = 0; ///< groups of the model and its image that are apart
};

Result<MirroredGroups> mirrored_groups(TriangleView model, const MirrorPlane& plane,
                                       double clearance, int resolution, const Progress& progress) {
  const TriangleMesh same{{model.positions.begin(), model.positions.end()},
                          {model.triangles.begin(), model.triangles.end()}};
  const TriangleMesh both = joined(same, mirror_image(model, plane));
  const Result<PieceGroups> groups = piece_groups(both, clearance, resolution, progress);
  if (!groups) {
    return groups.error();
  }
  const std::size_t count = model.positions.size();
  DisjointSets sets(groups->count);
  for (std::size_t v = 0; v < count; ++v) {
    sets.join(groups->group_of[v], groups->group_of[v + count]);
  }
  std::vector<std::size_t> into;
  for (Index g = 0; g < groups->count; ++g) {
    into.push_back(sets.find(g));
  }
  MirroredGroups result{joined_groups(*groups, into), groups->count};
  result.groups.group_of.resize(count); // those of the image are the same ones
  return result;
}

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

class MirroredParts {
public:
  MirroredParts(TriangleView model, const MirrorPlane& plane, const BudgetCageOptions& options,
                const MakeMirrored& make)
      : frame_(plane, bounding_box(model.positions)),
        keep_off_(least_room * options.improve.clearance * diagonal(model.positions)), make_(make) {
    const ImproveOptions& budget = options.improve;
    may_be_two_ = (budget.vertices == 0 || budget.vertices >= 2 * vertices_for_a_piece) &&
                  (budget.faces == 0 || budget.faces >= 2 * faces_for_a_piece);
  }

  [[nodiscard]] AlikeSurfaces surfaces(TriangleView part) const {
    HalfModel side = half_model(part, frame_);
    const bool is_beside = std::all_of(side.mesh.positions.begin(), side.mesh.positions.end(),
                                       [&](const Vec3& p) { return p.x() > keep_off_; });
    if (may_be_two_ && is_beside) {
      return {std::move(side.mesh), 2};
    }
    return {{{part.positions.begin(), part.positions.end()},
             {part.triangles.begin(), part.triangles.end()}},
            1};
  }

  [[nodiscard]] Result<BudgetCage> make(TriangleView part, const BudgetCageOptions& options,
                                        const Progress& progress) const {
    if (surfaces(part).count == 1) {
      return make_.across(part, options, progress);
    }
    constexpr double usual = 0.9; // of the time: a side hardly ever reaches across the plane
    Result<BudgetCage> two = two_sides(part, options, progress.part(0, usual));
    if (two || two.error().code == ErrorCode::cancelled) {
      return two;
    }
    return make_.across(part, options, progress.part(usual, 1));
  }

private:
  static constexpr double least_room = 2; // between model and plane, in clearances

  /// A cage of what is on one side, and its mirror image. The side is that of the model and its
  /// image together; the gap that counts is the one to the model alone.
  [[nodiscard]] Result<BudgetCage> two_sides(TriangleView part, const BudgetCageOptions& options,
                                             const Progress& progress) const {
    const int attempts = options.max_gap > 0 ? 4 : 1;
    double max_gap = options.max_gap;
    Result<BudgetCage> best = Error{ErrorCode::no_valid_cage, ""};
    for (int k = 0; k < attempts; ++k) {
      BudgetCageOptions own = options;
      own.max_gap = max_gap;
      Result<BudgetCage> made = two_sides_once(
          part, own, progress.part(static_cast<double>(k) / attempts, (k + 1.0) / attempts));
      if (!made) {
        return best ? std::move(best) : std::move(made);
      }
      if (!made->gap) {
        return made;
      }
      const double gap = *made->gap;
      const bool is_near = gap <= options.max_gap;
      const bool has_side = made->report.reached; // within max_gap of the model and its image
      made->report.reached = has_side && is_near;
      if (!best || gap < *best->gap) {
        best = std::move(made);
      }
      const double off = gap - max_gap; // what the image costs, about
      if (is_near || !has_side || off + options.improve.clearance >= options.max_gap) {
        break;
      }
      constexpr double less = 0.98;
      max_gap = std::max(1.05 * options.improve.clearance, less * (options.max_gap - off));
    }
    if (!best->report.reached && best->report.why_not.empty()) {
      best->report.why_not = "the model is farther than that from its own mirror image";
    }
    return best;
  }

  [[nodiscard]] Result<BudgetCage> two_sides_once(TriangleView part,
                                                  const BudgetCageOptions& options,
                                                  const Progress& progress) const {
    HalfModel half = half_model(part, frame_);
    const ModelPart side{std::move(half.mesh), std::move(half.vertices)};
    const double whole = diagonal(part.positions);
    PartOptions own = options_for(side, whole, options);
    own.options.symmetry = Symmetry::off;
    own.options.improve.vertices /= 2;
    own.options.improve.faces /= 2;
    Result<BudgetCage> made = make_.plain(side.mesh, own.options, progress);
    if (!made) {
      return made;
    }
    const std::vector<Vec3>& at = made->cage.positions;
    if (std::any_of(at.begin(), at.end(), [](const Vec3& p) { return !(p.x() > 0); })) {
      return Error{ErrorCode::no_valid_cage,
                   "the cage of one side reaches across the mirror plane"};
    }
    restate(*made, diagonal(side.mesh.positions) / whole);
    join_with_image(*made);
    if (made->gap) {
      constexpr double width = 0.002; // of the greatest gap: how well it is bounded
      const double tolerance = width * options.max_gap * whole;
      const TriangleBvh model(part);
      made->gap = (made->polygons ? greatest_gap_of_quads(*made->polygons, model, tolerance)
                                  : greatest_gap(made->cage, model, tolerance).upper) /
                  whole;
    }
    return made;
  }

  void join_with_image(BudgetCage& side) const {
    if (side.polygons) {
      Whole<PolygonMesh> both = join_halves(*side.polygons, frame_);
      side.cage = to_triangle_mesh(both.mesh);
      side.quads = report_of(both.mesh);
      side.polygons = std::move(both.mesh);
      side.mirror = std::move(both.pairing);
    } else {
      Whole<TriangleMesh> both = join_halves(side.cage, frame_);
      side.cage = std::move(both.mesh);
      side.mirror = std::move(both.pairing);
    }
    side.limb_rings = with_images(std::move(side.limb_rings), *side.mirror);
    side.report.objective *= 2;
    side.start_vertices *= 2;
    side.bridges *= 2;
    side.pieces = 2;
  }

  MirrorFrame frame_;
  double keep_off_;
  const MakeMirrored& make_;
  bool may_be_two_ = true;
};

} // namespace

Result<BudgetCage> make_mirrored_pieces(TriangleView model, const MirrorPlane& plane,
                                        int resolution, const BudgetCageOptions& options,
                                        const MakeMirrored& make, const Progress& progress) {
  constexpr double grouped = 0.02; // of the time
  Result<MirroredGroups> mirrored = mirrored_groups(model, plane, options.improve.clearance,
                                                    resolution, progress.part(0, grouped));
  if (!mirrored) {
    return mirrored.error();
  }
  const MirroredParts parts(model, plane, options, make);
  const PieceMaker maker{[&](TriangleView part, const BudgetCageOptions& own,
                             const Progress& share) { return parts.make(part, own, share); },
                         [&](TriangleView part) { return parts.surfaces(part); }};
  Result<BudgetCage> made =
      make_pieces(model, std::move(mirrored->groups), options, maker, progress.part(grouped, 1));
  if (made) {
    made->joined = static_cast<int>(mirrored->apart) - made->pieces;
  }
  return made;
}

} // namespace cagewright
