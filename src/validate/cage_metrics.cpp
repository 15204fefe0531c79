#include <cagewright/validate/cage_metrics.h>

#include "core/maths.h"
#include "core/parallel.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/webbing.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace cagewright {
namespace {

constexpr std::size_t sample_count = 20000;

/// Points spread evenly over a surface: each stands for the same area.
std::vector<Vec3> surface_samples(TriangleView mesh) {
  const double step = surface_area(mesh) / static_cast<double>(sample_count);
  std::vector<Vec3> samples;
  samples.reserve(sample_count + 1);
  double passed = 0; // area of the triangles before
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.positions[t[0]];
    const Vec3 ab = mesh.positions[t[1]] - a;
    const Vec3 ac = mesh.positions[t[2]] - a;
    passed += ab.cross(ac).norm() / 2;
    while (step > 0 && (static_cast<double>(samples.size()) + 0.5) * step < passed) {
      // Roberts' R2 sequence, folded into the triangle.
      const auto k = static_cast<double>(samples.size());
      double u = std::fmod(0.5 + k * 0.7548776662466927, 1.0);
      double v = std::fmod(0.5 + k * 0.5698402909980532, 1.0);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      samples.emplace_back(a + u * ab + v * ac);
    }
  }
  return samples;
}

struct Distances {
  double sum = 0;
  double max = 0;
};

Distances distances_to(const TriangleBvh& model, const std::vector<Vec3>& points,
                       const Progress& progress) {
  return parallel_reduce_ordered(
      0, points.size(), 256, Distances(),
      [&](std::size_t first, std::size_t last) {
        Distances found;
        for (std::size_t i = first; i < last && !progress.cancelled(); ++i) {
          const NearestPoint nearest = model.nearest(points[i]);
          if (nearest) {
            found.sum += nearest.distance;
            found.max = std::max(found.max, nearest.distance);
          }
        }
        return found;
      },
      [](Distances& all, const Distances& part) {
        all.sum += part.sum;
        all.max = std::max(all.max, part.max);
      });
}

void measure_distances(TriangleView cage, TriangleView model, CageMetrics& metrics,
                       const Progress& progress) {
  const double diag = model.triangles.empty() ? 0 : bounding_box(model).diagonal().norm();
  if (!(diag > 0) || cage.triangles.empty()) {
    return;
  }
  const TriangleBvh model_bvh(model);
  if (progress.cancelled()) {
    return;
  }
  metrics.clearance = mesh_distance(TriangleBvh(cage), model_bvh).distance / diag;
  const std::vector<Vec3> samples = surface_samples(cage);
  const Distances on_surface = distances_to(model_bvh, samples, progress);
  if (!samples.empty()) {
    metrics.mean_distance = on_surface.sum / static_cast<double>(samples.size()) / diag;
  }
  std::vector<Vec3> corners;
  for (const Triangle& t : cage.triangles) {
    for (const Index v : t) {
      corners.push_back(cage.positions[v]);
    }
  }
  metrics.max_distance =
      std::max(on_surface.max, distances_to(model_bvh, corners, progress).max) / diag;
}

void measure_shapes(TriangleView cage, CageMetrics& metrics) {
  std::vector<double> quality;
  std::vector<std::size_t> valence(cage.positions.size(), 0);
  for (const Triangle& t : cage.triangles) {
    quality.push_back(
        triangle_quality(cage.positions[t[0]], cage.positions[t[1]], cage.positions[t[2]]));
    for (const Index v : t) {
      ++valence[v];
    }
  }
  if (quality.empty()) {
    return;
  }
  const auto low = quality.begin() + static_cast<std::ptrdiff_t>(quality.size() / 20);
  std::nth_element(quality.begin(), low, quality.end());
  metrics.low_quality = *low;
  metrics.min_quality = *std::min_element(quality.begin(), quality.end());
  metrics.max_valence = *std::max_element(valence.begin(), valence.end());
}

double min_dihedral(TriangleView cage) {
  struct Side {
    Index low;
    Index high;
    Index face;
  };
  std::vector<Side> sides;
  for (std::size_t f = 0; f < cage.triangles.size(); ++f) {
    const Triangle& t = cage.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      sides.push_back({low, high, static_cast<Index>(f)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
  });
  double widest = 0; // between the normals of neighbors
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i].low == sides[i - 1].low && sides[i].high == sides[i - 1].high) {
      const Vec3 n = triangle_normal(cage, cage.triangles[sides[i - 1].face]);
      const Vec3 m = triangle_normal(cage, cage.triangles[sides[i].face]);
      widest = std::max(widest, maths::atan2(n.cross(m).norm(), n.dot(m)));
    }
  }
  return 180 - widest * 180 / std::numbers::pi;
}

} // namespace

CageMetrics measure_cage(TriangleView cage, TriangleView model,
                         const std::optional<ModelVolume>& known_volume, const Progress& progress) {
  CageMetrics metrics;
  std::vector<char> used(cage.positions.size(), 0);
  for (const Triangle& t : cage.triangles) {
    for (const Index v : t) {
      used[v] = 1;
    }
  }
  metrics.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  metrics.faces = cage.triangles.size();
  metrics.volume = signed_volume(cage);
  const ModelVolume volume = known_volume ? *known_volume : model_volume(model, progress);
  metrics.model_volume = volume.value;
  metrics.model_volume_method = volume.method;
  metrics.volume_ratio = volume.value > 0 ? metrics.volume / volume.value : 0;
  progress(0.4, "figures");
  measure_distances(cage, model, metrics, progress);
  progress(0.7, "figures");
  metrics.webbing = SpaceBetween(model, progress).share_inside(cage);
  measure_shapes(cage, metrics);
  metrics.min_dihedral = min_dihedral(cage);
  return metrics;
}

CageMetrics measure_cage(const PolygonMesh& cage, TriangleView model,
                         const std::optional<ModelVolume>& known_volume, const Progress& progress) {
  CageMetrics metrics =
      measure_cage(TriangleView(to_triangle_mesh(cage)), model, known_volume, progress);
  std::vector<std::size_t> valence(cage.positions.size(), 0);
  metrics.max_valence = 0;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    for (const Index v : cage.face(f)) {
      metrics.max_valence = std::max(metrics.max_valence, ++valence[v]);
    }
  }
  return metrics;
}

} // namespace cagewright
