// Biharmonic coordinates. Compiled once for each instruction set (Highway includes this file again
// and again); the best is chosen when the program runs.
//
// Green's identity twice: a biharmonic function is
//     u = sum of phi_i u_i + psi_t (du/dn)_t + phi2_i a_i + psi2_t b_t,
//     phi2_i = -sum over the faces of (h / 8 pi) [lambda_i I + g_i . sum of J_e nu_e],
//     psi2_t = (sum of rho_e J_e + h^2 I) / 24 pi,
// with a its Laplacian on the cage and b the normal derivative of that. a and b are those with
// which u comes nearest to the positions V of the cage, and the Laplacian of u to a, for normal
// derivatives N: they are linear in V and N.

#include "coordinates/cage_samples.h"
#include "coordinates/normal_columns.h"
#include "coordinates/normal_equations.h"
#include "coordinates/surface_coordinates.h"
#include "core/memory.h"
#include "core/parallel.h"
#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/coordinates/biharmonic.h>
#include <cagewright/coordinates/green.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/biharmonic_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "coordinates/triangle_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

/// second[k * 16 + i]: phi2 of the cage's vertices and psi2 of the faces, for sixteen points.
/// Nothing of it is large anywhere: lanes near edges need no care.
void second_potentials(const Surface& surface, std::span<const Vec3> points, double* second) {
  constexpr double pi = full_angle / 4;
  const std::size_t vertices = surface.positions.size();
  const SixteenPoints all(points);
  const std::size_t own = LanePoints::scratch_size(surface);
  AlignedBuffer<double> scratch(own + (surface.edges.size() + vertices) * lanes);
  double* const lengths = scratch.data() + own;
  double* const sums = lengths + surface.edges.size() * lanes;
  for (std::size_t first = 0; first < 16; first += lanes) {
    LanePoints here(surface, &all.x[first], &all.y[first], &all.z[first], scratch.data());
    length_integrals(surface, here, Lanes::load(&all.x[first]), Lanes::load(&all.y[first]),
                     Lanes::load(&all.z[first]), lengths);
    std::fill_n(sums, vertices * lanes, 0.0);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      const Surface::Face& face = surface.faces[f];
      const FaceTerms<Lanes> terms = here.face(f);
      const Lanes potential = terms.potential();
      Lanes j[3];
      for (std::size_t e = 0; e < 3; ++e) {
        j[e] = Lanes::load(lengths + face.edges[e] * lanes);
      }
      const Lanes h = terms.height;
      for (std::size_t k = 0; k < 3; ++k) {
        const Lanes slope = fma(Lanes(face.slope[k][0]), j[0],
                                fma(Lanes(face.slope[k][1]), j[1], Lanes(face.slope[k][2]) * j[2]));
        double* const sum = sums + face.vertices[k] * lanes;
        const Lanes hat = fma(terms.lambda[k], potential, slope);
        fma(h * Lanes(-1 / (8 * pi)), hat, Lanes::load(sum)).store(sum);
      }
      const Lanes whole = fma(terms.rho[0], j[0],
                              fma(terms.rho[1], j[1], fma(terms.rho[2], j[2], h * h * potential)));
      (whole * Lanes(1 / (24 * pi))).store(second + 16 * (surface.cage_vertices + f) + first);
    }
    put_vertices(surface, sums, second + first, 16);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(second_potentials);

namespace {

/// k by k pieces of each triangle, by their middles.
std::vector<CageSample> samples_of(const Surface& cage, int k) {
  std::vector<CageSample> samples;
  double area = 0;
  for (const Surface::Face& face : cage.faces) {
    area += face.twice_area / 2;
  }
  for (std::size_t t = 0; t < cage.faces.size(); ++t) {
    const Surface::Face& face = cage.faces[t];
    const double weight = std::sqrt(face.twice_area / 2 / area / (k * k));
    const auto add = [&](double i, double j) { // in thirds of a piece
      const double third = 3.0 * k;
      CageSample sample;
      sample.triangle = t;
      sample.hats = {i / third, j / third, (third - i - j) / third};
      sample.x = Vec3::Zero();
      for (std::size_t c = 0; c < 3; ++c) {
        sample.x += sample.hats[c] * cage.positions[face.vertices[c]];
      }
      sample.weight = weight;
      samples.push_back(sample);
    };
    for (int i = 0; i < k; ++i) {
      for (int j = 0; i + j < k; ++j) {
        add(3 * i + 1, 3 * j + 1);
        if (i + j + 1 < k) {
          add(3 * i + 2, 3 * j + 2);
        }
      }
    }
  }
  return samples;
}

class Fit {
public:
  Fit(const Surface& cage, const Coordinates& green, double closeness)
      : cage_(cage), green_(green), vertices_(cage.cage_vertices),
        columns_(vertices_ + cage.faces.size()) {
    double area = 0;
    for (const Surface::Face& face : cage.faces) {
      area += face.twice_area / 2;
    }
    size_ = std::sqrt(area / (4 * std::numbers::pi));
    laplacian_ = size_ * size_ / std::sqrt(closeness);
  }

  /// Z: (C + T) rows for a and b, by columns for V and N, all in the frame.
  Result<StripMatrix> solve(const Progress& progress) {
    constexpr int pieces = 8;
    const std::vector<CageSample> samples = samples_of(cage_, pieces);
    PositiveSystem equations(columns_, columns_);
    constexpr std::size_t block = 256;
    for (std::size_t first = 0; first < samples.size(); first += block) {
      if (progress.cancelled()) {
        return Error::cancelled();
      }
      const std::size_t count = std::min(block, samples.size() - first);
      StripMatrix a(2 * count, columns_);
      StripMatrix b(2 * count, columns_);
      parallel_for(0, (count + 15) / 16, 1, [&](std::size_t tile) {
        fill(std::span(samples).subspan(first + 16 * tile,
                                        std::min<std::size_t>(16, count - 16 * tile)),
             32 * tile, a, b);
      });
      equations.add(a, b);
      progress(0.8 * static_cast<double>(first + count) / static_cast<double>(samples.size()),
               "bind");
    }
    Result<StripMatrix> z = equations.solve(progress.part(0.8, 1));
    if (z) {
      for (std::size_t row = 0; row < columns_; ++row) {
        for (std::size_t k = 0; k < columns_; ++k) {
          z->at(row, k) *= unit_of(row);
        }
      }
      keep_laws(*z);
    }
    return z;
  }

private:
  /// Unknowns are scaled so that all are lengths.
  [[nodiscard]] double unit_of(std::size_t row) const {
    return row < vertices_ ? 1 / (size_ * size_) : 1 / (size_ * size_ * size_);
  }

  /// Two rows for each sample: the value, and the Laplacian.
  void fill(std::span<const CageSample> samples, std::size_t row, StripMatrix& a,
            StripMatrix& b) const {
    const CageSampleTile tile(cage_, green_, samples);
    AlignedBuffer<double> second(16 * columns_);
    HWY_DYNAMIC_DISPATCH(second_potentials)(cage_, tile.framed(), second.data());
    const double unit = cage_.frame.scaled_diagonal(); // of the normals' columns
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t value = row + 2 * i;
      const double weight = samples[i].weight;
      for (std::size_t k = 0; k < columns_; ++k) {
        const bool is_vertex = k < vertices_;
        const double first = is_vertex ? tile.green(k, i) : tile.green(k, i) * unit;
        const double hat = is_vertex ? tile.hat(k, i) : 0;
        a.at(value, k) = weight / size_ * second.data()[16 * k + i] * unit_of(k);
        b.at(value, k) = weight / size_ * (hat - first);
        a.at(value + 1, k) = weight * laplacian_ / size_ * (first - hat) * unit_of(k);
      }
    }
  }

  /// A constant and the position have no Laplacian: the least change of each row after which that
  /// is so to rounding.
  void keep_laws(StripMatrix& z) const {
    const auto column = [&](std::size_t k) {
      Eigen::Vector4d values;
      if (k < vertices_) {
        values << 1, cage_.positions[k];
      } else {
        values << 0, cage_.faces[k - vertices_].normal;
      }
      return values;
    };
    Eigen::Matrix4d square = Eigen::Matrix4d::Zero();
    for (std::size_t k = 0; k < columns_; ++k) {
      square += column(k) * column(k).transpose();
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver(square);
    parallel_for(0, columns_, 16, [&](std::size_t row) {
      Eigen::Vector4d found = Eigen::Vector4d::Zero();
      for (std::size_t k = 0; k < columns_; ++k) {
        found += z.at(row, k) * column(k);
      }
      const Eigen::Vector4d factor = solver.solve(found);
      for (std::size_t k = 0; k < columns_; ++k) {
        z.at(row, k) -= factor.dot(column(k));
      }
    });
  }

  const Surface& cage_;
  const Coordinates& green_;
  std::size_t vertices_;
  std::size_t columns_;
  double size_ = 1;
  double laplacian_ = 1;
};

class BiharmonicCoordinates : public Coordinates {
public:
  BiharmonicCoordinates(std::shared_ptr<const Coordinates> green, Surface surface, StripMatrix z,
                        OutsideTreatment outside)
      : Coordinates(green->rule(), outside), green_(std::move(green)), surface_(std::move(surface)),
        z_(std::move(z)) {}

private:
  TileReport solve_tile(std::span<const Vec3> points, std::span<double> weights,
                        std::size_t stride) const override {
    const TileReport report = green_->solve(points, weights, stride);
    std::array<Vec3, 16> framed;
    for (std::size_t i = 0; i < points.size(); ++i) {
      framed[i] = has_weights(report, i) ? surface_.frame.to_frame(points[i]) : Vec3(Vec3::Zero());
    }
    AlignedBuffer<double> second(16 * z_.rows());
    std::fill(second.span().begin(), second.span().end(), 0.0);
    if (!points.empty()) {
      HWY_DYNAMIC_DISPATCH(second_potentials)
      (surface_, std::span(framed).first(points.size()), second.data());
    }
    const std::size_t vertices = surface_.cage_vertices;
    const double unit = surface_.frame.scaled_diagonal();
    for (std::size_t strip = 0; strip < z_.strips(); ++strip) {
      alignas(64) std::array<double, 256> sums{};
      add_product(z_.rows(), 1, z_.strip(strip), second.data(), sums.data());
      for (std::size_t k = 0; k < 16 && 16 * strip + k < columns(); ++k) {
        const std::size_t column = 16 * strip + k;
        const double factor = column < vertices ? 1 : 1 / unit;
        for (std::size_t i = 0; i < points.size(); ++i) {
          if (has_weights(report, i)) {
            weights[column * stride + i] += factor * sums[16 * k + i];
          }
        }
      }
    }
    return report;
  }

  static bool has_weights(const TileReport& report, std::size_t i) {
    return ((report.undefined | report.outside) >> i & 1U) == 0;
  }

  std::shared_ptr<const Coordinates> green_;
  Surface surface_;
  StripMatrix z_;
};

constinit const CoordinateOption closeness_option = {
    .name = "closeness",
    .help = "How closely the model follows the cage, at the cost of smoothness",
    .initial = 1,
    .least = 1e-3,
    .most = 1e3};

constexpr std::array<const CoordinateOption*, 3> kind_options = {&quads_option, &outside_option,
                                                                 &closeness_option};

Result<std::shared_ptr<const Coordinates>> prepare_kind(const PolygonMesh& cage,
                                                        const CoordinateSettings& settings,
                                                        const Progress& progress) {
  Result<BiharmonicOptions> options = options_inside<BiharmonicOptions>(settings);
  if (!options) {
    return options.error();
  }
  options->closeness = settings.number(closeness_option);
  return biharmonic_coordinates(cage, *options, progress);
}

Result<std::shared_ptr<const ColumnRule>> kind_rule(const PolygonMesh& cage,
                                                    const CoordinateSettings& settings) {
  const Result<Surface> surface =
      Surface::create(cage, static_cast<QuadTreatment>(settings.choice(quads_option)));
  if (!surface) {
    return surface.error();
  }
  return normal_columns(cage.positions, *surface);
}

} // namespace

Result<std::shared_ptr<const Coordinates>> biharmonic_coordinates(const PolygonMesh& cage,
                                                                  const BiharmonicOptions& options,
                                                                  const Progress& progress) {
  if (!(options.closeness > 0)) {
    return Error{ErrorCode::invalid_option, "the closeness of biharmonic coordinates must be "
                                            "greater than 0"};
  }
  Result<Surface> surface = Surface::create(cage, options.quads);
  if (!surface) {
    return surface.error();
  }
  const std::size_t columns = surface->cage_vertices + surface->faces.size();
  // The system, its sides and the solution.
  if (4 * PositiveSystem::bytes(columns) > memory_allowed()) {
    return Error{ErrorCode::too_large,
                 "the cage has " + std::to_string(surface->faces.size()) +
                     " triangles: biharmonic coordinates of it do not fit the memory; make a "
                     "coarser cage, or take green coordinates"};
  }
  auto green = green_coordinates(cage, {.quads = options.quads, .outside = options.outside});
  if (!green) {
    return green.error();
  }
  Result<StripMatrix> z = Fit(*surface, **green, options.closeness).solve(progress);
  if (!z) {
    return z.error();
  }
  return std::shared_ptr<const Coordinates>(std::make_shared<BiharmonicCoordinates>(
      *std::move(green), *std::move(surface), *std::move(z), options.outside));
}

constinit const CoordinateKind biharmonic_kind = {
    .name = "biharmonic",
    .idea = "follows the cage closely, and the directions of its faces",
    .quads = "center or diagonal",
    .sign = "positive and negative, with normals",
    .reproduces = "similarities",
    .on_cage = "nearly interpolates",
    .outside = "refused, or at rest",
    .locality = "global",
    .made_by = "least squares over the cage",
    .cost = "a second for the cage, then 30 ns a point and triangle",
    .options = kind_options,
    .prepare = prepare_kind,
    .rule = kind_rule,
};

} // namespace cagewright
#endif
