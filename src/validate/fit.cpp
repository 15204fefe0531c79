#include <cagewright/validate/fit.h>

#include "core/maths.h"
#include "core/parallel.h"
#include "mesh/solid_angle.h"
#include "spatial/distance.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t most_points = 300; // for finding a fit
constexpr std::size_t most_angles =
    4'000'000;                       // vertices times faces of the cage, for the place of a fit
constexpr double fits = 0.95;        // share of the model's vertices inside a cage that fits
constexpr double about_fits = 0.4;   // inside one that is meant to be where it is
constexpr double much_smaller = 0.8; // a unit that fits this much tighter is the right one
constexpr double far_too_large = 3;  // times the model's diagonal

/// What stands off more on one side than on the other has its model not in the middle of its box:
/// the place of a tight cage is found from there, in at most so many steps, each of which goes
/// beyond what it must by this share of the cage's diagonal. It ends after so many steps without a
/// gain.
constexpr int most_steps = 40;
constexpr int most_idle_steps = 8;
constexpr double step_beyond = 0.001;
constexpr double nearly = 0.5; // share of the vertices inside from which a search begins

/// A cage is as large as its model or up to so many times larger, along each axis, and by so much
/// of the model's diagonal: flat models have thick cages.
constexpr double most_times = 2.2;
constexpr double most_beyond = 0.3;

struct NamedScale {
  double factor;
  const char* name;
};
constexpr std::array<NamedScale, 7> units = {{{10, "another unit"},
                                              {100, "centimetres against metres"},
                                              {1000, "millimetres against metres"},
                                              {2.54, "inches against centimetres"},
                                              {25.4, "inches against millimetres"},
                                              {1 / 0.0254, "inches against metres"},
                                              {1 / 0.3048, "feet against metres"}}};

struct NamedTurn {
  Mat3 turn = Mat3::Identity();
  std::string name; // empty: none
};

Mat3 quarter_turns(int axis, int quarters) {
  static constexpr std::array<double, 4> cosines = {1, 0, -1, 0};
  const double c = cosines[static_cast<std::size_t>(quarters & 3)];
  const double s = cosines[static_cast<std::size_t>((quarters + 3) & 3)];
  Mat3 turn = Mat3::Identity();
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  turn(u, u) = c;
  turn(u, v) = -s;
  turn(v, u) = s;
  turn(v, v) = c;
  return turn;
}

constexpr std::size_t up_axis_turns = 3; // none, and y up against z up

/// The likeliest first: up_axis_turns, then other axes.
std::vector<NamedTurn> turns() {
  std::vector<NamedTurn> list = {
      {Mat3::Identity(), ""},
      {quarter_turns(0, 1), "turned by 90 degrees about the x axis (y up to z up)"},
      {quarter_turns(0, 3), "turned by -90 degrees about the x axis (z up to y up)"}};
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  for (const int quarters : {1, 3, 2}) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0 || quarters == 2) {
        list.push_back({quarter_turns(axis, quarters),
                        "turned by " + std::to_string(quarters == 3 ? -90 : 90 * quarters) +
                            " degrees about the " + axes[static_cast<std::size_t>(axis)] +
                            " axis"});
      }
    }
  }
  return list;
}

std::string short_number(double value) {
  std::array<char, 32> text;
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 6);
  return {text.data(), end};
}

/// Whether the winding number of the cage round a point is about one or more, whichever way it is
/// oriented (van Oosterom and Strackee 1983).
bool winds_round(TriangleView cage, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : cage.triangles) {
    sum += solid_angle(p, cage.positions[t[0]], cage.positions[t[1]], cage.positions[t[2]]);
  }
  return std::abs(sum) >= 2 * std::numbers::pi;
}

class Fitter {
public:
  Fitter(TriangleView cage, TriangleView model)
      : cage_(cage), cage_box_(bounding_box(cage)), model_box_(bounding_box(model)) {
    std::vector<char> used(model.positions.size(), 0);
    for (const Triangle& t : model.triangles) {
      used[t[0]] = used[t[1]] = used[t[2]] = 1;
    }
    std::vector<Vec3> points;
    for (std::size_t v = 0; v < used.size(); ++v) {
      if (used[v] != 0 && model.positions[v].allFinite()) {
        points.push_back(model.positions[v]);
      }
    }
    points_ = spread(points, most_points);
    many_points_ =
        spread(points, std::max(most_points,
                                most_angles / std::max<std::size_t>(1, cage.triangles.size())));
  }

  [[nodiscard]] bool has_sizes() const {
    return !points_.empty() && !cage_.triangles.empty() && cage_box_.sizes().norm() > 0 &&
           model_box_.sizes().norm() > 0 && cage_box_.sizes().allFinite();
  }
  [[nodiscard]] double relative_size() const {
    return cage_box_.sizes().norm() / model_box_.sizes().norm();
  }

  /// The simplest; one that has more of the model inside, or makes the cage much smaller, goes
  /// before.
  [[nodiscard]] std::optional<CageFit> find() const {
    // What is about where it should be keeps its size, is turned for another upward axis only, and
    // changed only where all is right then.
    const double share_now = share_inside(CageFit());
    const bool is_about_there = share_now >= about_fits && relative_size() < far_too_large;
    if (is_about_there && share_now >= fits) {
      return std::nullopt;
    }
    const double least = is_about_there ? 1 : fits;
    std::vector<NamedTurn> all = turns();
    if (is_about_there) {
      all.resize(up_axis_turns);
    }
    CageFit best;
    // One change; two; all three.
    for (const auto& [scales, turned, shifted] :
         {std::array{true, false, false}, std::array{false, true, false},
          std::array{false, false, true}, std::array{true, true, false},
          std::array{true, false, true}, std::array{false, true, true},
          std::array{true, true, true}}) {
      for (std::size_t t = turned ? 1 : 0; t < (turned ? all.size() : 1); ++t) {
        for (const NamedScale& scale :
             scales && !is_about_there ? scales_for(all[t].turn) : none_) {
          const CageFit fit = fit_by(all[t], scale, shifted);
          if (fit.inside >= least && is_better(fit, best, scale)) {
            best = shifted ? settled(fit, many_points_) : fit;
            best.inside = fit.inside; // of the same vertices for all
            describe(best, all[t].name, scale);
          }
        }
      }
    }
    return best.inside > 0 ? std::optional(best) : std::nullopt;
  }

private:
  /// \param best  has come before, and is the simpler one; inside is 0 if there is none
  static bool is_better(const CageFit& fit, const CageFit& best, const NamedScale& scale) {
    const bool needs_no_size = *scale.name != 0 || scale.factor == 1;
    if (best.inside > 0 && !needs_no_size) {
      return false;
    }
    return fit.inside > best.inside ||
           (fit.inside == best.inside && fit.scale < much_smaller * best.scale);
  }

  /// `inside` is 0 where the sizes of the boxes speak against it.
  [[nodiscard]] CageFit fit_by(const NamedTurn& turn, const NamedScale& scale, bool shifted) const {
    CageFit fit;
    fit.turn = turn.turn;
    fit.scale = scale.factor;
    if (shifted) {
      fit.shift = model_box_.center() - fit.scale * (fit.turn * cage_box_.center());
    }
    if (!is_plausible(fit)) {
      return fit;
    }
    fit.inside = share_inside(fit);
    if (shifted && fit.inside >= nearly) {
      fit = settled(fit, points_);
    }
    return fit;
  }

  static std::vector<Vec3> spread(const std::vector<Vec3>& points, std::size_t most) {
    const std::size_t count = std::min(points.size(), most);
    std::vector<Vec3> some;
    for (std::size_t i = 0; i < count; ++i) {
      some.push_back(points[i * points.size() / count]);
    }
    return some;
  }

  [[nodiscard]] Vec3 turned_sizes(const Mat3& turn) const {
    return (turn * cage_box_.sizes()).cwiseAbs();
  }

  /// Units, and last what the sizes themselves ask for.
  [[nodiscard]] std::vector<NamedScale> scales_for(const Mat3& turn) const {
    std::vector<NamedScale> list;
    for (const NamedScale& unit : units) {
      list.push_back({1 / unit.factor, unit.name});
      list.push_back({unit.factor, unit.name});
    }
    const Vec3 sizes = turned_sizes(turn);
    double least = 0; // to be as large as the model
    double most = 0;
    for (int k = 0; k < 3; ++k) {
      const double factor = model_box_.sizes()[k] / sizes[k];
      least = std::max(least, factor);
      most = k == 0 ? factor : std::min(most, factor);
    }
    constexpr double alike = 2; // sizes of a cage and of its model have about the same proportions
    if (std::isfinite(least) && least > 0 && least < alike * most) {
      for (const double larger : {1.05, 1.15, 1.3, 1.5}) {
        list.push_back({rounded(larger * least), ""});
      }
    }
    return list;
  }

  /// To two digits: nobody needs more.
  static double rounded(double factor) {
    const double unit = maths::pow(10, std::floor(maths::log(factor) / maths::log(10)) - 1);
    return std::ceil(factor / unit) * unit;
  }

  [[nodiscard]] bool is_plausible(const CageFit& fit) const {
    const Vec3 sizes = fit.scale * turned_sizes(fit.turn);
    const Vec3 model = model_box_.sizes();
    const Vec3 center = fit(cage_box_.center());
    for (int k = 0; k < 3; ++k) {
      const bool reaches = center[k] - sizes[k] / 2 <= model_box_.min()[k] + 0.05 * model[k] &&
                           center[k] + sizes[k] / 2 >= model_box_.max()[k] - 0.05 * model[k];
      if (!reaches || sizes[k] > most_times * model[k] + most_beyond * model.norm()) {
        return false;
      }
    }
    return true;
  }

  /// The model's vertices in a cage that is changed: those inside, and for the others the normal
  /// equations of the cage's shift, in its own coordinates, that takes each to its nearest face.
  struct Lack {
    std::size_t inside = 0;
    Mat3 matrix = Mat3::Zero();
    Vec3 moments = Vec3::Zero();
  };

  [[nodiscard]] bool is_inside(const Vec3& p) const {
    return cage_box_.contains(p) && winds_round(cage_, p);
  }

  void add_lack(const Vec3& p, Lack& lack) const {
    const double beyond = step_beyond * cage_box_.sizes().norm();
    double distance = std::numeric_limits<double>::infinity();
    Vec3 nearest = p;
    for (const Triangle& t : cage_.triangles) {
      const Vec3 q = nearest_on_triangle(p, cage_.positions[t[0]], cage_.positions[t[1]],
                                         cage_.positions[t[2]]);
      if ((p - q).norm() < distance) {
        distance = (p - q).norm();
        nearest = q;
      }
    }
    if (distance > 0 && std::isfinite(distance)) {
      const Vec3 outward = (p - nearest) / distance;
      lack.matrix += outward * outward.transpose();
      lack.moments += outward * (distance + beyond);
    }
  }

  [[nodiscard]] Lack lack_of(const CageFit& fit, std::span<const Vec3> points,
                             bool with_equations) const {
    return parallel_reduce_ordered(
        0, points.size(), 16, Lack{},
        [&](std::size_t first, std::size_t last) {
          Lack lack;
          for (std::size_t i = first; i < last; ++i) {
            const Vec3 p = fit.turn.transpose() * (points[i] - fit.shift) / fit.scale;
            if (is_inside(p)) {
              ++lack.inside;
            } else if (with_equations) {
              add_lack(p, lack);
            }
          }
          return lack;
        },
        [](Lack& all, const Lack& part) {
          all.inside += part.inside;
          all.matrix += part.matrix;
          all.moments += part.moments;
        });
  }

  static double share(const Lack& lack, std::span<const Vec3> points) {
    return static_cast<double>(lack.inside) / static_cast<double>(points.size());
  }
  [[nodiscard]] double share_inside(const CageFit& fit) const {
    return share(lack_of(fit, points_, false), points_);
  }

  /// The cage shifted from there to where most of the model is inside: point to plane registration
  /// (Chen and Medioni 1992) of the vertices that are not.
  [[nodiscard]] CageFit settled(CageFit fit, std::span<const Vec3> points) const {
    fit.inside = 0;
    CageFit best = fit;
    int idle = 0;
    for (int step = 0; step < most_steps && idle < most_idle_steps; ++step) {
      const Lack lack = lack_of(fit, points, true);
      fit.inside = share(lack, points);
      idle = step == 0 || fit.inside > best.inside ? 0 : idle + 1;
      if (fit.inside > best.inside) {
        best = fit;
      }
      if (lack.inside == points.size()) {
        break;
      }
      const Mat3 held = lack.matrix + 1e-3 * lack.matrix.trace() * Mat3::Identity(); // no far leaps
      fit.shift += fit.scale * (fit.turn * held.ldlt().solve(lack.moments));
    }
    return best;
  }

  static void describe(CageFit& fit, const std::string& turn, const NamedScale& scale) {
    std::vector<std::string> parts;
    if (fit.scale != 1) {
      parts.push_back("scaled by " + short_number(fit.scale) +
                      (*scale.name != 0 ? " (" + std::string(scale.name) + ")" : ""));
    }
    if (!turn.empty()) {
      parts.push_back(turn);
    }
    if (!fit.shift.isZero(0)) {
      parts.push_back("shifted by (" + short_number(fit.shift.x()) + ", " +
                      short_number(fit.shift.y()) + ", " + short_number(fit.shift.z()) + ")");
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      fit.description += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
    }
  }

  TriangleView cage_;
  Box3 cage_box_;
  Box3 model_box_;
  std::vector<Vec3> points_;
  std::vector<Vec3> many_points_;
  std::vector<NamedScale> none_ = {{1, ""}};
};

} // namespace

PolygonMesh CageFit::operator()(PolygonMesh cage) const {
  for (Vec3& p : cage.positions) {
    p = (*this)(p);
  }
  return cage;
}

std::optional<CageFit> fit_cage(const PolygonMesh& cage, TriangleView model) {
  const TriangleMesh triangles = to_triangle_mesh(cage);
  const Fitter fitter(triangles, model);
  return fitter.has_sizes() ? fitter.find() : std::nullopt;
}

double relative_size(const PolygonMesh& cage, TriangleView model) {
  const TriangleMesh triangles = to_triangle_mesh(cage);
  const Fitter fitter(triangles, model);
  return fitter.has_sizes() ? fitter.relative_size() : 0;
}

} // namespace cagewright
