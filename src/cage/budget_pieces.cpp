#include "cage/budget_pieces.h"

#include "cage/part_options.h"
#include "cage/unit_frame.h"
#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>
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
PieceGroups fit_for_cages(TriangleView model, PieceGroups groups, const BudgetCageOptions& options,
                          const PieceMaker& maker) {
  const double clearance = options.improve.clearance * diagonal(model.positions);
  int most = std::numeric_limits<int>::max();
  if (options.improve.vertices > 0) {
    most = options.improve.vertices / vertices_for_a_piece;
  }
  if (options.improve.faces > 0) {
    most = std::min(most, options.improve.faces / faces_for_a_piece);
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

/// The triangles that the cage may be cut into: along the first diagonals of its quads, and along
/// the others.
std::vector<TriangleMesh> cuts(const BudgetCage& cage) {
  std::vector<TriangleMesh> result{cage.cage};
  if (cage.polygons) {
    TriangleMesh other{cage.polygons->positions, {}};
    for (std::size_t f = 0; f < cage.polygons->face_count(); ++f) {
      const std::span<const Index> face = cage.polygons->face(f);
      const std::size_t k = face.size() == 4 ? 1 : 0;
      other.triangles.push_back({face[k], face[k + 1], face[k + 2]});
      if (face.size() == 4) {
        other.triangles.push_back({face[1], face[3], face[0]});
      }
    }
    result.push_back(std::move(other));
  }
  return result;
}

bool are_apart(const BudgetCage& a, const BudgetCage& b) {
  for (const TriangleMesh& s : cuts(a)) {
    for (const TriangleMesh& t : cuts(b)) {
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

int vertex_count(const BudgetCage& cage) {
  return static_cast<int>(cage.cage.positions.size());
}

int face_count(const BudgetCage& cage) {
  return static_cast<int>(cage.polygons ? cage.polygons->face_count() : cage.cage.triangles.size());
}

/// By how much more than the budget the cages have together.
Budget excess_of(const std::vector<std::optional<BudgetCage>>& cages, const Budget& budget) {
  Budget excess{budget.vertices > 0 ? -budget.vertices : 0, budget.faces > 0 ? -budget.faces : 0};
  for (const std::optional<BudgetCage>& cage : cages) {
    excess.vertices += budget.vertices > 0 ? vertex_count(*cage) : 0;
    excess.faces += budget.faces > 0 ? face_count(*cage) : 0;
  }
  return {std::max(0, excess.vertices), std::max(0, excess.faces)};
}

/// Whether a cage is as small as it may be, or could not be made so.
bool keeps_to(const BudgetCage& cage, const Budget& budget) {
  return !cage.report.reached || ((budget.vertices == 0 || vertex_count(cage) <= budget.vertices) &&
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
std::vector<std::size_t> joins_of(const std::vector<std::optional<BudgetCage>>& cages) {
  std::vector<std::size_t> into(cages.size());
  std::iota(into.begin(), into.end(), 0);
  std::vector<Box3> boxes;
  for (const std::optional<BudgetCage>& cage : cages) {
    boxes.push_back(bounding_box(cage->cage.positions));
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
BudgetCage gathered(std::vector<std::optional<BudgetCage>>& cages,
                    const std::vector<ModelPart>& parts, double whole,
                    const BudgetCageOptions& options) {
  BudgetCage all;
  all.report.reached = true;
  all.clearance = options.improve.clearance;
  all.clearance_asked = options.improve.clearance;
  all.pieces = 0;
  for (std::size_t g = 0; g < cages.size(); ++g) {
    BudgetCage& cage = *cages[g];
    restate(cage, diagonal(parts[g].mesh.positions) / whole);
    if (cage.mirror) {
      add_pairs(all.mirror ? *all.mirror : all.mirror.emplace(), *cage.mirror,
                all.cage.positions.size(), static_cast<std::size_t>(face_count(all)));
    }
    for (std::vector<Index>& ring : cage.limb_rings) {
      for (Index& v : ring) {
        v += static_cast<Index>(all.polygons ? all.polygons->positions.size() : 0);
      }
      all.limb_rings.push_back(std::move(ring));
    }
    all.cage = all.pieces == 0 ? std::move(cage.cage) : joined(all.cage, cage.cage);
    if (cage.polygons) {
      all.polygons = all.polygons ? joined_faces(*all.polygons, *cage.polygons) : cage.polygons;
      all.quads = report_of(*all.polygons);
    }
    constexpr double rounding = 1e-12;
    if (cage.clearance < (1 - rounding) * all.clearance) {
      all.clearance = cage.clearance;
    }
    all.report.objective += cage.report.objective;
    all.report.simplify_seconds += cage.report.simplify_seconds;
    all.report.refine_seconds += cage.report.refine_seconds;
    if (!cage.report.reached) {
      all.report.reached = false;
      all.report.why_not = cage.report.why_not;
    }
    if (cage.gap) {
      all.gap = std::max(all.gap.value_or(0), *cage.gap);
    }
    all.start_vertices += cage.start_vertices;
    all.resolution = std::max(all.resolution, cage.resolution);
    all.bridges += cage.bridges;
    all.pieces += cage.pieces;
    add_times(all.times, cage.times);
  }
  return all;
}

/// The cages of all groups, while they are being made.
class PieceCages {
public:
  PieceCages(TriangleView model, PieceGroups groups, const BudgetCageOptions& options,
             const PieceMaker& maker)
      : model_(model), whole_(diagonal(model.positions)), options_(options),
        maker_(maker), budget_{options.improve.vertices, options.improve.faces} {
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
      Result<BudgetCage> made =
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
      if (cages_[g]->report.reached &&
          (largest == cages_.size() || vertex_count(*cages_[g]) > vertex_count(*cages_[largest]))) {
        largest = g;
      }
    }
    if (largest == cages_.size() || (excess.vertices == 0 && excess.faces == 0)) {
      return success();
    }
    std::optional<BudgetCage>& cage = cages_[largest];
    Budget share;
    if (budget_.vertices > 0) {
      share.vertices =
          std::max(cage->pieces * vertices_for_a_piece, vertex_count(*cage) - excess.vertices);
    }
    if (budget_.faces > 0) {
      share.faces = std::max(cage->pieces * faces_for_a_piece, face_count(*cage) - excess.faces);
    }
    Result<BudgetCage> made = make(largest, share, progress);
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
    std::vector<std::optional<BudgetCage>> kept(fewer.count);
    std::vector<std::size_t> members(fewer.count, 0);
    std::vector<bool> seen(groups_.count, false);
    for (std::size_t v = 0; v < groups_.group_of.size(); ++v) {
      const Index g = groups_.group_of[v];
      if (!seen[g]) {
        seen[g] = true;
        ++members[fewer.group_of[v]];
        kept[fewer.group_of[v]] =
            members[fewer.group_of[v]] == 1 ? std::move(cages_[g]) : std::optional<BudgetCage>();
      }
    }
    cages_ = std::move(kept);
    set_groups(fewer);
    return true;
  }

  BudgetCage together() {
    const Budget excess = excess_of(cages_, budget_);
    BudgetCage all = gathered(cages_, parts_, whole_, options_);
    if (options_.max_gap == 0 && excess.vertices == 0 && excess.faces == 0) {
      all.report.reached = true;
      all.report.why_not.clear();
    }
    return all;
  }

private:
  void set_groups(PieceGroups groups) {
    groups_ = std::move(groups);
    parts_ = parts_of(model_, groups_);
  }

  Result<BudgetCage> make(std::size_t g, const Budget& share, const Progress& progress) const {
    PartOptions own = options_for(parts_[g], whole_, options_);
    own.options.improve.vertices = share.vertices;
    own.options.improve.faces = share.faces;
    return maker_.make(parts_[g].mesh, own.options, progress);
  }

  TriangleView model_;
  double whole_;
  const BudgetCageOptions& options_;
  const PieceMaker& maker_;
  Budget budget_;
  PieceGroups groups_;
  std::vector<ModelPart> parts_;
  std::vector<std::optional<BudgetCage>> cages_;
};

} // namespace

Result<BudgetCage> make_pieces(TriangleView model, PieceGroups groups,
                               const BudgetCageOptions& options, const PieceMaker& maker,
                               const Progress& progress) {
  PieceCages pieces(model, fit_for_cages(model, std::move(groups), options, maker), options, maker);
  constexpr double usual = 0.9; // of the time: hardly ever is a piece stuck
  do {
    if (const Status made = pieces.make_missing(progress.part(0, usual)); !made) {
      return made.error();
    }
    if (const Status made = pieces.make_up_for_stuck(progress.part(usual, 1)); !made) {
      return made.error();
    }
  } while (pieces.join_those_that_meet());
  return pieces.together();
}

} // namespace cagewright
