// Harmonic coordinates. Compiled once for each instruction set (Highway includes this file again
// and again); the best is chosen when the program runs.
//
//     h_i(x) = phi_i(x) + sum over panels p and their corners k of psi_{p,k}(x) Q_{(p,k),i},
//     psi_{p,k} = (lambda_k I + g_k . sum of J_e nu_e) / 4 pi,
// with phi those of Green coordinates, I the integral of 1 / r over the panel and J_e that of r
// along an edge. Q are normal derivatives: those with which h_i is hat_i on the cage, in the sense
// of Galerkin.

#include "coordinates/cage_samples.h"
#include "coordinates/normal_equations.h"
#include "coordinates/surface_coordinates.h"
#include "core/maths.h"
#include "core/memory.h"
#include "core/parallel.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/green.h>
#include <cagewright/coordinates/harmonic.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/harmonic_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/triangle_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

constexpr double per_angle = 1 / full_angle;

/// The integrals of 1 / r times the three hats of a panel, of which J_e are
/// known.
template <class V>
HWY_INLINE void hat_potentials(const Surface::Face& face, const FaceTerms<V>& f, const V (&j)[3],
                               V (&psi)[3]) {
  const V potential = f.potential();
  for (std::size_t k = 0; k < 3; ++k) {
    const V slope =
        fma(V(face.slope[k][0]), j[0], fma(V(face.slope[k][1]), j[1], V(face.slope[k][2]) * j[2]));
    psi[k] = V(per_angle) * fma(f.lambda[k], potential, slope);
  }
}

/// With care, for a point near an edge of a panel.
void panel_potentials_of(const Surface& panels, const Vec3& x, std::size_t i, double* psi) {
  const PointTerms point(panels, x);
  for (std::size_t f = 0; f < panels.faces.size(); ++f) {
    const Surface::Face& face = panels.faces[f];
    double j[3];
    for (std::size_t e = 0; e < 3; ++e) {
      j[e] = length_integral(panels.edges[face.edges[e]], point, point.edge(face.edges[e]));
    }
    double own[3];
    hat_potentials(face, point.face(f), j, own);
    for (std::size_t k = 0; k < 3; ++k) {
      psi[(3 * f + k) * 16 + i] = own[k];
    }
  }
}

/// psi[(3 f + k) * 16 + i] of sixteen points for each corner of each panel.
/// \param near  points nearer than this to an edge of a panel are done with
/// care
void panel_potentials(const Surface& panels, std::span<const Vec3> points, double near,
                      double* psi) {
  const SixteenPoints all(points);
  const std::size_t own = LanePoints::scratch_size(panels);
  AlignedBuffer<double> scratch(own + panels.edges.size() * lanes);
  double* const lengths = scratch.data() + own;
  for (std::size_t first = 0; first < 16; first += lanes) {
    const Lanes x = Lanes::load(&all.x[first]);
    const Lanes y = Lanes::load(&all.y[first]);
    const Lanes z = Lanes::load(&all.z[first]);
    LanePoints points_here(panels, &all.x[first], &all.y[first], &all.z[first], scratch.data(),
                           near);
    length_integrals(panels, points_here, x, y, z, lengths);
    for (std::size_t f = 0; f < panels.faces.size(); ++f) {
      const Surface::Face& face = panels.faces[f];
      const FaceTerms<Lanes> terms = points_here.face(f);
      Lanes j[3];
      for (std::size_t e = 0; e < 3; ++e) {
        j[e] = Lanes::load(lengths + face.edges[e] * lanes);
      }
      Lanes psi_here[3];
      hat_potentials(face, terms, j, psi_here);
      for (std::size_t k = 0; k < 3; ++k) {
        psi_here[k].store(psi + (3 * f + k) * 16 + first);
      }
    }
    const LaneFlags flagged = points_here.near_edges();
    for (std::size_t i = 0; i < lanes && first + i < points.size(); ++i) {
      if (flagged[i]) {
        panel_potentials_of(panels, points[first + i], first + i, psi);
      }
    }
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(panel_potentials);

namespace {

/// How a triangle is cut: strips along its edges, thinner and thinner toward
/// them, and a smaller triangle inside. The normal derivative is singular at
/// the edges, of which that along them is not much smoother.
struct Cut {
  int strips = 0; ///< along each edge
  int pieces = 1; ///< of each strip, 1 to 3
  int inner = 1;  ///< the square root of the number of panels inside

  [[nodiscard]] std::size_t unknowns() const {
    return static_cast<std::size_t>((inner + 1) * (inner + 2) / 2 + 3 * strips * (pieces + 1));
  }
};

/// From coarse to fine.
constexpr std::array<Cut, 6> cut_levels = {
    {{0, 1, 1}, {1, 1, 1}, {2, 2, 1}, {2, 3, 2}, {3, 3, 3}, {4, 3, 4}}};

/// Barycentric coordinates, and the share of the area.
using QuadratureNode = std::pair<std::array<double, 3>, double>;

/// Strang and Fix's rule of degree 5.
constexpr std::array<QuadratureNode, 7> seven_points = {{
    {{1.0 / 3, 1.0 / 3, 1.0 / 3}, .225},
    {{.059715871789770, .470142064105115, .470142064105115}, .132394152788506},
    {{.470142064105115, .059715871789770, .470142064105115}, .132394152788506},
    {{.470142064105115, .470142064105115, .059715871789770}, .132394152788506},
    {{.797426985353087, .101286507323456, .101286507323456}, .125939180544827},
    {{.101286507323456, .797426985353087, .101286507323456}, .125939180544827},
    {{.101286507323456, .101286507323456, .797426985353087}, .125939180544827},
}};

CageSample sample_of(const Surface& cage, std::size_t triangle, const Vec3& x, double weight) {
  const Surface::Face& face = cage.faces[triangle];
  CageSample sample{x, triangle, {}, weight};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t e = (i + 1) % 3;
    const Vec3 inward = cage.positions[face.vertices[e]] - x;
    sample.hats[i] = std::max(0.0, face.share[i] * face.outward[e].dot(inward));
    sum += sample.hats[i];
  }
  for (double& hat : sample.hats) {
    hat /= sum;
  }
  return sample;
}

/// A place where an unknown's own hat is integrated with.
struct PanelSample {
  CageSample sample;
  std::array<Index, 3> unknowns{};
  std::array<double, 3> hats{}; ///< of the unknowns
};

/// The triangles of a cage, each cut into panels. The unknown normal derivative
/// is linear along strips, and the same across them.
struct Panels {
  Surface surface;
  std::vector<std::array<Index, 3>> unknowns_at; ///< the corners of each panel
  std::vector<std::vector<PanelSample>> samples; ///< of each triangle of the cage
  std::size_t unknowns = 0;
  std::vector<double> size_of; ///< each unknown's panels, across
};

/// Where strips are cut.
std::vector<double> places_along(int pieces) {
  switch (pieces) {
  case 1:
    return {0, 1};
  case 2:
    return {0, 0.5, 1};
  default:
    return {0, 0.2, 0.8, 1};
  }
}

class PanelMaker {
public:
  PanelMaker(const Surface& cage, const Cut& cut) : cage_(cage), cut_(cut) {}

  Panels make() {
    panels_.samples.resize(cage_.faces.size());
    for (std::size_t t = 0; t < cage_.faces.size(); ++t) {
      add_inner(t);
      for (int strip = 0; strip < cut_.strips; ++strip) {
        for (std::size_t e = 0; e < 3; ++e) {
          add_strip(t, strip, e);
        }
      }
    }
    panels_.surface = Surface::of_triangles(cage_.frame, std::move(positions_), triangles_);
    return std::move(panels_);
  }

private:
  /// How far from the edges toward the middle the outer side of a strip lies;
  /// 0: at them.
  [[nodiscard]] double depth(int strip) const {
    constexpr double inner = 0.3;
    constexpr double ratio = 0.25;
    return strip == cut_.strips ? 0 : inner * maths::pow(ratio, static_cast<double>(strip));
  }

  [[nodiscard]] Vec3 corner(std::size_t t, std::size_t i, double in_from_edges) const {
    const std::array<Index, 3>& v = cage_.faces[t].vertices;
    const Vec3 middle = (cage_.positions[v[0]] + cage_.positions[v[1]] + cage_.positions[v[2]]) / 3;
    const Vec3& p = cage_.positions[v[i % 3]];
    return p + in_from_edges * (middle - p);
  }

  Index vertex(const Vec3& p) {
    positions_.push_back(p);
    return static_cast<Index>(positions_.size() - 1);
  }

  void add_unknowns(std::size_t count, double size) {
    panels_.size_of.insert(panels_.size_of.end(), count, size);
    panels_.unknowns += count;
  }

  void add_panel(std::size_t t, const Triangle& corners, const std::array<Index, 3>& unknowns) {
    triangles_.push_back(corners);
    panels_.unknowns_at.push_back(unknowns);
    const Vec3& a = positions_[corners[0]];
    const Vec3& b = positions_[corners[1]];
    const Vec3& c = positions_[corners[2]];
    const double area = (b - a).cross(c - a).norm() / 2;
    for (const auto& [place, share] : seven_points) {
      const Vec3 x = place[0] * a + place[1] * b + place[2] * c;
      panels_.samples[t].push_back({sample_of(cage_, t, x, share * area), unknowns, place});
    }
  }

  /// n^2 panels on which the derivative is linear and continuous.
  void add_inner(std::size_t t) {
    const double inner = depth(0);
    const int n = cut_.inner;
    const auto first = static_cast<Index>(panels_.unknowns);
    std::vector<Index> vertices;
    std::vector<int> row_begin;
    for (int j = 0; j <= n; ++j) {
      row_begin.push_back(static_cast<int>(vertices.size()));
      for (int k = 0; j + k <= n; ++k) {
        vertices.push_back(vertex((static_cast<double>(n - j - k) * corner(t, 0, inner) +
                                   static_cast<double>(j) * corner(t, 1, inner) +
                                   static_cast<double>(k) * corner(t, 2, inner)) /
                                  static_cast<double>(n)));
      }
    }
    const auto at = [&](int j, int k) {
      return static_cast<std::size_t>(row_begin[static_cast<std::size_t>(j)] + k);
    };
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      const Triangle corners = {vertices[a], vertices[b], vertices[c]};
      const std::array<Index, 3> unknowns = {first + static_cast<Index>(a),
                                             first + static_cast<Index>(b),
                                             first + static_cast<Index>(c)};
      add_panel(t, corners, unknowns);
    };
    for (int j = 0; j < n; ++j) {
      for (int k = 0; j + k < n; ++k) {
        add(at(j, k), at(j + 1, k), at(j, k + 1));
        if (j + k + 2 <= n) {
          add(at(j + 1, k), at(j + 1, k + 1), at(j, k + 1));
        }
      }
    }
    add_unknowns(vertices.size(), std::sqrt(cage_.faces[t].twice_area) / n);
  }

  /// Between depth(strip) and depth(strip + 1).
  void add_strip(std::size_t t, int strip, std::size_t e) {
    const std::vector<double> along = places_along(cut_.pieces);
    const double inside = depth(strip);
    const double outside = depth(strip + 1);
    const auto at = [&](double in_from_edge, double s) {
      return Vec3((1 - s) * corner(t, e, in_from_edge) + s * corner(t, e + 1, in_from_edge));
    };
    Index in = vertex(at(inside, 0));
    Index out = vertex(at(outside, 0));
    for (std::size_t k = 0; k + 1 < along.size(); ++k) {
      const auto here = static_cast<Index>(panels_.unknowns + k);
      const Index next_in = vertex(at(inside, along[k + 1]));
      const Index next_out = vertex(at(outside, along[k + 1]));
      add_panel(t, {out, next_out, next_in}, {here, here + 1, here + 1});
      add_panel(t, {out, next_in, in}, {here, here + 1, here});
      in = next_in;
      out = next_out;
    }
    add_unknowns(along.size(),
                 (inside - outside) / 3 * cage_.faces[t].twice_area / cage_.faces[t].length[e]);
  }

  const Surface& cage_;
  Cut cut_;
  Panels panels_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> triangles_;
};

/// Other places: over each triangle, on its edges and corners, and close by
/// them.
std::vector<CageSample> samples_to_check(const Surface& cage) {
  constexpr int steps = 12; // the middles of edges and of the triangle are among them
  const auto graded = [](int i) { return static_cast<double>(i * i) + 0.02 * i; };
  std::vector<CageSample> samples;
  for (std::size_t t = 0; t < cage.faces.size(); ++t) {
    for (int j = 0; j <= steps; ++j) {
      for (int k = 0; j + k <= steps; ++k) {
        const double i = graded(steps - j - k);
        const double sum = i + graded(j) + graded(k);
        const std::array<Index, 3>& v = cage.faces[t].vertices;
        const Vec3 x = (i * cage.positions[v[0]] + graded(j) * cage.positions[v[1]] +
                        graded(k) * cage.positions[v[2]]) /
                       sum;
        samples.push_back({x, t, {i / sum, graded(j) / sum, graded(k) / sum}, 0});
      }
    }
  }
  return samples;
}

/// psi[u * 16 + i] for each unknown.
class UnknownPotentials {
public:
  UnknownPotentials(const Panels& panels, std::span<const Vec3> points, double near)
      : of_corners_(48 * panels.surface.faces.size()), of_unknowns_(16 * panels.unknowns) {
    std::fill(of_corners_.span().begin(), of_corners_.span().end(), 0.0);
    std::fill(of_unknowns_.span().begin(), of_unknowns_.span().end(), 0.0);
    HWY_DYNAMIC_DISPATCH(panel_potentials)
    (panels.surface, points, near, of_corners_.data());
    for (std::size_t c = 0; c < 3 * panels.surface.faces.size(); ++c) {
      double* const to = of_unknowns_.data() + 16 * panels.unknowns_at[c / 3][c % 3];
      const double* const from = of_corners_.data() + 16 * c;
      for (std::size_t i = 0; i < 16; ++i) {
        to[i] += from[i];
      }
    }
  }

  [[nodiscard]] const double* data() const { return of_unknowns_.data(); }

private:
  AlignedBuffer<double> of_corners_;
  AlignedBuffer<double> of_unknowns_;
};

/// Nearer than this to edges of panels potentials are computed with care:
/// farther away they err by less than 1e-12.
constexpr double near_panel = 1e-4;

/// The normal derivatives: unknowns by vertices of the cage.
class Derivatives {
public:
  Derivatives(const Surface& cage, const Coordinates& green, Panels panels)
      : cage_(cage), green_(green), panels_(std::move(panels)) {}

  [[nodiscard]] std::size_t unknowns() const { return panels_.unknowns; }
  [[nodiscard]] const Panels& panels() const { return panels_; }
  [[nodiscard]] StripMatrix take() { return std::move(q_); }

  /// Galerkin: hat_i = phi_i + sum of psi Q, weighted by each unknown's own hat
  /// over the cage.
  Status solve(const Progress& progress) {
    constexpr double least_pivot = 3e-4; // those of good panels are larger
    PositiveSystem system(unknowns(), cage_.cage_vertices);
    std::mutex reporting;
    std::size_t finished = 0;
    parallel_for(0, panels_.samples.size(), 1, [&](std::size_t t) {
      if (!progress.cancelled()) {
        add_rows(panels_.samples[t], system);
        const std::scoped_lock lock(reporting);
        progress(0.4 * static_cast<double>(++finished) /
                     static_cast<double>(panels_.samples.size()),
                 "bind");
      }
    });
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    Result<StripMatrix> solved = system.solve(progress.part(0.4, 0.95), least_pivot);
    if (!solved) {
      return solved.error();
    }
    q_ = *std::move(solved);
    keep_laws();
    return success();
  }

  /// The greatest error at samples, for each triangle of the cage.
  [[nodiscard]] std::vector<double> residuals(const std::vector<CageSample>& samples) const {
    const std::size_t tiles = (samples.size() + 15) / 16;
    std::vector<double> of_sample(samples.size());
    parallel_for(0, tiles, 1, [&](std::size_t t) {
      const std::span<const CageSample> some =
          std::span(samples).subspan(16 * t, std::min<std::size_t>(16, samples.size() - 16 * t));
      const CageSampleTile tile(cage_, green_, some);
      const UnknownPotentials psi(panels_, tile.framed(), 0);
      for (std::size_t strip = 0; strip < q_.strips(); ++strip) {
        alignas(64) std::array<double, 256> sums{};
        add_product(unknowns(), 1, q_.strip(strip), psi.data(), sums.data());
        for (std::size_t k = 0; k < 16 && 16 * strip + k < cage_.cage_vertices; ++k) {
          for (std::size_t i = 0; i < some.size(); ++i) {
            const std::size_t c = 16 * strip + k;
            const double error = std::abs(tile.green(c, i) + sums[16 * k + i] - tile.hat(c, i));
            most_of(of_sample[16 * t + i], error);
          }
        }
      }
    });
    std::vector<double> of_triangle(cage_.faces.size(), 0.0);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      most_of(of_triangle[samples[i].triangle], of_sample[i]);
    }
    return of_triangle;
  }

private:
  /// Those of the unknowns of one triangle of the cage.
  void add_rows(const std::vector<PanelSample>& places, PositiveSystem& system) {
    std::vector<Index> own; // the unknowns of this triangle
    std::vector<CageSample> samples;
    for (const PanelSample& place : places) {
      own.insert(own.end(), place.unknowns.begin(), place.unknowns.end());
      samples.push_back(place.sample);
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    const auto row_of = [&](Index unknown) {
      return static_cast<std::size_t>(std::lower_bound(own.begin(), own.end(), unknown) -
                                      own.begin());
    };
    // Sums of 16 rows or fewer at a time, for all samples.
    const std::size_t strips = (own.size() + strip_columns - 1) / strip_columns;
    StripMatrix of_unknowns(unknowns(), own.size());
    StripMatrix of_sides(cage_.cage_vertices, own.size());
    for (std::size_t first = 0; first < samples.size(); first += 16) {
      const auto some =
          std::span(samples).subspan(first, std::min<std::size_t>(16, samples.size() - first));
      const CageSampleTile tile(cage_, green_, some);
      const UnknownPotentials psi(panels_, tile.framed(), 0);
      StripMatrix weights(16, own.size()); // of the rows at the samples
      for (std::size_t i = 0; i < some.size(); ++i) {
        const PanelSample& at = places[first + i];
        for (std::size_t k = 0; k < 3; ++k) {
          weights.at(i, row_of(at.unknowns[k])) += some[i].weight * at.hats[k];
        }
      }
      for (std::size_t s = 0; s < strips; ++s) {
        const double* const w = weights.strip(s);
        if (std::all_of(w, w + 256, [](double x) { return x == 0; })) {
          continue; // panels elsewhere in the triangle
        }
        add_outer(unknowns(), some.size(), psi.data(), w, of_unknowns.strip(s));
        for (std::size_t c = 0; c < cage_.cage_vertices; ++c) {
          for (std::size_t i = 0; i < some.size(); ++i) {
            const double missing = tile.hat(c, i) - tile.green(c, i);
            for (std::size_t r = 0; r < strip_columns; ++r) {
              of_sides.strip(s)[strip_columns * c + r] += w[strip_columns * i + r] * missing;
            }
          }
        }
      }
    }
    for (std::size_t r = 0; r < own.size(); ++r) {
      for (std::size_t u = 0; u < unknowns(); ++u) {
        put_entry(own[r], u, of_unknowns.at(u, r), system);
      }
      for (std::size_t c = 0; c < cage_.cage_vertices; ++c) {
        system.side(own[r], c) = of_sides.at(c, r);
      }
    }
  }

  /// Of two unknowns the one on the smaller panels is integrated with: the potential of a large
  /// panel is smooth over a small one, not the other way round. Of two alike both are, by halves;
  /// so that nothing depends on their order.
  void put_entry(std::size_t tested_by, std::size_t unknown, double value, PositiveSystem& system) {
    constexpr double alike = 1e-6;
    const double ratio = panels_.size_of[tested_by] / panels_.size_of[unknown];
    double& entry = system.entry(std::max(tested_by, unknown), std::min(tested_by, unknown));
    if (tested_by == unknown || ratio < 1 - alike) {
      entry = value;
    } else if (ratio <= 1 + alike) {
      // The two halves may come at once; their sum does not depend on which is the first.
      const std::lock_guard lock(halves_[unknown % halves_.size()]);
      entry += value / 2;
    }
  }

  /// sums[16 u + r] += sum over the samples of psi[16 u + i] w[16 i + r].
  static void add_outer(std::size_t unknowns, std::size_t samples, const double* psi,
                        const double* w, double* sums) {
    for (std::size_t u = 0; u < unknowns; ++u) {
      for (std::size_t i = 0; i < samples; ++i) {
        const double here = psi[16 * u + i];
        for (std::size_t r = 0; r < strip_columns; ++r) {
          sums[16 * u + r] += here * w[16 * i + r];
        }
      }
    }
  }

  /// What is no number is the most.
  static void most_of(double& most, double other) { most = other <= most ? most : other; }

  /// The derivative of 1 is 0, and that of the position is the normal: the
  /// least change of each row after which sums and reproduction hold whatever
  /// the panels.
  void keep_laws() {
    const std::size_t count = cage_.cage_vertices;
    Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
    const auto column = [&](std::size_t c) {
      return Eigen::Vector4d(1, cage_.positions[c].x(), cage_.positions[c].y(),
                             cage_.positions[c].z());
    };
    for (std::size_t c = 0; c < count; ++c) {
      square += column(c) * column(c).transpose();
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver(square);
    std::vector<Vec3> normals(unknowns());
    for (std::size_t p = 0; p < panels_.surface.faces.size(); ++p) {
      for (const Index u : panels_.unknowns_at[p]) {
        normals[u] = panels_.surface.faces[p].normal;
      }
    }
    parallel_for(0, unknowns(), 64, [&](std::size_t u) {
      Eigen::Vector4d missing;
      missing << 0, normals[u];
      for (std::size_t c = 0; c < count; ++c) {
        missing -= q_.at(u, c) * column(c);
      }
      const Eigen::Vector4d factor = solver.solve(missing);
      for (std::size_t c = 0; c < count; ++c) {
        q_.at(u, c) += factor.dot(column(c));
      }
    });
  }

  const Surface& cage_;
  const Coordinates& green_;
  Panels panels_;
  StripMatrix q_;
  std::array<std::mutex, 64> halves_; // for entries that two threads add to, by their unknowns
};

class HarmonicCoordinates : public Coordinates {
public:
  HarmonicCoordinates(const PolygonMesh& cage, const CageFrame& frame,
                      std::shared_ptr<const Coordinates> green, Derivatives& derivatives,
                      OutsideTreatment outside, double bound)
      : Coordinates(vertex_columns(cage.positions), outside), frame_(frame),
        green_(std::move(green)), panels_(derivatives.panels()), q_(derivatives.take()),
        bound_(bound) {
    for (const Vec3& p : cage.positions) {
      cage_.push_back(frame.to_frame(p));
    }
  }

  [[nodiscard]] double error_bound() const override { return bound_; }
  [[nodiscard]] double error_estimate() const override { return estimate_; }
  void set_estimate(double estimate) { estimate_ = estimate; }

private:
  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const override {
    AlignedBuffer<double> phi(16 * green_->columns());
    const TileReport report = green_->solve(points, phi.span());
    std::array<Vec3, 16> framed;
    for (std::size_t i = 0; i < points.size(); ++i) {
      // Points without weights are taken elsewhere: what they bring is not
      // looked at.
      const bool is_used = ((report.undefined | report.outside) >> i & 1U) == 0;
      framed[i] = is_used ? frame_.to_frame(points[i]) : Vec3(Vec3::Zero());
    }
    const UnknownPotentials psi(panels_, std::span(framed).first(points.size()), near_panel);
    for (std::size_t strip = 0; strip < q_.strips(); ++strip) {
      alignas(64) std::array<double, 256> sums{};
      add_product(panels_.unknowns, 1, q_.strip(strip), psi.data(), sums.data());
      for (std::size_t k = 0; k < 16 && 16 * strip + k < cage_.size(); ++k) {
        const std::size_t c = 16 * strip + k;
        for (std::size_t i = 0; i < 16; ++i) {
          weights[c * stride + i] = phi.data()[16 * c + i] + sums[16 * k + i];
        }
      }
    }
    for (std::size_t i = 0; i < 16; ++i) {
      const bool has_weights =
          i < points.size() && ((report.undefined | report.outside) >> i & 1U) == 0;
      if (has_weights) {
        clip(framed[i], weights.subspan(i), stride);
      } else {
        for (std::size_t c = 0; c < cage_.size(); ++c) {
          weights[c * stride + i] = 0;
        }
      }
    }
    return report;
  }

  /// What is below 0 is error: it becomes next to 0, and the laws are restored by positive factors
  /// that are the exponentials of affine functions of the vertices (Newton's method in four
  /// unknowns).
  void clip(const Vec3& x, std::span<double> weights, std::size_t stride) const {
    constexpr double trace = 1e-9; // so that the point is among those that have a weight
    std::vector<double> positive(cage_.size());
    bool is_clipped = false;
    for (std::size_t c = 0; c < cage_.size(); ++c) {
      const double w = weights[c * stride];
      is_clipped = is_clipped || w < 0;
      positive[c] = std::max(w, trace);
    }
    if (!is_clipped || !restore_laws(x, positive)) {
      return; // no positive weights do: those that there are come as near
    }
    for (std::size_t c = 0; c < cage_.size(); ++c) {
      weights[c * stride] = positive[c];
    }
  }

  [[nodiscard]] bool restore_laws(const Vec3& x, std::vector<double>& weights) const {
    constexpr double rounding = 1e-15;
    constexpr double enough = 1e-13; // where rounding keeps it from coming nearer
    double before = std::numeric_limits<double>::infinity();
    constexpr int most_steps = 300;
    constexpr double longest_step = 4; // of an exponent
    for (int step = 0; step < most_steps; ++step) {
      Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
      Eigen::Vector4d missing(1, 0, 0, 0);
      for (std::size_t c = 0; c < cage_.size(); ++c) {
        Eigen::Vector4d column;
        column << 1, cage_[c] - x;
        square += weights[c] * column * column.transpose();
        missing -= weights[c] * column;
      }
      const double off = missing.cwiseAbs().maxCoeff();
      if (off < rounding || (off < enough && off >= before / 2)) {
        return true;
      }
      before = off;
      const Eigen::Vector4d factor = square.ldlt().solve(missing);
      double most = 0;
      for (const Vec3& p : cage_) {
        most = std::max(most, std::abs(factor[0] + factor.tail<3>().dot(p - x)));
      }
      if (!std::isfinite(most)) {
        return false;
      }
      const double share = std::min(1.0, longest_step / most);
      for (std::size_t c = 0; c < cage_.size(); ++c) {
        weights[c] *= maths::exp(share * (factor[0] + factor.tail<3>().dot(cage_[c] - x)));
      }
    }
    return false;
  }

  CageFrame frame_;
  std::shared_ptr<const Coordinates> green_;
  Panels panels_;
  StripMatrix q_;
  std::vector<Vec3> cage_; // in the frame
  double bound_;
  double estimate_ = 0;
};

constexpr double default_accuracy = 2e-3;
constexpr std::size_t usual_unknowns = 4500; // some seconds
constexpr std::size_t patient_unknowns = 8000;
constexpr double useless =
    1; // an error of weights as large as they are: tips of spikes have half of it

/// Points a hundredth of the diagonal below the cage, or farther, where a model
/// may be: below faces, edges and corners.
std::vector<Vec3> probes_inside(const Surface& cage, const Coordinates& green) {
  constexpr double depth = 0.01;
  std::vector<Vec3> normals(cage.positions.size(), Vec3::Zero());
  for (const Surface::Face& face : cage.faces) {
    for (const Index v : face.vertices) {
      normals[v] += face.normal;
    }
  }
  std::vector<Vec3> candidates;
  for (const Surface::Face& face : cage.faces) {
    const auto below = [&](const std::array<double, 3>& share) {
      Vec3 x = Vec3::Zero();
      Vec3 normal = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        x += share[k] * cage.positions[face.vertices[k]];
        normal += share[k] * normals[face.vertices[k]].normalized();
      }
      const double down = depth * cage.frame.scaled_diagonal();
      candidates.emplace_back((x - down * normal.normalized()) / cage.frame.scale +
                              cage.frame.center);
    };
    below({1.0 / 3, 1.0 / 3, 1.0 / 3});
    below({.98, .01, .01});
    below({.01, .98, .01});
    below({.01, .01, .98});
    below({.5, .5, 0});
    below({0, .5, .5});
    below({.5, 0, .5});
  }
  std::vector<Vec3> inside;
  AlignedBuffer<double> weights(16 * green.columns());
  for (const Vec3& x : candidates) {
    const TileReport report = green.solve(std::span(&x, 1), weights.span());
    if (x.allFinite() && (report.outside | report.undefined | report.on_surface) == 0) {
      inside.push_back(x);
    }
  }
  return inside;
}

/// The greatest difference of weights at some points.
double difference(const Coordinates& a, const Coordinates& b, std::span<const Vec3> points) {
  const std::size_t tiles = (points.size() + 15) / 16;
  std::vector<double> of_tile(tiles, 0.0);
  parallel_for(0, tiles, 1, [&](std::size_t t) {
    const auto some = points.subspan(16 * t, std::min<std::size_t>(16, points.size() - 16 * t));
    AlignedBuffer<double> of_a(16 * a.columns());
    AlignedBuffer<double> of_b(16 * b.columns());
    (void)a.solve(some, of_a.span());
    (void)b.solve(some, of_b.span());
    for (std::size_t k = 0; k < of_a.span().size(); ++k) {
      of_tile[t] = std::max(of_tile[t], std::abs(of_a.data()[k] - of_b.data()[k]));
    }
  });
  return tiles == 0 ? 0 : *std::max_element(of_tile.begin(), of_tile.end());
}

constexpr std::array<const CoordinateOption*, 3> kind_options = {&quads_option, &outside_option,
                                                                 &accuracy_option};

Result<std::shared_ptr<const Coordinates>> prepare_kind(const PolygonMesh& cage,
                                                        const CoordinateSettings& settings,
                                                        const Progress& progress) {
  Result<HarmonicOptions> options = options_inside<HarmonicOptions>(settings);
  if (!options) {
    return options.error();
  }
  options->accuracy = settings.number(accuracy_option);
  return harmonic_coordinates(cage, *options, progress);
}

} // namespace

Result<std::shared_ptr<const Coordinates>> harmonic_coordinates(const PolygonMesh& cage,
                                                                const HarmonicOptions& options,
                                                                const Progress& progress) {
  const Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  const auto green = green_coordinates(cage, {.quads = options.quads, .outside = options.outside});
  if (!green) {
    return green.error();
  }
  const std::size_t most = options.unknowns > 0   ? options.unknowns
                           : options.accuracy > 0 ? patient_unknowns
                                                  : usual_unknowns;
  const auto unknowns_at = [&](std::size_t level) {
    return cut_levels[level].unknowns() * surface->faces.size();
  };
  const auto fits = [&](std::size_t level) {
    return unknowns_at(level) <= most &&
           PositiveSystem::bytes(unknowns_at(level)) <= memory_allowed();
  };
  // The first is compared with the one before it.
  constexpr std::size_t usual_level = 3;
  constexpr std::size_t quick_level = 1;
  const std::size_t first_level = options.accuracy > default_accuracy ? quick_level : usual_level;
  std::size_t level = first_level;
  while (level > 0 && !fits(level)) {
    --level;
  }
  if (!fits(level)) {
    return Error{ErrorCode::too_large, "the cage has " + std::to_string(surface->faces.size()) +
                                           " triangles: harmonic coordinates of it do not fit the "
                                           "memory, or take too "
                                           "long; make a coarser cage, or take maximum_entropy or "
                                           "mean_value coordinates"};
  }
  const double accuracy = options.accuracy > 0 ? options.accuracy : default_accuracy;
  const std::vector<CageSample> samples = samples_to_check(*surface);
  const std::vector<Vec3> probes = probes_inside(*surface, **green);
  const Error does_not_come_out = {
      ErrorCode::invalid_cage,
      "harmonic coordinates of this cage do not come out: its faces are too thin or "
      "too sharply folded; make its triangles rounder, or take mean_value coordinates"};
  const auto made_at = [&](std::size_t at,
                           const Progress& share) -> Result<std::shared_ptr<HarmonicCoordinates>> {
    Derivatives derivatives(*surface, **green, PanelMaker(*surface, cut_levels[at]).make());
    if (Status status = derivatives.solve(share); !status) {
      return status.error();
    }
    const std::vector<double> errors = derivatives.residuals(samples);
    if (!std::all_of(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); })) {
      return does_not_come_out;
    }
    return std::make_shared<HarmonicCoordinates>(cage, surface->frame, *green, derivatives,
                                                 options.outside,
                                                 *std::max_element(errors.begin(), errors.end()));
  };
  Result<std::shared_ptr<HarmonicCoordinates>> coarse =
      made_at(level > 0 ? level - 1 : 0, progress.part(0, 0.1));
  for (;; ++level) {
    if (!coarse) {
      return coarse.error();
    }
    const auto share = [](std::size_t at) {
      return 1 - 0.9 * maths::pow(0.4, static_cast<double>(at));
    };
    const std::size_t round = level > first_level ? level - first_level : 0;
    Result<std::shared_ptr<HarmonicCoordinates>> fine =
        level > 0 ? made_at(level, progress.part(share(round), share(round + 1))) : coarse;
    if (!fine) {
      if (fine.error().code == ErrorCode::cancelled || round == 0 ||
          (*coarse)->error_bound() >= useless) {
        return fine.error();
      }
      return std::shared_ptr<const Coordinates>(*std::move(coarse));
    }
    // Nothing is coarser than the first: then nothing better is known than on the cage.
    (*fine)->set_estimate(level > 0 ? difference(**coarse, **fine, probes)
                                    : (*fine)->error_bound());
    // The first that it is compared with may err by anything: only what is given counts.
    const bool is_of_use = (*fine)->error_bound() < useless;
    const bool is_last = level + 1 == cut_levels.size() || !fits(level + 1);
    if (is_last && !is_of_use) {
      if ((*coarse)->error_bound() >= useless) {
        return does_not_come_out;
      }
      return std::shared_ptr<const Coordinates>(*std::move(coarse));
    }
    if (is_last || (is_of_use && (*fine)->error_estimate() <= accuracy)) {
      progress(1, "bind");
      return std::shared_ptr<const Coordinates>(*std::move(fine));
    }
    coarse = std::move(fine);
  }
}

constinit const CoordinateKind harmonic_kind = {
    .name = "harmonic",
    .idea = "like heat that spreads inside the cage: an arm does not drag the "
            "other",
    .quads = "center or diagonal",
    .sign = "not negative",
    .reproduces = "affine maps",
    .on_cage = "interpolates, to within the accuracy",
    .outside = "refused, or at rest",
    .locality = "falls exponentially",
    .made_by = "boundary elements",
    .cost = "ten seconds for the cage, then 400 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = vertex_rule,
};

} // namespace cagewright
#endif
