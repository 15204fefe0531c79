#include "cage/piece_cages.h"

#include "cage/budget.h"
#include "cage/not_valid.h"
#include "cage/part_maker.h"
#include "cage/part_options.h"
#include "cage/pieces.h"
#include "cage/quad_cuts.h"
#include "cage/unit_frame.h"
#include "mesh/disjoint_sets.h"
#include "mesh/shapes.h"
#include "quads/quads.h"
#include "symmetry/half.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr int voxels_for_pieces = 96;     // along the longest edge, to tell which pieces are apart
constexpr double largest_clearance = 0.2; // of a piece's own diagonal: smaller pieces join others

/// The budget of a model, shared out by surface area, `least` for each of a part's surfaces.
std::vector<int> shares(int budget, int least, const std::vector<double>& areas,
                        const std::vector<int>& surfaces) {
  std::vector<int> share(areas.size(), budget);
  if (budget == 0) { // no limit
    return share;
  }
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  int left = budget - least * std::accumulate(surfaces.begin(), surfaces.end(), 0);
  const int to_share = left;
  for (std::size_t g = 0; g < areas.size(); ++g) {
    const double part = all > 0 ? areas[g] / all : 0;
    share[g] = static_cast<int>(std::floor(part * to_share));
    left -= share[g];
    share[g] += least * surfaces[g];
  }
  const auto largest = std::max_element(areas.begin(), areas.end());
  share[static_cast<std::size_t>(largest - areas.begin())] += left;
  return share;
}

/// The other group whose box is nearest.
std::size_t nearest_group(std::size_t g, const std::vector<Box3>& boxes) {
  std::size_t best = g == 0 ? 1 : 0;
  for (std::size_t h = 0; h < boxes.size(); ++h) {
    if (h != g && boxes[g].squaredExteriorDistance(boxes[h]) <
                      boxes[g].squaredExteriorDistance(boxes[best])) {
      best = h;
    }
  }
  return best;
}

/// Joins groups to the nearest other one until each can have a cage of its own: a surface of some
/// extent, larger than the clearance, and vertices enough.
PieceGroups fit_for_cages(TriangleView model, PieceGroups groups, const GenerateOptions& options,
                          const PartMaker& maker) {
  const double clearance = options.clearance * diagonal(model.positions);
  int most = std::numeric_limits<int>::max();
  if (vertex_limit(options) > 0) {
    most = vertex_limit(options) / vertices_for_a_piece;
  }
  if (options.faces > 0) {
    most = std::min(most, options.faces / faces_for_a_piece);
  }
  while (groups.count > 1) {
    const std::vector<ModelPart> parts = parts_of(model, groups);
    std::vector<Box3> boxes;
    std::size_t smallest = 0;
    double smallest_size = std::numeric_limits<double>::infinity();
    std::size_t unfit = groups.count;
    int surfaces = 0;
    for (std::size_t g = 0; g < parts.size(); ++g) {
      boxes.push_back(bounding_box(parts[g].mesh.positions));
      const AlikeSurfaces alike = maker.surfaces(parts[g].mesh);
      surfaces += alike.count;
      const double size = diagonal(alike.model.positions);
      if (size < smallest_size) {
        smallest = g;
        smallest_size = size;
      }
      if (unfit == groups.count &&
          (!unit_frame(alike.model) || clearance > largest_clearance * size)) {
        unfit = g;
      }
    }
    if (unfit == groups.count && surfaces <= most) {
      break;
    }
    std::vector<std::size_t> into(groups.count);
    std::iota(into.begin(), into.end(), 0);
    const std::size_t g = unfit < groups.count ? unfit : smallest;
    into[g] = nearest_group(g, boxes);
    groups = joined_groups(groups, into);
  }
  return groups;
}

bool are_apart(const GeneratedCage& a, const GeneratedCage& b) {
  // Along any diagonals.
  for (const TriangleMesh& s : cuts_of(a.faces)) {
    for (const TriangleMesh& t : cuts_of(b.faces)) {
      if (!is_embedded(joined(s, t))) {
        return false;
      }
    }
  }
  return true;
}

/// At most so many; 0: no limit.
struct Budget {
  int vertices = 0;
  int faces = 0;
};

int vertex_count(const GeneratedCage& cage) {
  return static_cast<int>(cage.faces.positions.size());
}

int face_count(const GeneratedCage& cage) {
  return static_cast<int>(cage.faces.face_count());
}

/// By how much more than the budget the cages have together.
Budget excess_of(const std::vector<std::optional<GeneratedCage>>& cages, const Budget& budget) {
  Budget excess{budget.vertices > 0 ? -budget.vertices : 0, budget.faces > 0 ? -budget.faces : 0};
  for (const std::optional<GeneratedCage>& cage : cages) {
    excess.vertices += budget.vertices > 0 ? vertex_count(*cage) : 0;
    excess.faces += budget.faces > 0 ? face_count(*cage) : 0;
  }
  return {std::max(0, excess.vertices), std::max(0, excess.faces)};
}

/// Whether a cage is as small as it may be, or could not be made so.
bool keeps_to(const GeneratedCage& cage, const Budget& budget) {
  return !is_within_budget(cage) ||
         ((budget.vertices == 0 || vertex_count(cage) <= budget.vertices) &&
          (budget.faces == 0 || face_count(cage) <= budget.faces));
}

/// Faces of both.
PolygonMesh joined_faces(const PolygonMesh& a, const PolygonMesh& b) {
  PolygonMesh all;
  for (const PolygonMesh* mesh : {&a, &b}) {
    const auto first = static_cast<Index>(all.positions.size());
    all.positions.insert(all.positions.end(), mesh->positions.begin(), mesh->positions.end());
    for (std::size_t f = 0; f < mesh->face_count(); ++f) {
      std::vector<Index> face(mesh->face(f).begin(), mesh->face(f).end());
      for (Index& v : face) {
        v += first;
      }
      all.add_face(face);
    }
  }
  return all;
}

/// Which groups must be joined because their cages meet or lie one within another: exact.
std::vector<std::size_t> joins_of(const std::vector<std::optional<GeneratedCage>>& cages) {
  std::vector<std::size_t> into(cages.size());
  std::iota(into.begin(), into.end(), 0);
  std::vector<Box3> boxes;
  for (const std::optional<GeneratedCage>& cage : cages) {
    boxes.push_back(bounding_box(cage->faces.positions));
  }
  for (std::size_t a = 0; a < cages.size(); ++a) {
    for (std::size_t b = a + 1; b < cages.size() && into[a] == a; ++b) {
      if (boxes[a].intersects(boxes[b]) && !are_apart(*cages[a], *cages[b])) {
        into[a] = b;
      }
    }
  }
  return into;
}

void add_times(std::vector<StageTime>& times, const std::vector<StageTime>& more) {
  for (const StageTime& time : more) {
    const auto same = std::find_if(times.begin(), times.end(),
                                   [&](const StageTime& t) { return t.stage == time.stage; });
    if (same == times.end()) {
      times.push_back(time);
    } else {
      same->seconds += time.seconds;
    }
  }
}

/// Adds the pairs of a cage whose first vertex and face get these numbers.
void add_pairs(MirrorPairing& pairing, const MirrorPairing& more, std::size_t vertices,
               std::size_t faces) {
  for (const Index v : more.vertex_partners) {
    pairing.vertex_partners.push_back(v + static_cast<Index>(vertices));
  }
  for (const Index f : more.face_partners) {
    pairing.face_partners.push_back(f + static_cast<Index>(faces));
  }
  pairing.plane = more.plane;
  pairing.error = std::max(pairing.error, more.error);
}

/// All cages as one, and what is known of them together.
GeneratedCage gathered(std::vector<std::optional<GeneratedCage>>& cages,
                       const std::vector<ModelPart>& parts, double whole,
                       const GenerateOptions& options) {
  GeneratedCage all;
  all.method = options.method;
  all.clearance = options.clearance;
  all.pieces = 0;
  for (std::size_t g = 0; g < cages.size(); ++g) {
    GeneratedCage& cage = *cages[g];
    restate(cage, diagonal(parts[g].mesh.positions) / whole);
    const std::size_t vertices = all.faces.positions.size();
    if (cage.mirror) {
      add_pairs(all.mirror ? *all.mirror : all.mirror.emplace(), *cage.mirror, vertices,
                all.faces.face_count());
    }
    for (std::vector<Index>& ring : cage.limb_rings) {
      for (Index& v : ring) {
        v += static_cast<Index>(vertices);
      }
      all.limb_rings.push_back(std::move(ring));
    }
    all.faces = all.pieces == 0 ? std::move(cage.faces) : joined_faces(all.faces, cage.faces);
    constexpr double rounding = 1e-12;
    if (cage.clearance < (1 - rounding) * all.clearance) {
      all.clearance = cage.clearance;
    }
    for (const Remark& remark : cage.remarks) {
      add(all, remark);
    }
    if (cage.method == Method::envelope) {
      all.method = cage.method;
    }
    if (cage.gap) {
      all.gap = std::max(all.gap.value_or(0), *cage.gap);
    }
    all.objective += cage.objective;
    all.start_vertices += cage.start_vertices;
    all.resolution = std::max(all.resolution, cage.resolution);
    all.bridges += cage.bridges;
    all.pieces += cage.pieces;
    add_times(all.times, cage.times);
  }
  all.triangles = to_triangle_mesh(all.faces);
  if (options.quads) {
    all.quads = report_of(all.faces);
  }
  return all;
}

/// The cages of all groups, while they are being made.
class PieceCages {
public:
  PieceCages(TriangleView model, PieceGroups groups, const GenerateOptions& options,
             const PartMaker& maker)
      : model_(model), whole_(diagonal(model.positions)), options_(options),
        maker_(maker), budget_{vertex_limit(options), options.faces} {
    set_groups(std::move(groups));
    cages_.resize(parts_.size());
  }

  /// A cage within its share for every group that has none.
  Status make_missing(const Progress& progress) {
    std::vector<double> areas;
    std::vector<int> surfaces;
    for (const ModelPart& part : parts_) {
      areas.push_back(surface_area(part.mesh));
      surfaces.push_back(maker_.surfaces(part.mesh).count);
    }
    const std::vector<int> vertices =
        shares(budget_.vertices, vertices_for_a_piece, areas, surfaces);
    const std::vector<int> faces = shares(budget_.faces, faces_for_a_piece, areas, surfaces);
    const auto count = static_cast<double>(parts_.size());
    for (std::size_t g = 0; g < parts_.size(); ++g) {
      const Budget share = parts_.size() > 1 ? Budget{vertices[g], faces[g]} : budget_;
      if (cages_[g] && keeps_to(*cages_[g], share)) {
        continue;
      }
      Result<GeneratedCage> made =
          make(g, share,
               progress.part(static_cast<double>(g) / count, static_cast<double>(g + 1) / count));
      if (!made) {
        return made.error();
      }
      cages_[g] = std::move(*made);
    }
    return success();
  }

  /// What a piece could not do without, the largest other one is asked to give.
  Status make_up_for_stuck(const Progress& progress) {
    const Budget excess = excess_of(cages_, budget_);
    std::size_t largest = cages_.size();
    for (std::size_t g = 0; g < cages_.size(); ++g) {
      if (is_within_budget(*cages_[g]) &&
          (largest == cages_.size() || vertex_count(*cages_[g]) > vertex_count(*cages_[largest]))) {
        largest = g;
      }
    }
    if (largest == cages_.size() || (excess.vertices == 0 && excess.faces == 0)) {
      return success();
    }
    std::optional<GeneratedCage>& cage = cages_[largest];
    Budget share;
    if (budget_.vertices > 0) {
      share.vertices =
          std::max(cage->pieces * vertices_for_a_piece, vertex_count(*cage) - excess.vertices);
    }
    if (budget_.faces > 0) {
      share.faces = std::max(cage->pieces * faces_for_a_piece, face_count(*cage) - excess.faces);
    }
    Result<GeneratedCage> made = make(largest, share, progress);
    if (!made) {
      return made.error();
    }
    if (vertex_count(*made) < vertex_count(*cage)) {
      cage = std::move(*made);
    }
    return success();
  }

  /// Joins the groups whose cages meet. The others keep theirs. \returns whether there are any
  bool join_those_that_meet() {
    const PieceGroups fewer = joined_groups(groups_, joins_of(cages_));
    if (fewer.count == groups_.count) {
      return false;
    }
    std::vector<std::optional<GeneratedCage>> kept(fewer.count);
    std::vector<std::size_t> members(fewer.count, 0);
    std::vector<bool> seen(groups_.count, false);
    for (std::size_t v = 0; v < groups_.group_of.size(); ++v) {
      const Index g = groups_.group_of[v];
      if (!seen[g]) {
        seen[g] = true;
        ++members[fewer.group_of[v]];
        kept[fewer.group_of[v]] =
            members[fewer.group_of[v]] == 1 ? std::move(cages_[g]) : std::optional<GeneratedCage>();
      }
    }
    cages_ = std::move(kept);
    set_groups(fewer);
    return true;
  }

  GeneratedCage together() {
    const Budget excess = excess_of(cages_, budget_);
    GeneratedCage all = gathered(cages_, parts_, whole_, options_);
    if (options_.max_gap == 0 && excess.vertices == 0 && excess.faces == 0) {
      drop(all, Reason::budget_not_reached);
    }
    return all;
  }

private:
  void set_groups(PieceGroups groups) {
    groups_ = std::move(groups);
    parts_ = parts_of(model_, groups_);
  }

  Result<GeneratedCage> make(std::size_t g, const Budget& share, const Progress& progress) const {
    PartOptions own = options_for(parts_[g], whole_, options_);
    own.options.vertices = share.vertices;
    own.options.faces = share.faces;
    return maker_.make(parts_[g].mesh, own.options, progress);
  }

  TriangleView model_;
  double whole_;
  const GenerateOptions& options_;
  const PartMaker& maker_;
  Budget budget_;
  PieceGroups groups_;
  std::vector<ModelPart> parts_;
  std::vector<std::optional<GeneratedCage>> cages_;
};

struct Grouped {
  PieceGroups groups;
  std::size_t apart = 0; ///< groups that are apart, of the model and its image if there is one
};

Result<Grouped> plain_groups(TriangleView model, double clearance, const Progress& progress) {
  Result<PieceGroups> groups = piece_groups(model, clearance, voxels_for_pieces, progress);
  if (!groups) {
    return groups.error();
  }
  const std::size_t apart = groups->count;
  return Grouped{std::move(*groups), apart};
}

/// Each with its mirror image.
Result<Grouped> mirrored_groups(TriangleView model, const MirrorPlane& plane, double clearance,
                                const Progress& progress) {
  const TriangleMesh same{{model.positions.begin(), model.positions.end()},
                          {model.triangles.begin(), model.triangles.end()}};
  const TriangleMesh both = joined(same, mirror_image(model, plane));
  const Result<PieceGroups> groups = piece_groups(both, clearance, voxels_for_pieces, progress);
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
  Grouped result{joined_groups(*groups, into), groups->count};
  result.groups.group_of.resize(count); // those of the image are the same ones
  return result;
}

} // namespace

Result<bool> has_pieces_apart(TriangleView model, const GenerateOptions& options,
                              const Progress& progress) {
  const Result<PieceGroups> groups =
      piece_groups(model, options.clearance, voxels_for_pieces, progress);
  return groups ? Result<bool>(groups->count > 1) : groups.error();
}

Result<GeneratedCage> make_pieces(TriangleView model, const GenerateOptions& options,
                                  const std::optional<MirrorPlane>& plane, const PartMaker& maker,
                                  const Progress& progress) {
  constexpr double grouped = 0.02; // of the time
  constexpr double judged = 0.95;
  Result<Grouped> apart =
      plane ? mirrored_groups(model, *plane, options.clearance, progress.part(0, grouped))
            : plain_groups(model, options.clearance, progress.part(0, grouped));
  if (!apart) {
    return apart.error();
  }
  PieceCages pieces(model, fit_for_cages(model, std::move(apart->groups), options, maker), options,
                    maker);
  const Progress making = progress.part(grouped, judged);
  double done = 0;
  do {
    // Hardly ever do cages meet or is a piece stuck: what is left is for that.
    constexpr double usual = 0.9;
    const double made_all = done + usual * (1 - done);
    const double made_up = made_all + 0.5 * (1 - made_all);
    if (const Status made = pieces.make_missing(making.part(done, made_all)); !made) {
      return made.error();
    }
    if (const Status made = pieces.make_up_for_stuck(making.part(made_all, made_up)); !made) {
      return made.error();
    }
    done = made_up;
  } while (pieces.join_those_that_meet());
  GeneratedCage cage = pieces.together();
  cage.joined = static_cast<int>(apart->apart) - cage.pieces;

  const Result<ValidityReport> validity = validate_cage(
      cage.faces, model, {.allow_pieces = true, .first_only = true}, progress.part(judged, 1));
  if (!validity) {
    return validity.error();
  }
  return validity->valid() ? Result<GeneratedCage>(std::move(cage))
                           : not_valid(*validity, "try another resolution");
}

} // namespace cagewright
