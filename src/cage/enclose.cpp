#include "cage/enclose.h"

#include "core/parallel.h"
#include "improve/block_program.h"
#include "improve/face_terms.h"
#include "mesh/solid_angle.h"
#include "quads/quad_shape.h"
#include "spatial/bvh.h"
#include "spatial/distance.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr int most_steps = 150;
constexpr int patience = 25; ///< so many steps without progress are enough
/// A vertex moves no further in one step, in diagonals.
constexpr double reach = 0.03;
/// Places are asked to lie deeper inside than the clearance: what a step errs by, being linear.
constexpr double margin = 1.6;
/// The pull back to where a vertex is, in springs of its edges.
constexpr double anchor = 0.02;
/// In each of so many small triangles along a side, the place that needs most is heeded.
constexpr int cells = 4;
constexpr std::size_t cells_of_face = cells * cells;

using Positions = std::vector<Vec3>;

/// A point that the cage has to enclose.
struct Place {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero(); ///< of the model there, outward; zero: not known
  double safe = 0; ///< so far the cage's vertices may move before it has to be looked at again
};

/// Of each vertex, outward, not of length one: also where the model is turned inside out as a
/// whole.
Positions normals_of(TriangleView model) {
  Positions normals(model.positions.size(), Vec3::Zero());
  const Vec3 center = bounding_box(model).center();
  double volume = 0;
  for (const Triangle& t : model.triangles) {
    const Vec3 a = model.positions[t[0]] - center;
    const Vec3 b = model.positions[t[1]] - center;
    const Vec3 c = model.positions[t[2]] - center;
    volume += a.dot(b.cross(c));
    for (const Index v : t) {
      normals[v] += (b - a).cross(c - a);
    }
  }
  for (Vec3& n : normals) {
    n *= volume < 0 ? -1 : 1;
  }
  return normals;
}

/// What a place asks of the triangle of the cage that it is nearest to.
struct Demand {
  double need = -1; ///< how much further out the triangle should be there; negative: may come in
  Index triangle = no_index; ///< of its cutting
  int cutting = 0;
  Vec3 direction = Vec3::Zero(); ///< outward
  std::array<double, 3> weight{};
  std::size_t place = 0;
};

class Enclosing {
public:
  Enclosing(QuadCage& cage, const QuadGuard& guard, TriangleView model)
      : cage_(cage), guard_(guard), unit_(guard.model().diagonal), at_(cage.positions()),
        rest_(cage.positions()) {
    for (Index v = 0; v < cage.vertex_end(); ++v) {
      number_.push_back(cage.around(v).empty() ? no_index : living_++);
    }
    for (Index f = 0; f < cage.face_end(); ++f) {
      const FaceParts parts(cage.face(f), FaceParts::Of::all);
      for (int cutting = 0; cutting < 2; ++cutting) {
        const int first = parts.count == 4 ? 2 * cutting : 0;
        const int count = parts.count == 4 ? 2 : parts.count;
        for (int k = first; k < first + count; ++k) {
          cut_[cutting].triangles.push_back(parts.triangles[k]);
        }
      }
      has_quads_ = has_quads_ || cage.face(f).is_quad();
    }
    middle_ = bounding_box(model).center();
    const Positions normals = normals_of(model);
    for (std::size_t v = 0; v < normals.size(); ++v) {
      places_.push_back({model.positions[v], normals[v], 0});
    }
  }

  EncloseReport run(const Progress& progress) {
    part_crossing_faces();
    take_up_the_model();
    rest_ = at_;
    constexpr std::array rules = {Matching::nearest, Matching::alike};
    constexpr auto tries = static_cast<double>(rules.size());
    EncloseReport best;
    Positions reached = at_;
    for (std::size_t k = 0; k < rules.size() && !best.encloses; ++k) {
      matching_ = rules[k];
      at_ = rest_;
      for (Place& place : places_) {
        place.safe = 0;
      }
      const EncloseReport report = step_by_step(
          progress.part(static_cast<double>(k) / tries, (static_cast<double>(k) + 1) / tries));
      if (k == 0 || report.encloses || report.outside < best.outside) {
        best = report;
        reached = at_;
      }
    }
    cage_.set_positions(reached);
    return best;
  }

private:
  /// What a place outside the cage is held against: the nearest face, or the nearest of those that
  /// face as the model does there. A limb may have left its part of the cage on one side: then it
  /// is not the side that is nearest that has to move. Where limbs are near each other that may be
  /// another limb's.
  enum class Matching { nearest, alike };

  EncloseReport step_by_step(const Progress& progress) {
    EncloseReport report;
    double least = std::numeric_limits<double>::infinity();
    int since = 0;
    for (int step = 0; step < most_steps && since < patience && !progress.cancelled(); ++step) {
      progress(static_cast<double>(step) / most_steps, "enclose");
      const std::vector<Demand> demands = measure();
      double worst = 0;
      report.outside = 0;
      for (const Demand& d : demands) {
        if (d.need > (margin - 1) * guard_.clearance()) {
          ++report.outside;
        }
        if (d.need > worst) {
          worst = d.need;
          report.farthest = places_[d.place].point;
        }
      }
      if (report.outside == 0) {
        report.outside = add_touching();
        if (report.outside == 0) {
          report.encloses = true;
          report.farthest.reset();
          break;
        }
        least = std::numeric_limits<double>::infinity();
        since = std::max(0, since - 1);
        continue;
      }
      constexpr double progress_made = 0.99;
      since = worst < progress_made * least ? 0 : since + 1;
      least = std::min(least, worst);
      move_to(valid_part(pushed(demands)));
    }
    return report;
  }

  /// Moves the cage as a whole, and stretches it along the axes, to where it lies most evenly off
  /// the model: point to plane (Chen and Medioni, "Object modelling by registration of multiple
  /// range images", 1992), the distance being unknown. That spares the net what bends it most.
  void take_up_the_model() {
    constexpr int most_rounds = 30;
    constexpr double worth_it = 0.9;
    const Positions given = at_;
    double first = 0;
    double spread = 0;
    for (int round = 0; round < most_rounds; ++round) {
      const Registration found = registration();
      spread = found.spread;
      first = round == 0 ? spread : first;
      const double change = move_as_a_whole(found);
      constexpr double settled = 1e-4;
      if (change < settled) {
        break;
      }
    }
    if (!(spread < worth_it * first) ||
        std::any_of(at_.begin(), at_.end(), [](const Vec3& p) { return !p.allFinite(); })) {
      at_ = given;
    }
  }

  struct Registration {
    Vec3 stretch = Vec3::Zero(); ///< about the middle of the model; 0: as it is
    Vec3 shift = Vec3::Zero();
    double spread = 0; ///< root of the mean square of the distances off their mean, capped
  };

  [[nodiscard]] Registration registration() {
    constexpr std::size_t most_places = 2000;
    const std::size_t every = 1 + places_.size() / most_places;
    cut_[0].positions = at_;
    const TriangleBvh tree(cut_[0]);
    struct Pair {
      Vec3 at = Vec3::Zero(); ///< of the cage
      Vec3 normal = Vec3::Zero();
      double outside = 0;
    };
    std::vector<Pair> pairs(places_.size() / every);
    parallel_for(0, pairs.size(), 16, [&](std::size_t i) {
      const Place& place = places_[i * every];
      const NearestPoint nearest =
          facing_alike(place, tree.nearest(place.point), tree, Side::either);
      if (nearest) {
        const Vec3 normal = normal_of(tree.corners(nearest.triangle));
        pairs[i] = {nearest.point, normal, normal.dot(place.point - nearest.point)};
      }
    });
    std::erase_if(pairs, [](const Pair& pair) { return !(pair.normal.norm() > 0.5); });
    if (pairs.empty()) {
      return {};
    }
    std::vector<double> sorted;
    for (const Pair& pair : pairs) {
      sorted.push_back(pair.outside);
    }
    std::sort(sorted.begin(), sorted.end());
    const double median = sorted[sorted.size() / 2];
    const double cap =
        2 * (sorted[sorted.size() * 3 / 4] - sorted[sorted.size() / 4]) + guard_.clearance();
    using Row = Eigen::Matrix<double, 7, 1>;
    Eigen::Matrix<double, 7, 7> normal_matrix = Eigen::Matrix<double, 7, 7>::Zero();
    Row right = Row::Zero();
    double squares = 0;
    for (const Pair& pair : pairs) {
      const double off = std::abs(pair.outside - median);
      squares += std::min(off, cap) * std::min(off, cap);
      const double weight = off < cap ? 1 : cap / off;
      const Vec3 arm = (pair.at - middle_).cwiseProduct(pair.normal);
      Row row;
      row << arm, unit_ * pair.normal, unit_; // stretch, shift and distance, all without unit
      normal_matrix += weight * row * row.transpose();
      right += weight * pair.outside * row;
    }
    // What the places do not tell stays as it is.
    constexpr double stiffness = 1e-3;
    normal_matrix += stiffness * static_cast<double>(pairs.size()) * unit_ * unit_ *
                     Eigen::Matrix<double, 7, 7>::Identity();
    const Row x = normal_matrix.ldlt().solve(right);
    return {x.head<3>(), unit_ * x.segment<3>(3),
            std::sqrt(squares / static_cast<double>(pairs.size()))};
  }

  /// \returns how far it moved, in diagonals
  double move_as_a_whole(const Registration& by) {
    constexpr double most = 0.2; // in one round
    const Vec3 stretch = Vec3::Ones() + by.stretch.cwiseMax(-most).cwiseMin(most);
    double longest = 0;
    for (Vec3& p : at_) {
      const Vec3 next = middle_ + stretch.cwiseProduct(p - middle_) + by.shift;
      longest = std::max(longest, (next - p).norm());
      p = next;
    }
    return longest / unit_;
  }

  /// The worst place of each cell of each triangle, of those that ask for something or soon may.
  std::vector<Demand> measure() {
    const double target = margin * guard_.clearance();
    const double soon = reach * unit_;
    const int cuttings = has_quads_ ? 2 : 1;
    std::array<TriangleBvh, 2> trees;
    for (int c = 0; c < cuttings; ++c) {
      cut_[c].positions = at_;
      trees[c] = TriangleBvh(cut_[c]);
    }
    std::vector<std::array<Demand, 2>> asked(places_.size());
    parallel_for(0, places_.size(), 64, [&](std::size_t i) {
      Place& place = places_[i];
      if (place.safe > 0) {
        return;
      }
      double depth = std::numeric_limits<double>::infinity();
      for (int c = 0; c < cuttings; ++c) {
        Demand d = demand_of(place, trees[c], c);
        depth = std::min(depth, -d.need);
        d.need += target;
        d.place = i;
        asked[i][c] = d;
      }
      place.safe = depth - target - soon;
    });
    std::vector<Demand> worst(2 * cut_[0].triangles.size() * cells_of_face);
    for (const auto& pair : asked) {
      for (int c = 0; c < cuttings; ++c) {
        const Demand& d = pair[c];
        if (d.triangle == no_index || d.need < -soon) {
          continue;
        }
        Demand& kept = worst[cell_of(d)];
        if (kept.triangle == no_index || d.need > kept.need) {
          kept = d;
        }
      }
    }
    std::erase_if(worst, [](const Demand& d) { return d.triangle == no_index; });
    return worst;
  }

  [[nodiscard]] std::size_t cell_of(const Demand& d) const {
    const auto step = [](double weight) {
      return std::clamp(static_cast<int>(weight * cells), 0, cells - 1);
    };
    const auto cell = static_cast<std::size_t>(step(d.weight[0]) * cells + step(d.weight[1]));
    return (static_cast<std::size_t>(d.cutting) * cut_[0].triangles.size() + d.triangle) *
               cells_of_face +
           cell;
  }

  /// `need` is how far outside the place is.
  [[nodiscard]] Demand demand_of(const Place& place, const TriangleBvh& tree, int cutting) const {
    Demand d;
    d.cutting = cutting;
    NearestPoint nearest = tree.nearest(place.point);
    if (!nearest) {
      return d;
    }
    const bool is_inside = lies_inside(place.point, nearest, tree, cutting);
    if (!is_inside && matching_ == Matching::alike) {
      nearest = facing_alike(place, nearest, tree, Side::outer);
    }
    const Vec3(&t)[3] = tree.corners(nearest.triangle);
    d.triangle = nearest.triangle;
    d.weight = barycentric(nearest.point, Corners{{t[0], t[1], t[2]}});
    constexpr double touching = 1e-9;
    d.direction =
        nearest.distance > touching * unit_
            ? Vec3((is_inside ? -1 : 1) / nearest.distance * (place.point - nearest.point))
            : normal_of(t);
    d.need = is_inside ? -nearest.distance : nearest.distance;
    return d;
  }

  static Vec3 normal_of(const Vec3 (&t)[3]) {
    return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  }

  /// Over the middle of a face its normal tells the sides apart, at edges the winding number does.
  [[nodiscard]] bool lies_inside(const Vec3& p, const NearestPoint& nearest,
                                 const TriangleBvh& tree, int cutting) const {
    const Vec3(&t)[3] = tree.corners(nearest.triangle);
    constexpr double inner = 1e-9;
    const auto weights = barycentric(nearest.point, Corners{{t[0], t[1], t[2]}});
    const bool is_over_face =
        std::all_of(weights.begin(), weights.end(), [](double weight) { return weight > inner; });
    return is_over_face ? (p - nearest.point).dot(normal_of(t)) < 0 : is_wound_round(p, cutting);
  }

  /// Of a face, where a place may be.
  enum class Side { outer, either };

  /// The nearest point of the faces that face as the model does there, if it is not much farther.
  [[nodiscard]] NearestPoint facing_alike(const Place& place, const NearestPoint& nearest,
                                          const TriangleBvh& tree, Side side) const {
    constexpr double alike = 0.3;        // times the lengths of the normals: 73 degrees
    constexpr double much_farther = 0.1; // diagonals
    NearestPoint best;
    best.distance = nearest.distance + much_farther * unit_;
    const double size = place.normal.norm();
    const auto faces_alike = [&](const Vec3(&t)[3]) {
      return place.normal.dot(normal_of(t)) > alike * size;
    };
    if (!(size > 0) || faces_alike(tree.corners(nearest.triangle))) {
      return nearest;
    }
    for (Index f = 0; f < tree.triangle_count(); ++f) {
      const Vec3(&t)[3] = tree.corners(f);
      if (!faces_alike(t)) {
        continue;
      }
      const Vec3 q = nearest_on_triangle(place.point, t[0], t[1], t[2]);
      const double distance = (place.point - q).norm();
      const bool is_on_side = side == Side::either || (place.point - q).dot(normal_of(t)) > 0;
      if (distance < best.distance && is_on_side) {
        best = {distance, q, f};
      }
    }
    return best ? best : nearest;
  }

  [[nodiscard]] bool is_wound_round(const Vec3& p, int cutting) const {
    double angle = 0;
    for (const Triangle& t : cut_[cutting].triangles) {
      angle += solid_angle(p, at_[t[0]], at_[t[1]], at_[t[2]]);
    }
    return angle > 2 * std::numbers::pi;
  }

  /// The vertices are enough only where the cage's edges do not poke into faces of the model: adds
  /// the points where they do, and those that stand out most over the faces concerned.
  /// \returns how many faces of the cage touch the model or are too near
  std::size_t add_touching() {
    const SurfaceTree& tree = guard_.model().tree;
    std::size_t touching = 0;
    for (const TriangleMesh& cut : cut_) {
      for (const Triangle& t : cut.triangles) {
        const Corners corners{{at_[t[0]], at_[t[1]], at_[t[2]]}};
        const auto pair = tree.nearest_to(corners, guard_.clearance());
        if (!pair) {
          continue;
        }
        ++touching;
        places_.push_back({pair->on_b});
        const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if (!(area.norm() > 0)) {
          continue;
        }
        for (const SurfaceTree::Relief& r :
             tree.relief(corners, cells, -guard_.clearance(), reach * unit_)) {
          places_.push_back({(1 - r.at_b - r.at_c) * corners[0] + r.at_b * corners[1] +
                             r.at_c * corners[2] + r.height * area.normalized()});
        }
      }
      if (!has_quads_) {
        break;
      }
    }
    return touching;
  }

  /// Smooths the cage where its faces cross, until they do not or that does not help.
  void part_crossing_faces() {
    constexpr int most_rounds = 50;
    const Positions given = at_;
    for (int round = 0;; ++round) {
      const std::vector<std::uint8_t> is_crossed = crossed(at_);
      if (std::none_of(is_crossed.begin(), is_crossed.end(),
                       [](std::uint8_t is) { return is != 0; })) {
        break;
      }
      if (round == most_rounds) {
        at_ = given;
        return;
      }
      std::vector<std::uint8_t> moves(at_.size(), 0);
      for (Index f = 0; f < cage_.face_end(); ++f) {
        for (const Index v : cage_.face(f).span()) {
          moves[v] = moves[v] != 0 || is_crossed[f] != 0 ? 1 : 0;
        }
      }
      Positions next = at_;
      for (Index v = 0; v < at_.size(); ++v) {
        if (moves[v] != 0) {
          next[v] = 0.5 * (at_[v] + middle_of_neighbors(v));
        }
      }
      at_ = std::move(next);
    }
  }

  [[nodiscard]] Vec3 middle_of_neighbors(Index v) const {
    Vec3 sum = Vec3::Zero();
    for (const Index f : cage_.around(v)) {
      const CageFace& face = cage_.face(f);
      for (int k = 0; k < face.size; ++k) {
        if (face[k] == v) {
          sum += at_[face[k + 1]]; // each neighbour is next in one face
        }
      }
    }
    return sum / static_cast<double>(cage_.around(v).size());
  }

  /// The positions after one quadratic program.
  [[nodiscard]] Positions pushed(const std::vector<Demand>& demands) const {
    BlockQuadratic quadratic(living_);
    const auto spring = [&](Index a, Index b) {
      const Vec3 stretch = ((at_[a] - rest_[a]) - (at_[b] - rest_[b])) / unit_;
      const Index i = number_[a];
      const Index j = number_[b];
      quadratic.gradient[i] += stretch;
      quadratic.gradient[j] -= stretch;
      quadratic.terms.push_back({i, i, Mat3::Identity()});
      quadratic.terms.push_back({j, j, Mat3::Identity()});
      quadratic.terms.push_back({std::max(i, j), std::min(i, j), -Mat3::Identity()});
    };
    for (Index f = 0; f < cage_.face_end(); ++f) {
      const CageFace& face = cage_.face(f);
      for (int k = 0; k < face.size; ++k) {
        if (face[k] < face[k + 1]) {
          spring(face[k], face[k + 1]);
        }
      }
    }
    for (Index i = 0; i < living_; ++i) {
      quadratic.terms.push_back({i, i, anchor * Mat3::Identity()});
    }
    std::vector<BlockConstraint> constraints;
    for (const Demand& d : demands) {
      const Triangle& t = cut_[d.cutting].triangles[d.triangle];
      constraints.push_back({{number_[t[0]], number_[t[1]], number_[t[2]]},
                             d.weight,
                             d.direction,
                             std::min(d.need / unit_, 0.7 * reach)});
    }
    const std::vector<Vec3> steps = minimize(quadratic, constraints);
    double longest = 0;
    for (const Vec3& step : steps) {
      longest = std::max(longest, step.norm());
    }
    const double share = longest > reach ? reach / longest : 1;
    Positions next = at_;
    for (Index v = 0; v < number_.size(); ++v) {
      if (number_[v] != no_index) {
        next[v] += share * unit_ * steps[number_[v]];
      }
    }
    return next;
  }

  [[nodiscard]] std::vector<std::uint8_t> crossed(const Positions& at) const {
    const std::vector<Box3> boxes = face_boxes(cage_, at);
    std::vector<std::uint8_t> result(cage_.face_end(), 0);
    parallel_for(0, result.size(), 1, [&](std::size_t f) {
      const auto index = static_cast<Index>(f);
      result[f] =
          static_cast<std::uint8_t>(guard_.is_crossed(cage_, at, boxes, cage_.face(index), index));
    });
    return result;
  }

  /// As much of the way as makes no more faces cross: the corners of such faces go half of their
  /// way, again and again, and in the end nowhere.
  [[nodiscard]] Positions valid_part(const Positions& goal) const {
    const std::vector<std::uint8_t> before = crossed(at_);
    std::vector<double> share(at_.size(), 1);
    Positions next = goal;
    for (;;) {
      const std::vector<std::uint8_t> after = crossed(next);
      bool is_good = true;
      std::vector<std::uint8_t> yields(at_.size(), 0);
      for (Index f = 0; f < cage_.face_end(); ++f) {
        if (after[f] != 0 && before[f] == 0) {
          for (const Index v : cage_.face(f).span()) {
            is_good = is_good && share[v] == 0;
            yields[v] = 1;
          }
        }
      }
      if (is_good) {
        return next;
      }
      for (Index v = 0; v < at_.size(); ++v) {
        if (yields[v] != 0) {
          constexpr double least = 0.1;
          share[v] = share[v] > least ? share[v] / 2 : 0;
          next[v] = at_[v] + share[v] * (goal[v] - at_[v]);
        }
      }
    }
  }

  void move_to(const Positions& next) {
    double longest = 0;
    for (std::size_t v = 0; v < at_.size(); ++v) {
      longest = std::max(longest, (next[v] - at_[v]).norm());
    }
    at_ = next;
    for (Place& place : places_) {
      place.safe -= longest;
    }
  }

  QuadCage& cage_;
  const QuadGuard& guard_;
  double unit_;
  Vec3 middle_ = Vec3::Zero(); ///< of the model
  Matching matching_ = Matching::nearest;
  Positions at_;
  Positions rest_;            ///< where the net of springs is at rest
  std::vector<Index> number_; // of each vertex, in the programs
  Index living_ = 0;
  std::array<TriangleMesh, 2> cut_; // along the first diagonals, and along the others
  bool has_quads_ = false;
  std::vector<Place> places_;
};

} // namespace

EncloseReport enclose(QuadCage& cage, const QuadGuard& guard, TriangleView model,
                      const Progress& progress) {
  return Enclosing(cage, guard, model).run(progress);
}

} // namespace cagewright
