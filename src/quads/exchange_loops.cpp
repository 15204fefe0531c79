#include "quads/exchange_loops.h"

#include "core/parallel.h"
#include "quads/edge_loops.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

namespace cagewright {
namespace {

/// A cage and what it costs.
struct Candidate {
  QuadCage cage;
  double value = 0;
  double price = 0; ///< less is better
};

class Exchange {
public:
  Exchange(const QuadGuard& guard, const Objective& objective, const ExchangeLoopsOptions& options)
      : guard_(guard), wide_(guard.model(), guard.clearance(), wide_limits(guard.limits())),
        objective_(objective), options_(options) {}

  Candidate run(const QuadCage& start, const Progress& progress) {
    progress_ = progress.quiet();
    // Vertices are numbered as those of to_polygons() from here on.
    Candidate now{QuadCage(start.to_polygons()), 0, 0};
    now.value = value_of(now.cage);
    while (!progress.cancelled() && excess(now.cage) > 0 && take_out(now)) {
    }
    fill(now, progress);
    settle(now, 2 * options_.settle);
    for (int round = 0; round < options_.rounds && !progress.cancelled(); ++round) {
      if (options_.dearest > 0 && now.value > options_.dearest) {
        break;
      }
      progress(static_cast<double>(round) / options_.rounds, "exchange edge loops");
      Candidate next = now;
      if (!put_in(next, 1.25)) {
        break;
      }
      while (!progress.cancelled() && excess(next.cage) > 0 && take_out(next)) {
      }
      fill(next, progress);
      settle(next, 2 * options_.settle);
      if (excess(next.cage) > 0 || next.value > 0.998 * now.value ||
          beyond_limits(next.cage) > beyond_limits(now.cage)) {
        break;
      }
      now = std::move(next);
    }
    return now;
  }

private:
  static QuadLimits wide_limits(QuadLimits limits) {
    limits.max_bend_degrees += 40;
    limits.min_angle_degrees /= 2;
    limits.max_angle_degrees += 10;
    limits.min_quality /= 2;
    return limits;
  }

  [[nodiscard]] long excess(const QuadCage& cage, double factor = 1) const {
    long most = 0;
    const auto over = [&](std::size_t count, std::size_t limit) {
      if (limit > 0) {
        const auto allowed = static_cast<long>(factor * static_cast<double>(limit));
        most = std::max(most, static_cast<long>(count) - allowed);
      }
    };
    over(whole_vertices(cage), options_.vertices);
    // A quad beyond the limits will be two triangles.
    const std::size_t unfit = beyond_limits(cage) * (cage.has_border() ? 2 : 1);
    over(whole_faces(cage) + unfit, options_.faces);
    return most;
  }

  [[nodiscard]] double value_of(QuadCage cage) const {
    RelaxQuadsOptions none = options_.relax;
    none.steps = 0;
    return relax_quads(cage, guard_, objective_, none);
  }

  void settle(Candidate& candidate, int steps) const {
    RelaxQuadsOptions relax = options_.relax;
    relax.steps = steps;
    candidate.value = relax_quads(candidate.cage, guard_, objective_, relax, progress_);
  }

  [[nodiscard]] std::size_t beyond_limits(const QuadCage& cage) const {
    std::size_t count = 0;
    for (Index f = 0; f < cage.face_end(); ++f) {
      const CageFace& face = cage.face(f);
      const bool unfit =
          face.is_quad() && !shape_of(corners_of(cage.positions(), face)).within(guard_.limits());
      count += unfit ? 1 : 0;
    }
    return count;
  }

  /// Of the faces at these vertices, those that may not stand. The others are as they were in the
  /// cage that this one was made of, which is valid: what crosses one of them is at such a vertex.
  [[nodiscard]] std::vector<Index> unfit_faces(const QuadCage& cage,
                                               std::span<const Index> vertices) const {
    std::vector<Index> faces;
    for (const Index v : vertices) {
      faces.insert(faces.end(), cage.around(v).begin(), cage.around(v).end());
    }
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    const std::vector<Box3> boxes = face_boxes(cage, cage.positions());
    std::erase_if(faces, [&](Index f) { return wide_.may_stand(cage, boxes, f); });
    return faces;
  }

  /// Whether the cage is valid with the vertices from `first_new` on, which were put in.
  [[nodiscard]] bool is_valid_with(const QuadCage& cage, Index first_new) const {
    std::vector<Index> added;
    for (Index v = first_new; v < cage.vertex_end(); ++v) {
      added.push_back(v);
    }
    return unfit_faces(cage, added).empty() &&
           !loses_a_part(guard_.model(), cage, cage.positions());
  }

  /// The best of the candidates after a few steps, by what each unit of budget costs or gains.
  ///
  /// \param may_be  asked of one after another until there are enough
  template <class Price, class MayBe>
  std::optional<Candidate> best_of(std::vector<Candidate>& candidates, const Price& price,
                                   const MayBe& may_be) const {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.price < b.price; });
    std::size_t kept = 0;
    for (std::size_t i = 0;
         i < candidates.size() && kept < static_cast<std::size_t>(options_.tries); ++i) {
      if (may_be(candidates[i].cage)) {
        std::swap(candidates[kept++], candidates[i]);
      }
    }
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(kept), candidates.end());
    parallel_for(0, candidates.size(), 1, progress_, [&](std::size_t i) {
      const bool is_unfit = beyond_limits(candidates[i].cage) > 0;
      settle(candidates[i], (is_unfit ? 2 : 1) * options_.settle);
      candidates[i].price = price(candidates[i]);
    });
    std::optional<Candidate> best;
    for (Candidate& candidate : candidates) {
      if (!best || candidate.price < best->price) {
        best = std::move(candidate);
      }
    }
    return best;
  }

  bool take_out(Candidate& now) const {
    // Off the model there is room to draw rungs together.
    Candidate roomy = now;
    RelaxQuadsOptions off = options_.relax;
    off.keep += options_.room;
    off.steps = 2;
    roomy.value = relax_quads(roomy.cage, wide_, objective_, off, progress_);
    const PolygonMesh mesh = roomy.cage.to_polygons();
    const std::size_t count = whole_vertices(roomy.cage);
    const auto saved = [&](const Candidate& c) {
      return static_cast<double>(count - whole_vertices(c.cage));
    };
    const std::vector<QuadStrip> strips = strips_of(mesh);
    std::vector<std::optional<Candidate>> found(strips.size());
    parallel_for(0, strips.size(), 1, progress_, [&](std::size_t i) {
      std::optional<QuadCage> cage = collapsed(mesh, roomy.cage, strips[i]);
      if (cage && whole_vertices(*cage) < count) {
        found[i] = Candidate{std::move(*cage), 0, 0};
        found[i]->value = value_of(found[i]->cage);
        found[i]->price = (found[i]->value - roomy.value) / saved(*found[i]);
      }
    });
    return adopt(
        found, [&](const Candidate& c) { return (c.value - now.value) / saved(c); }, now, true,
        [](const QuadCage&) { return true; });
  }

  bool put_in(Candidate& now, double factor) const {
    const PolygonMesh mesh = now.cage.to_polygons();
    const std::size_t count = whole_vertices(now.cage);
    const auto price = [&](const Candidate& c) {
      return (c.value - now.value) / static_cast<double>(whole_vertices(c.cage) - count);
    };
    const std::vector<QuadStrip> strips = strips_of(mesh);
    std::vector<std::optional<Candidate>> found(strips.size());
    parallel_for(0, strips.size(), 1, progress_, [&](std::size_t i) {
      Candidate candidate{QuadCage(split_strip(mesh, strips[i])), 0, 0};
      if (excess(candidate.cage, factor) > 0) {
        return;
      }
      candidate.price =
          -weight_of(mesh, strips[i]) / static_cast<double>(whole_vertices(candidate.cage) - count);
      found[i] = std::move(candidate);
    });
    const auto first_new = static_cast<Index>(mesh.positions.size());
    return adopt(found, price, now, factor > 1,
                 [&](const QuadCage& cage) { return is_valid_with(cage, first_new); });
  }

  template <class Price, class MayBe>
  bool adopt(std::vector<std::optional<Candidate>>& found, const Price& price, Candidate& now,
             bool at_any_price, const MayBe& may_be) const {
    std::vector<Candidate> candidates;
    for (std::optional<Candidate>& candidate : found) {
      if (candidate) {
        candidates.push_back(std::move(*candidate));
      }
    }
    std::optional<Candidate> best = best_of(candidates, price, may_be);
    if (!best || (!at_any_price && best->price >= 0)) {
      return false;
    }
    now = std::move(*best);
    return true;
  }

  void fill(Candidate& now, const Progress& progress) const {
    while (!progress.cancelled() && put_in(now, 1)) {
    }
  }

  /// What may be gained by a loop along the strip: the gaps below long rungs.
  [[nodiscard]] double weight_of(const PolygonMesh& mesh, const QuadStrip& strip) const {
    double sum = 0;
    for (const Index f : strip.faces) {
      const std::span<const Index> v = mesh.face(f);
      const QuadCorners q{mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]],
                          mesh.positions[v[3]]};
      const double area = (q[2] - q[0]).cross(q[3] - q[1]).norm() / 2;
      const Vec3 middle = (q[0] + q[1] + q[2] + q[3]) / 4;
      double gap = objective_.gap(objective_.nearest(middle));
      for (const Vec3& p : q) {
        gap += objective_.gap(objective_.nearest((p + middle) / 2));
      }
      sum += area * gap / 5;
    }
    return sum;
  }

  /// The cage without the strip, if it is valid: each rung drawn together half-way, or so much
  /// further out as its faces need.
  [[nodiscard]] std::optional<QuadCage> collapsed(const PolygonMesh& mesh, const QuadCage& cage,
                                                  const QuadStrip& strip) const {
    std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
    for (Index f = 0; f < cage.face_end(); ++f) {
      for (const Index v : cage.face(f).span()) {
        normals[v] += area_vector(cage.positions(), cage.face(f));
      }
    }
    std::vector<Vec3> places;
    std::vector<Vec3> ways;
    for (const auto& [a, b] : strip.rungs) {
      const Vec3& p = mesh.positions[a];
      const Vec3& q = mesh.positions[b];
      const bool border = cage.on_border(a) || cage.on_border(b);
      places.emplace_back((p + q) / 2);
      Vec3 n = normals[a] + normals[b];
      if (border) {
        n.x() = places.back().x() = 0;
      }
      n /= std::max(n.norm(), 1e-300);
      // First to the height of the higher end, or a tenth of the rung.
      const double length = (p - q).norm();
      ways.emplace_back(std::max(std::abs((p - q).dot(n)) / 2, length / 10) * n);
    }
    constexpr int most_steps = 6;
    for (int step = 0; step < most_steps; ++step) {
      std::vector<Index> drawn;
      const std::optional<PolygonMesh> less = collapse_strip(mesh, strip, places, drawn);
      if (!less) {
        return std::nullopt;
      }
      QuadCage result(*less);
      const std::vector<Index> unfit = unfit_faces(result, drawn);
      if (unfit.empty()) {
        if (loses_a_part(guard_.model(), result, result.positions())) {
          return std::nullopt;
        }
        return result;
      }
      bool any = false;
      for (std::size_t i = 0; i < drawn.size(); ++i) {
        if (std::any_of(unfit.begin(), unfit.end(),
                        [&](Index f) { return result.face(f).has(drawn[i]); })) {
          places[i] += ways[i];
          any = true;
        }
      }
      if (!any) {
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  const QuadGuard& guard_;
  QuadGuard wide_;
  const Objective& objective_;
  ExchangeLoopsOptions options_;
  Progress progress_; // of the run
};

} // namespace

double exchange_loops(QuadCage& cage, const QuadGuard& guard, const Objective& objective,
                      const ExchangeLoopsOptions& options, const Progress& progress) {
  Candidate result = Exchange(guard, objective, options).run(cage, progress);
  cage = std::move(result.cage);
  return result.value;
}

std::size_t whole_vertices(const QuadCage& cage) {
  std::size_t count = 0;
  for (Index v = 0; v < cage.vertex_end(); ++v) {
    if (!cage.around(v).empty()) {
      count += cage.has_border() && !cage.on_border(v) ? 2 : 1;
    }
  }
  return count;
}

std::size_t whole_faces(const QuadCage& cage) {
  std::size_t count = 0;
  for (Index f = 0; f < cage.face_end(); ++f) {
    count += cage.has_face(f) ? 1 : 0;
  }
  return cage.has_border() ? 2 * count : count;
}

} // namespace cagewright
