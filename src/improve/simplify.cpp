#include "improve/simplify.h"

#include "core/parallel.h"
#include "improve/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

namespace cagewright {

namespace {

using Edge = std::array<Index, 2>;

struct Candidate {
  double cost = 0; // or a guess at it, if it is not evaluated
  Edge edge{};
  std::uint32_t entry = 0; // the edge's latest is the one that counts
  bool evaluated = false;
  std::array<std::uint32_t, 2> stamps{};
  Vec3 position = Vec3::Zero();

  // The cheapest on top; the numbers of the vertices make the order total.
  bool operator<(const Candidate& other) const {
    return cost != other.cost ? cost > other.cost : edge > other.edge;
  }
};

class Simplifier {
public:
  Simplifier(WorkingCage& cage, const Guard& guard, const Objective& objective,
             const SimplifyOptions& options)
      : cage_(cage), guard_(guard), objective_(objective), options_(options),
        stamps_(cage.mesh.vertex_end(), 0), failed_(cage.mesh.vertex_end()) {}

  bool run(const Progress& progress) {
    progress_ = progress.quiet();
    const std::size_t start = cage_.mesh.vertex_count();
    if (start > options_.vertices && options_.placement == Placement::clear_of_model) {
      values_ = objective_.face_values(cage_.mesh, progress);
    }
    if (start > options_.vertices && !progress.cancelled()) {
      // Where a few of many edges are to go it is enough to look at the most promising.
      const bool few =
          options_.placement == Placement::clear_of_model && start < 2 * options_.vertices;
      few ? guess_all() : offer(all_edges());
    }
    while (cage_.mesh.vertex_count() > options_.vertices) {
      if (progress.cancelled()) {
        return false;
      }
      if (queue_.empty() && !retry()) {
        break;
      }
      take_next();
      const std::size_t done = start - cage_.mesh.vertex_count();
      progress(static_cast<double>(done) / static_cast<double>(start - options_.vertices),
               "simplify");
    }
    return true;
  }

private:
  [[nodiscard]] std::vector<Edge> all_edges() const {
    std::vector<Edge> edges;
    for (Index f = 0; f < cage_.mesh.face_end(); ++f) {
      if (cage_.mesh.has_face(f)) {
        const Triangle& t = cage_.mesh.face(f);
        for (int i = 0; i < 3; ++i) {
          const Index a = t[i];
          const Index b = t[(i + 1) % 3];
          if (a < b || cage_.mesh.face_left_of(b, a) == no_index) {
            edges.push_back({std::min(a, b), std::max(a, b)});
          }
        }
      }
    }
    return edges;
  }

  // Evaluates the edges and puts those that can go in the queue.
  void offer(const std::vector<Edge>& edges) {
    std::vector<std::optional<Candidate>> candidates(edges.size());
    parallel_for(0, edges.size(), 1, progress_,
                 [&](std::size_t i) { candidates[i] = evaluate(edges[i]); });
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (candidates[i]) {
        push(*candidates[i]);
      } else {
        failed_[edges[i][0]].push_back(edges[i]);
        failed_[edges[i][1]].push_back(edges[i]);
      }
    }
  }

  // Puts all edges in the queue at a guess. Those that are far from the cheapest never need more.
  void guess_all() {
    const std::vector<Edge> edges = all_edges();
    std::vector<std::optional<double>> costs(edges.size());
    parallel_for(0, edges.size(), 4, progress_,
                 [&](std::size_t i) { costs[i] = quick_guess(edges[i]); });
    std::vector<Edge> unknown;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (costs[i]) {
        guess(edges[i], *costs[i]);
      } else {
        unknown.push_back(edges[i]);
      }
    }
    offer(unknown);
  }

  // The objective's change when the vertex is outside the old faces: it can do better than that.
  [[nodiscard]] std::optional<double> quick_guess(const Edge& edge) const {
    constexpr double hope = 0.5;
    std::optional<Patch> patch = cage_.mesh.collapse(edge[0], edge[1]);
    const std::optional<Vec3> position =
        patch ? place_outside_patch(cage_.mesh, *patch) : std::nullopt;
    if (!position) {
      return std::nullopt;
    }
    patch->position = *position;
    const double change = objective_.change(cage_.mesh, values_, *patch);
    return (change > 0 ? hope : 1) * for_each_vertex(change, patch->gone);
  }

  // Of half a cage, for each vertex of the whole that it saves.
  [[nodiscard]] double for_each_vertex(double cost, Index gone) const {
    return cage_.mesh.is_half() && cost > 0
               ? cost * 2 / static_cast<double>(cage_.mesh.copies(gone))
               : cost;
  }

  void push(Candidate candidate) {
    Known& known = known_[key(candidate.edge)];
    candidate.entry = ++known.entry;
    if (candidate.evaluated) {
      known.cost = candidate.cost;
    }
    queue_.push(candidate);
  }

  // Puts an edge in the queue that is to be evaluated only when it comes to the top.
  void guess(const Edge& edge, double cost) { push({.cost = cost, .edge = edge}); }

  static std::uint64_t key(const Edge& edge) { return std::uint64_t{edge[0]} << 32U | edge[1]; }

  [[nodiscard]] double known_cost(Index a, Index b, double otherwise) const {
    const auto it = known_.find(key({std::min(a, b), std::max(a, b)}));
    return it != known_.end() && it->second.cost ? *it->second.cost : otherwise;
  }

  [[nodiscard]] bool is_edge(const Edge& edge) const {
    return cage_.mesh.has_vertex(edge[0]) && cage_.mesh.has_vertex(edge[1]) &&
           cage_.mesh.has_edge(edge[0], edge[1]);
  }

  [[nodiscard]] std::optional<Candidate> evaluate(const Edge& edge) const {
    std::optional<Patch> patch = cage_.mesh.collapse(edge[0], edge[1]);
    if (!patch || !fits_valence(*patch)) {
      return std::nullopt;
    }
    const std::optional<Vec3> position =
        options_.placement == Placement::outside_patch
            ? place_outside_patch(cage_.mesh, *patch)
            : place_clear_of_model(guard_, objective_, cage_.mesh, *patch);
    if (!position) {
      return std::nullopt;
    }
    patch->position = *position;
    if (!keeps_shape(cage_.mesh, *patch, options_.limits) ||
        guard_.loses_a_part(cage_.mesh, *patch) || objective_.widens_gap(cage_.mesh, *patch)) {
      return std::nullopt;
    }
    const double cost = options_.placement == Placement::outside_patch
                            ? quick_cost(*patch)
                            : objective_.change(cage_.mesh, values_, *patch);
    return Candidate{.cost = for_each_vertex(cost, patch->gone),
                     .edge = edge,
                     .evaluated = true,
                     .stamps = {stamps_[edge[0]], stamps_[edge[1]]},
                     .position = *position};
  }

  [[nodiscard]] bool fits_valence(const Patch& patch) const {
    return cage_.mesh.sides(patch.vertex) * patch.added.size() <= options_.most_valence;
  }

  // Volume and shape only, with the emphasis at the new vertex.
  [[nodiscard]] double quick_cost(const Patch& patch) const {
    double cost = Objective::volume_change(cage_.mesh, patch);
    const double weight = objective_.shape_weight();
    for (const Index f : patch.removed) {
      const double x = shape_defect(corners_of(cage_.mesh, f));
      cost -= weight * x * x;
    }
    for (const Triangle& t : patch.added) {
      const double x = shape_defect(corners_after(cage_.mesh, patch, t));
      cost += weight * x * x;
    }
    if (!objective_.weights().emphasis.empty()) {
      cost *= objective_.emphasis(objective_.nearest(patch.position));
    }
    return cost;
  }

  // The cheapest candidate is collapsed, unless its surroundings have changed since it was
  // evaluated: then it is evaluated again, along with others near the top for which that holds.
  void take_next() {
    constexpr std::size_t batch = 8;
    std::vector<Edge> stale;
    while (!queue_.empty() && stale.size() < batch) {
      const Candidate best = queue_.top();
      if (best.entry != known_[key(best.edge)].entry || !is_edge(best.edge)) {
        queue_.pop();
        continue;
      }
      const auto& [u, v] = best.edge;
      const bool fresh = best.evaluated && best.stamps == std::array{stamps_[u], stamps_[v]};
      if (fresh && stale.empty()) {
        queue_.pop();
        take(best);
        return;
      }
      if (fresh) {
        break;
      }
      queue_.pop();
      stale.push_back(best.edge);
    }
    offer(stale);
  }

  void take(const Candidate& candidate) {
    const auto& [u, v] = candidate.edge;
    Patch patch = *cage_.mesh.collapse(u, v);
    patch.position = candidate.position;
    // Any other part of the cage may have moved here since.
    if (guard_.crosses(cage_.mesh, cage_.boxes, patch)) {
      failed_[u].push_back(candidate.edge);
      failed_[v].push_back(candidate.edge);
      return;
    }
    const std::vector<Index> added = cage_.apply(patch);
    const Index kept = patch.vertex;
    ++stamps_[patch.gone];
    if (!values_.empty()) {
      parallel_for(0, added.size(), 1, progress_, [&](std::size_t i) {
        values_[added[i]] = objective_.face(corners_of(cage_.mesh, added[i]));
      });
    }
    changed_ = true;
    touch(kept, candidate.cost);
    for (const Index w : cage_.mesh.neighbors(kept)) {
      touch(w, candidate.cost);
      // Costs rise as the cage gets coarser: what was known of the edge is a fair lower bound.
      const double cost = known_cost(kept, w, candidate.cost);
      guess({std::min(kept, w), std::max(kept, w)},
            std::min(cost, known_cost(patch.gone, w, cost)));
    }
  }

  // The faces at v have changed: its failed edges get another chance, though not at once.
  void touch(Index v, double cost) {
    ++stamps_[v];
    for (const Edge& edge : std::exchange(failed_[v], {})) {
      if (is_edge(edge)) {
        guess(edge, cost + std::abs(cost) / 2);
      }
    }
  }

  // All edges once more, if any has been collapsed since the last time.
  bool retry() {
    constexpr int most_retries = 3;
    if (!std::exchange(changed_, false) || ++retries_ > most_retries) {
      return false;
    }
    for (auto& list : failed_) {
      list.clear();
    }
    offer(all_edges());
    return !queue_.empty();
  }

  WorkingCage& cage_;
  const Guard& guard_;
  const Objective& objective_;
  SimplifyOptions options_;
  std::vector<double> values_;        // of the faces, by number: their parts of the objective
  std::vector<std::uint32_t> stamps_; // of a vertex: how often the faces at it have changed
  std::vector<std::vector<Edge>> failed_;
  struct Known {
    std::optional<double> cost; // when it could last be collapsed
    std::uint32_t entry = 0;    // in the queue; earlier ones are void
  };
  std::unordered_map<std::uint64_t, Known> known_; // looked up only, never gone through
  std::priority_queue<Candidate> queue_;
  Progress progress_;    // of the run
  bool changed_ = false; // since all edges were last offered
  int retries_ = 0;
};

} // namespace

std::vector<Index> WorkingCage::apply(const Patch& patch) {
  std::vector<Index> added = mesh.apply(patch);
  for (const Index f : patch.removed) {
    boxes.update(mesh, f);
  }
  for (const Index f : added) {
    boxes.update(mesh, f);
  }
  return added;
}

bool simplify(WorkingCage& cage, const Guard& guard, const Objective& objective,
              const SimplifyOptions& options, const Progress& progress) {
  return Simplifier(cage, guard, objective, options).run(progress);
}

bool keeps_shape(const CageMesh& cage, const Patch& patch, const ShapeLimits& limits) {
  double old_bend = 1;
  double old_defect = 0;
  double old_quality = 1;
  for (const Index f : patch.removed) {
    const Triangle& t = cage.face(f);
    const Corners at = corners_of(cage, f);
    old_defect = std::max(old_defect, shape_defect(at));
    old_quality = std::min(old_quality, shape_quality(at));
    for (int i = 0; i < 3; ++i) {
      old_bend = std::min(old_bend, bend(at, corners_across(cage, at, t[(i + 1) % 3], t[i])));
    }
  }
  const double least_bend = std::min(limits.sharpest_bend, old_bend);
  const double most_defect = std::max(limits.worst_defect, old_defect);
  const double least_quality = std::min(limits.least_quality, old_quality);
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    const Triangle& t = patch.added[i];
    const Corners at = corners_after(cage, patch, t);
    if (shape_defect(at) > most_defect || shape_quality(at) < least_quality) {
      return false;
    }
    for (int k = 0; k < 3; ++k) {
      const Index a = t[(k + 1) % 3];
      const Index b = t[k];
      // Across the edge there is another new face, or an old one that stays.
      bool found = false;
      for (std::size_t j = 0; j < patch.added.size() && !found; ++j) {
        const Triangle& s = patch.added[j];
        for (int m = 0; m < 3 && !found; ++m) {
          found = s[m] == a && s[(m + 1) % 3] == b;
        }
        if (found && bend(at, corners_after(cage, patch, s)) < least_bend) {
          return false;
        }
      }
      if (!found) {
        if (cage.on_plane(patch, a) && cage.on_plane(patch, b)) { // the boundary
          if (bend(at, mirrored(at)) < least_bend) {
            return false;
          }
          continue;
        }
        const Index outer = cage.face_left_of(a, b);
        if (outer != no_index && bend(at, corners_of(cage, outer)) < least_bend) {
          return false;
        }
      }
    }
  }
  return true;
}

} // namespace cagewright
