// Cost of binding by each kind of coordinates, per pair of a point and a cage triangle (a quad
// counts as two), on one thread.
//
// On the Armadillo in cages of 100 vertices, of triangles and of quads, made by generate(); it is
// looked for in the folder CAGEWRIGHT_MODELS, or build/models. Where it is not there, and besides:
// points of a torus inside a torus of 100 vertices.

#include "mesh/shapes.h"
#include <cagewright/cage/generate.h>
#include <cagewright/coordinates/kinds.h>
#include <cagewright/io/read_mesh.h>
#include <cagewright/mesh/polygon_mesh.h>
#include <cagewright/mesh/triangulate.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

/// What is bound to what.
struct Scene {
  std::vector<Vec3> points;
  PolygonMesh cage;

  [[nodiscard]] std::size_t triangle_count() const {
    std::size_t count = 0;
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      count += cage.face(f).size() - 2;
    }
    return count;
  }

  /// Tiles of sixteen points that follow each other, spread over the model.
  [[nodiscard]] std::vector<Vec3> some_points() const {
    constexpr std::size_t tiles = 64;
    const std::size_t step = std::max<std::size_t>(points.size() / 16 / tiles, 1);
    std::vector<Vec3> some;
    for (std::size_t first = 0; first + 16 <= points.size(); first += 16 * step) {
      some.insert(some.end(), points.begin() + static_cast<std::ptrdiff_t>(first),
                  points.begin() + static_cast<std::ptrdiff_t>(first + 16));
    }
    return some;
  }
};

using Place = const std::optional<Scene>& (*)();

const std::optional<Scene>& torus() {
  static const std::optional<Scene> made(
      Scene{make_torus(0.25, 64, 16).positions, PolygonMesh(make_torus(0.4, 10, 10))});
  return made;
}

const std::optional<Scene>& torus_of_quads() {
  static const std::optional<Scene> made = [] {
    Scene scene = *torus();
    const PolygonMesh triangles = std::exchange(scene.cage, {});
    scene.cage.positions = triangles.positions;
    for (std::size_t f = 0; f + 1 < triangles.face_count(); f += 2) {
      const std::span<const Index> first = triangles.face(f);
      const std::span<const Index> second = triangles.face(f + 1);
      // Between two corners of the first comes the corner of the second that it lacks.
      for (std::size_t k = 0; k < 3; ++k) {
        const Index own = second[k];
        if (std::ranges::find(first, own) == first.end()) {
          const Index before = second[(k + 2) % 3];
          const auto at =
              static_cast<std::size_t>(std::ranges::find(first, before) - first.begin());
          scene.cage.add_face({first[at], own, first[(at + 1) % 3], first[(at + 2) % 3]});
        }
      }
    }
    return scene;
  }();
  return made;
}

std::optional<Scene> armadillo_in(bool quads) {
  const char* named = std::getenv("CAGEWRIGHT_MODELS");
  const std::filesystem::path folder = named != nullptr ? named : "build/models";
  if (!std::filesystem::exists(folder / "armadillo.off")) {
    return std::nullopt;
  }
  const Result<PolygonMesh> model = read_mesh(folder / "armadillo.off");
  if (!model) {
    return std::nullopt;
  }
  const TriangleMesh triangles = to_triangle_mesh(*model);
  Result<GeneratedCage> made = generate(triangles, {.vertices = 100, .quads = quads});
  return made ? std::optional(Scene{model->positions, made->faces}) : std::nullopt;
}

const std::optional<Scene>& armadillo() {
  static const std::optional<Scene> made = armadillo_in(false);
  return made;
}

const std::optional<Scene>& armadillo_in_quads() {
  static const std::optional<Scene> made = armadillo_in(true);
  return made;
}

/// \returns nothing where the scene or the coordinates cannot be had; the state says why
std::shared_ptr<const Coordinates> prepared(benchmark::State& state, const CoordinateKind* kind,
                                            Place place) {
  if (!place()) {
    state.SkipWithError("armadillo.off is not in CAGEWRIGHT_MODELS or build/models");
    return nullptr;
  }
  auto coordinates = prepare_coordinates(place()->cage, CoordinateSettings(*kind));
  if (!coordinates) {
    state.SkipWithError(coordinates.error().message.c_str());
    return nullptr;
  }
  return *coordinates;
}

void solve(benchmark::State& state, const CoordinateKind* kind, Place place) {
  const auto coordinates = prepared(state, kind, place);
  if (!coordinates) {
    return;
  }
  const std::vector<Vec3> points = place()->some_points();
  std::vector<double> weights(16 * coordinates->columns());
  for (auto _ : state) {
    for (std::size_t first = 0; first < points.size(); first += 16) {
      coordinates->solve(std::span(points).subspan(first, 16), weights);
      benchmark::DoNotOptimize(weights.data());
      benchmark::ClobberMemory();
    }
  }
  const auto pairs = static_cast<double>(points.size() * place()->triangle_count());
  state.counters["ns_per_pair"] = benchmark::Counter(
      pairs * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// With the errors that it states, and the time of all points on all threads.
void bind(benchmark::State& state, const CoordinateKind* kind, Place place) {
  for (auto _ : state) {
    const auto coordinates = prepared(state, kind, place);
    if (!coordinates) {
      return;
    }
    benchmark::DoNotOptimize(solve_all<float>(*coordinates, place()->points));
    state.counters["stated_error"] = coordinates->error_estimate();
  }
}

void register_all(const CoordinateKind* kind, const std::string& scene, Place place) {
  const std::string name = std::string(kind->name) + "/" + scene;
  benchmark::RegisterBenchmark(("Kind/" + name).c_str(), solve, kind, place)
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("Bind/" + name).c_str(), bind, kind, place)
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Iterations(1);
}

const bool registered = [] {
  for (const CoordinateKind* kind : coordinate_kinds()) {
    const bool quads = kind->quads == "bilinear";
    register_all(kind, "torus", torus);
    register_all(kind, "armadillo", armadillo);
    if (quads) {
      register_all(kind, "torus_of_quads", torus_of_quads);
      register_all(kind, "armadillo_in_quads", armadillo_in_quads);
    }
  }
  return true;
}();

} // namespace
} // namespace cagewright
