#include "improve/refine.h"

#include "core/maths.h"
#include "core/parallel.h"
#include "improve/placement.h"
#include "improve/relax.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <vector>

namespace cagewright {

namespace {

using Edge = std::array<Index, 2>;

struct Change {
  double gain = 0; // by how much the objective falls
  Patch patch;
  Edge edge = {}; ///< that it is about, where that is needed
};

std::vector<Edge> edges_of(const CageMesh& cage) {
  std::vector<Edge> edges;
  for (Index f = 0; f < cage.face_end(); ++f) {
    if (cage.has_face(f)) {
      const Triangle& t = cage.face(f);
      for (int i = 0; i < 3; ++i) {
        const Index a = t[i];
        const Index b = t[(i + 1) % 3];
        if (a < b || cage.face_left_of(b, a) == no_index) {
          edges.push_back({std::min(a, b), std::max(a, b)});
        }
      }
    }
  }
  return edges;
}

// The changes that lower the objective, the best first, evaluated in parallel.
template <class Candidate, class Evaluate>
std::vector<Change> ranked(const std::vector<Candidate>& candidates, const Evaluate& evaluate) {
  std::vector<std::optional<Change>> all(candidates.size());
  parallel_for(0, candidates.size(), 1, [&](std::size_t i) { all[i] = evaluate(candidates[i]); });
  std::vector<Change> good;
  for (std::optional<Change>& change : all) {
    if (change && change->gain > 0) {
      good.push_back(std::move(*change));
    }
  }
  std::stable_sort(good.begin(), good.end(),
                   [](const Change& a, const Change& b) { return a.gain > b.gain; });
  return good;
}

// The faces round the patch's faces, itself included: what a change there could make stale.
std::vector<Index> surroundings(const CageMesh& cage, const Patch& patch) {
  std::vector<Index> faces;
  for (const Index f : patch.removed) {
    for (const Index v : cage.face(f)) {
      faces.insert(faces.end(), cage.around(v).begin(), cage.around(v).end());
    }
  }
  return faces;
}

// Whether the corners opposite to the edge a b of the faces may get one more face each.
bool leaves_valence(const CageMesh& cage, std::span<const Index> faces, Index a, Index b,
                    std::size_t most_valence) {
  return std::all_of(faces.begin(), faces.end(), [&](Index f) {
    const Index c = cage.corner_opposite(f, a, b);
    return cage.valence(c) + cage.sides(c) <= most_valence;
  });
}

// Makes the changes in order, but none in the surroundings of another, until `most` vertices of the
// whole cage (or changes that add none) are made.
std::size_t make(WorkingCage& cage, const Guard& guard, const std::vector<Change>& changes,
                 std::size_t most) {
  std::vector<bool> touched(2 * static_cast<std::size_t>(cage.mesh.face_end()) + 4 * most, false);
  const Index next_vertex = cage.mesh.vertex_end(); // that every split has been evaluated with
  std::size_t made = 0;
  for (const Change& change : changes) {
    if (made >= most) {
      break;
    }
    Patch patch = change.patch;
    const bool stale = std::any_of(patch.removed.begin(), patch.removed.end(),
                                   [&](Index f) { return touched[f]; });
    if (stale) {
      continue;
    }
    if (patch.vertex == next_vertex && next_vertex != cage.mesh.vertex_end()) {
      const Index renamed = cage.mesh.vertex_end(); // the first split took the number
      for (Triangle& t : patch.added) {
        std::replace(t.begin(), t.end(), patch.vertex, renamed);
      }
      patch.vertex = renamed;
    }
    if (guard.crosses(cage.mesh, cage.boxes, patch) || guard.loses_a_part(cage.mesh, patch)) {
      continue;
    }
    for (const Index f : surroundings(cage.mesh, patch)) {
      touched[f] = true;
    }
    const std::size_t before = cage.mesh.vertex_count();
    cage.apply(patch);
    const std::size_t after = cage.mesh.vertex_count();
    const std::size_t added = after > before ? after - before : 1;
    for (const Triangle& t : patch.added) {
      for (const Index v : t) {
        for (const Index f : cage.mesh.around(v)) {
          touched[f] = true;
        }
      }
    }
    made += added;
  }
  return made;
}

// The split of an edge with its vertex where it lowers the objective.
std::optional<Change> placed_split(const CageMesh& mesh, const Guard& guard,
                                   const Objective& objective, std::span<const double> values,
                                   const Edge& edge, std::size_t most_valence) {
  Patch patch = mesh.split(edge[0], edge[1]);
  if (!leaves_valence(mesh, patch.removed, edge[0], edge[1], most_valence)) {
    return std::nullopt;
  }
  const std::optional<Vec3> position = place_clear_of_model(guard, objective, mesh, patch);
  if (!position) {
    return std::nullopt;
  }
  patch.position = *position;
  if (!keeps_shape(mesh, patch) || objective.widens_gap(mesh, patch)) {
    return std::nullopt;
  }
  // Of a half, for each vertex of the whole that it costs.
  const double share = mesh.is_half() && patch.on_plane ? 2 : 1;
  const double gain = -share * objective.change(mesh, values, patch);
  return Change{gain, std::move(patch), edge};
}

// A face that is thinner than it may be, or so small that what has grown together there has not
// been made one.
bool is_needle(const Corners& t, double least, double diagonal) {
  constexpr double speck = 1e-6;
  const double longest = std::max(
      {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()});
  return shape_quality(t) < least || longest < maths::square(speck * diagonal);
}

template <class T> std::vector<T> each_once(std::vector<T> all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

std::vector<Edge> sides_of(std::span<const Triangle> faces) {
  std::vector<Edge> edges;
  for (const Triangle& t : faces) {
    for (int i = 0; i < 3; ++i) {
      edges.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    }
  }
  return each_once(std::move(edges));
}

std::vector<Index> corners_of(std::span<const Triangle> faces) {
  std::vector<Index> vertices;
  for (const Triangle& t : faces) {
    vertices.insert(vertices.end(), t.begin(), t.end());
  }
  return each_once(std::move(vertices));
}

// The cage with the edge split near the tip, and the new vertex, the tip, and their neighbours
// where they are best.
std::optional<WorkingCage> with_split_tip(const WorkingCage& cage, const Guard& guard,
                                          const Objective& objective, const Edge& edge,
                                          std::size_t most_valence) {
  const auto& [tip, end] = edge;
  Patch patch = cage.mesh.split(tip, end);
  patch.position = 0.6 * cage.mesh.position(tip) + 0.4 * cage.mesh.position(end);
  if (!leaves_valence(cage.mesh, patch.removed, tip, end, most_valence) ||
      !keeps_shape(cage.mesh, patch) || guard.too_near(cage.mesh, patch) ||
      guard.crosses(cage.mesh, cage.boxes, patch)) {
    return std::nullopt;
  }
  WorkingCage made = cage;
  const Index middle = made.mesh.vertex_end();
  made.apply(patch);
  std::vector<Index> movable = made.mesh.neighbors(tip);
  for (const Index v : made.mesh.neighbors(middle)) {
    movable.push_back(v);
  }
  movable = each_once(std::move(movable));
  constexpr int steps = 6;
  relax(made, guard, objective, {.steps = steps, .movable = movable});
  made.reach = cage.reach;
  return made;
}

} // namespace

std::size_t flip_edges(WorkingCage& cage, const Guard& guard, const Objective& objective,
                       std::size_t most_valence) {
  std::size_t total = 0;
  // Within a plane both diagonals are as good but for rounding: no going to and fro.
  const double least_gain = 1e-9 * maths::cube(objective.diagonal());
  for (;;) {
    const CageMesh& mesh = cage.mesh;
    const std::vector<double> values = objective.face_values(mesh);
    const std::vector<Change> changes = ranked(edges_of(mesh), [&](const Edge& edge) {
      const auto& [a, b] = edge;
      std::optional<Change> change;
      std::optional<Patch> patch = mesh.flip(a, b);
      if (!patch) {
        return change;
      }
      if (!leaves_valence(mesh, patch->removed, a, b, most_valence)) {
        return change;
      }
      if (!keeps_shape(mesh, *patch)) {
        return change;
      }
      const double gain = -objective.change(mesh, values, *patch);
      if (gain > least_gain && !guard.too_near(mesh, *patch) &&
          !objective.widens_gap(mesh, *patch)) {
        change = Change{gain, std::move(*patch), edge};
      }
      return change;
    });
    const std::size_t made = make(cage, guard, changes, changes.size());
    total += made;
    if (made == 0) {
      return total;
    }
  }
}

void split_long_edges(WorkingCage& cage, const Guard& guard, std::size_t vertices,
                      std::size_t most_valence) {
  using Long = std::pair<double, Edge>; // squared length
  const CageMesh& mesh = cage.mesh;
  const auto measured = [&](const Edge& edge) {
    return Long((mesh.position(edge[0]) - mesh.position(edge[1])).squaredNorm(), edge);
  };
  std::priority_queue<Long> longest;
  for (const Edge& edge : edges_of(mesh)) {
    longest.push(measured(edge));
  }
  while (mesh.vertex_count() < vertices && !longest.empty()) {
    const auto [a, b] = longest.top().second;
    longest.pop();
    const Patch patch = mesh.split(a, b);
    if (!leaves_valence(mesh, patch.removed, a, b, most_valence) || guard.too_near(mesh, patch) ||
        guard.crosses(mesh, cage.boxes, patch)) {
      continue;
    }
    const Index middle = mesh.vertex_end();
    cage.apply(patch);
    for (const Index v : mesh.neighbors(middle)) {
      longest.push(measured({v, middle}));
    }
  }
}

std::size_t split_edges(WorkingCage& cage, const Guard& guard, const Objective& objective,
                        std::size_t count, std::size_t most_valence) {
  const CageMesh& mesh = cage.mesh;
  const std::vector<double> values = objective.face_values(mesh);
  // Splits that promise little are not looked into.
  const std::size_t worth_a_look = 3 * count + 12;
  const std::vector<Change> promised = ranked(edges_of(mesh), [&](const Edge& edge) {
    const auto& [a, b] = edge;
    std::optional<Change> change;
    Patch patch = mesh.split(a, b);
    if (leaves_valence(mesh, patch.removed, a, b, most_valence)) {
      const double share = mesh.is_half() && patch.on_plane ? 2 : 1;
      const double gain = share * promised_gain(guard, objective, mesh, patch);
      change = Change{gain, std::move(patch), edge};
    }
    return change;
  });
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < std::min(promised.size(), worth_a_look); ++i) {
    edges.push_back(promised[i].edge);
  }
  const std::vector<Change> changes = ranked(edges, [&](const Edge& edge) {
    return placed_split(mesh, guard, objective, values, edge, most_valence);
  });
  return make(cage, guard, changes, count);
}

std::size_t split_far_faces(WorkingCage& cage, const Guard& guard, const Objective& objective,
                            double limit, std::size_t most_valence) {
  const CageMesh& mesh = cage.mesh;
  std::vector<double> gaps(mesh.face_end(), 0);
  parallel_for(0, gaps.size(), 4, [&](std::size_t i) {
    const auto f = static_cast<Index>(i);
    gaps[f] = mesh.has_face(f) ? objective.sampled_gap(corners_of(mesh, f)) : 0;
  });
  std::vector<Triangle> far;
  for (Index f = 0; f < mesh.face_end(); ++f) {
    if (gaps[f] > limit) {
      far.push_back(mesh.face(f));
    }
  }
  const std::vector<Edge> edges = sides_of(far);
  const std::vector<double> values = objective.face_values(mesh);
  const std::vector<Change> changes = ranked(edges, [&](const Edge& edge) {
    return placed_split(cage.mesh, guard, objective, values, edge, most_valence);
  });
  make(cage, guard, changes, edges.size());
  return far.size();
}

bool split_tip(WorkingCage& cage, const Guard& guard, const Objective& objective, Index tip,
               std::size_t most_valence) {
  const std::vector<Index> ends = cage.mesh.neighbors(tip);
  std::vector<std::optional<WorkingCage>> made(ends.size());
  std::vector<double> values(ends.size());
  parallel_for(0, ends.size(), 1, [&](std::size_t i) {
    made[i] = with_split_tip(cage, guard, objective, {tip, ends[i]}, most_valence);
    values[i] = made[i] ? objective.total(made[i]->mesh) : std::numeric_limits<double>::infinity();
  });
  const auto best = std::min_element(values.begin(), values.end()) - values.begin();
  if (ends.empty() || !made[best]) {
    return false;
  }
  cage = std::move(*made[best]);
  return true;
}

std::size_t mend_needles(WorkingCage& cage, const Guard& guard, const Objective& objective,
                         double least, std::size_t most_valence) {
  const CageMesh& mesh = cage.mesh;
  const double any_cost = maths::cube(objective.diagonal()) * objective.weights().typical_emphasis;
  std::vector<double> values;
  const auto rounder = [&](Patch patch, const Edge& edge) -> std::optional<Change> {
    std::ptrdiff_t needles = 0; // more than before
    for (const Triangle& t : patch.added) {
      needles += is_needle(corners_after(mesh, patch, t), least, objective.diagonal()) ? 1 : 0;
    }
    for (const Index f : patch.removed) {
      needles -= is_needle(corners_of(mesh, f), least, objective.diagonal()) ? 1 : 0;
    }
    if (needles >= 0 || !keeps_shape(mesh, patch) || objective.widens_gap(mesh, patch)) {
      return std::nullopt;
    }
    const double change = objective.change(mesh, values, patch);
    return Change{any_cost - change, std::move(patch), edge};
  };
  const auto placed = [&](Patch patch, const Edge& edge) -> std::optional<Change> {
    const std::optional<Vec3> position = place_clear_of_model(guard, objective, mesh, patch);
    if (!position) {
      return std::nullopt;
    }
    patch.position = *position;
    return rounder(std::move(patch), edge);
  };
  const auto collapsed = [&](const Edge& edge) -> std::optional<Change> {
    std::optional<Patch> patch = mesh.collapse(edge[0], edge[1]);
    const bool fits = patch && mesh.sides(patch->vertex) * patch->added.size() <= most_valence;
    return fits ? placed(std::move(*patch), edge) : std::nullopt;
  };
  const auto flipped = [&](const Edge& edge) -> std::optional<Change> {
    std::optional<Patch> patch = mesh.flip(edge[0], edge[1]);
    const bool fits = patch &&
                      leaves_valence(mesh, patch->removed, edge[0], edge[1], most_valence) &&
                      !guard.too_near(mesh, *patch);
    return fits ? rounder(std::move(*patch), edge) : std::nullopt;
  };
  const auto moved = [&](Index v) { // from amid its neighbors: a needle has no way to go
    const std::vector<Index> neighbors = mesh.neighbors(v);
    Vec3 middle = Vec3::Zero();
    for (const Index w : neighbors) {
      middle += mesh.position(w) / static_cast<double>(neighbors.size());
    }
    if (mesh.on_plane(v)) {
      middle.x() = 0;
    }
    return placed(mesh.move(v, middle), {v, v});
  };
  std::size_t total = 0;
  for (;;) {
    values = objective.face_values(mesh);
    std::vector<Triangle> needles;
    for (Index f = 0; f < mesh.face_end(); ++f) {
      if (mesh.has_face(f) && is_needle(corners_of(mesh, f), least, objective.diagonal())) {
        needles.push_back(mesh.face(f));
      }
    }
    std::size_t made = make(cage, guard, ranked(sides_of(needles), collapsed), needles.size());
    if (made == 0) {
      made = make(cage, guard, ranked(sides_of(needles), flipped), needles.size());
    }
    if (made == 0) {
      made = make(cage, guard, ranked(corners_of(needles), moved), needles.size());
    }
    total += made;
    if (made == 0) {
      return total;
    }
  }
}

} // namespace cagewright
