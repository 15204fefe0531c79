#include <cagewright/validate/cage_metrics.h>

#include "mesh/shapes.h"
#include <cagewright/mesh/measures.h>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numbers>

namespace cagewright {
namespace {

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& p : mesh.positions) {
    p *= factor;
  }
  return mesh;
}

TEST(MeasureCage, KnowsACubeRoundACube) {
  const CageMetrics metrics = measure_cage(scaled(make_cube(), 1.5), make_cube());
  const double diag = 2 * std::sqrt(3.0);
  EXPECT_EQ(metrics.vertices, 8U);
  EXPECT_EQ(metrics.faces, 12U);
  EXPECT_DOUBLE_EQ(metrics.volume, 27);
  EXPECT_DOUBLE_EQ(metrics.model_volume, 8);
  EXPECT_EQ(metrics.model_volume_method, VolumeMethod::exact);
  EXPECT_DOUBLE_EQ(metrics.volume_ratio, 27.0 / 8);
  EXPECT_NEAR(metrics.clearance, 0.5 / diag, 1e-15);
  EXPECT_NEAR(metrics.max_distance, 0.5 * std::sqrt(3.0) / diag, 1e-15);
  EXPECT_NEAR(metrics.min_quality, 2 * std::sqrt(2.0) - 2, 1e-14);
  EXPECT_NEAR(metrics.low_quality, metrics.min_quality, 1e-14);
  EXPECT_NEAR(metrics.min_dihedral, 90, 1e-12);
}

TEST(MeasureCage, OfPolygonsCountsPolygonsAtAVertex) {
  PolygonMesh cube;
  cube.positions = scaled(make_cube(), 1.5).positions; // vertex i: + along axis k if bit k is set
  for (const std::array<Index, 4>& face : {std::array<Index, 4>{0, 2, 3, 1},
                                           {4, 5, 7, 6},
                                           {0, 1, 5, 4},
                                           {2, 6, 7, 3},
                                           {0, 4, 6, 2},
                                           {1, 3, 7, 5}}) {
    cube.add_face(face);
  }
  const CageMetrics metrics = measure_cage(cube, make_cube());
  EXPECT_EQ(metrics.max_valence, 3U);
  EXPECT_EQ(metrics.faces, 12U);
  EXPECT_DOUBLE_EQ(metrics.volume, 27);
  EXPECT_GT(measure_cage(scaled(make_cube(), 1.5), make_cube()).max_valence, 3U);
}

TEST(MeasureCage, AveragesOverTheAreaNotTheTriangles) {
  // The mean over a face of the larger cube: 0.5 on the inner square (4/9 of it), more beyond it.
  // By the integral of sqrt(1/4 + u^2) along the sides and sqrt(1/4 + u^2 + v^2) in the corners.
  constexpr int fine = 400;
  double sum = 0;
  for (int i = 0; i < fine; ++i) {
    for (int j = 0; j < fine; ++j) {
      const double u = std::max(0.0, 1.5 * (i + 0.5) / fine - 1);
      const double v = std::max(0.0, 1.5 * (j + 0.5) / fine - 1);
      sum += std::sqrt(0.25 + u * u + v * v);
    }
  }
  const double expected = sum / (fine * fine) / (2 * std::sqrt(3.0));
  const CageMetrics metrics = measure_cage(scaled(make_cube(), 1.5), make_cube());
  EXPECT_NEAR(metrics.mean_distance, expected, 1e-3 * expected);
}

TEST(MeasureCage, HasNoClearanceWhereTheSurfacesCross) {
  TriangleMesh cage = make_cube();
  for (Vec3& p : cage.positions) {
    p.x() += 0.7;
  }
  EXPECT_EQ(measure_cage(cage, make_cube()).clearance, 0);
}

TEST(MeasureCage, DoesNotDependOnTheUnitOrTheThreads) {
  const TriangleMesh cage = make_icosphere(2);
  const TriangleMesh model = make_torus(0.2, 20, 10);
  const auto measured = [&](double unit, int threads) {
    return tbb::task_arena(threads).execute(
        [&] { return measure_cage(scaled(cage, 2 * unit), scaled(model, unit)); });
  };
  const CageMetrics one = measured(1, 1);
  const CageMetrics two = measured(1, 2);
  const CageMetrics tiny = measured(std::ldexp(1, -20), 1);
  EXPECT_EQ(one.mean_distance, two.mean_distance);
  EXPECT_EQ(one.mean_distance, tiny.mean_distance);
  EXPECT_EQ(one.clearance, tiny.clearance);
  EXPECT_EQ(one.volume_ratio, tiny.volume_ratio);
}

TEST(MeasureCage, OfAModelWithoutTrianglesHasNoDistances) {
  const CageMetrics metrics = measure_cage(make_cube(), TriangleMesh());
  EXPECT_EQ(metrics.model_volume_method, VolumeMethod::none);
  EXPECT_EQ(metrics.volume_ratio, 0);
  EXPECT_EQ(metrics.clearance, 0);
  EXPECT_EQ(metrics.volume, 8);
}

TEST(ModelVolume, OfAClosedSoupOrAnInvertedMeshIsExact) {
  const TriangleMesh cube = make_cube();
  TriangleMesh soup;
  for (const Triangle& t : cube.triangles) {
    const auto first = static_cast<Index>(soup.positions.size());
    for (const Index v : t) {
      soup.positions.push_back(cube.positions[v]);
    }
    soup.triangles.push_back({first, first + 2, first + 1});
  }
  const ModelVolume volume = model_volume(soup);
  EXPECT_EQ(volume.method, VolumeMethod::exact);
  EXPECT_DOUBLE_EQ(volume.value, 8);
}

TEST(ModelVolume, OfAnOpenMeshIsThatOfTheClosedOneToAPercent) {
  for (const bool inverted : {false, true}) {
    TriangleMesh sphere = make_icosphere(4);
    const double whole = signed_volume(sphere);
    // A hole of the size of a thumb in a fist.
    std::erase_if(sphere.triangles, [&](const Triangle& t) {
      return sphere.positions[t[0]].dot(Vec3(1, 2, 3).normalized()) > 0.95;
    });
    for (Triangle& t : sphere.triangles) {
      if (inverted) {
        std::swap(t[0], t[1]);
      }
    }
    const ModelVolume volume = model_volume(sphere);
    EXPECT_EQ(volume.method, VolumeMethod::sampled);
    EXPECT_NEAR(volume.value, whole, 0.01 * whole);
  }
}

/// Two meshes as one.
TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto offset = static_cast<Index>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return a;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) {
    std::swap(t[0], t[1]);
  }
  return mesh;
}

TriangleMesh grown(TriangleMesh mesh, double factor, const Vec3& shift = Vec3::Zero()) {
  for (Vec3& p : mesh.positions) {
    p = factor * p + shift;
  }
  return mesh;
}

TEST(ModelVolume, CountsWhatPartsEncloseOnce) {
  const TriangleMesh sphere = make_icosphere(4);
  const double whole = signed_volume(sphere);
  const struct {
    const char* what;
    TriangleMesh model;
    double volume;
  } cases[] = {
      {"every face twice", both(sphere, turned_inside_out(sphere)), whole},
      {"the same twice", both(sphere, sphere), whole},
      {"skin, bone", both(sphere, grown(sphere, 0.4)), whole},
      {"a hollow", both(sphere, turned_inside_out(grown(sphere, 0.9))), whole},
      {"skin above skin", both(sphere, grown(sphere, 1.01)), 1.01 * 1.01 * 1.01 * whole},
      {"one of two inside out", both(sphere, turned_inside_out(grown(sphere, 1, {3, 0, 0}))),
       2 * whole},
  };
  for (const auto& [what, model, expected] : cases) {
    const ModelVolume volume = model_volume(model);
    EXPECT_EQ(volume.method, VolumeMethod::enclosed) << what;
    EXPECT_NEAR(volume.value, expected, 0.015 * expected) << what;
  }
  const ModelVolume apart = model_volume(both(sphere, grown(sphere, 1, {3, 0, 0})));
  EXPECT_EQ(apart.method, VolumeMethod::exact);
  EXPECT_NEAR(apart.value, 2 * whole, 1e-9);
}

TEST(ModelVolume, OfADoubledSheetIsNothing) {
  TriangleMesh sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0.25}, {1, 1, 0.375}, {0, 1, 0.125}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  EXPECT_EQ(model_volume(sheet).value, 0);
}

TEST(ModelVolume, OfAFlatSheetIsNothing) {
  TriangleMesh sheet;
  sheet.positions = {{0, 0, 0}, {1, 0, 0.25}, {1, 1, 0.375}, {0, 1, 0.125}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(model_volume(sheet).value, 0);
  EXPECT_EQ(model_volume(TriangleMesh()).method, VolumeMethod::none);
}

} // namespace
} // namespace cagewright
