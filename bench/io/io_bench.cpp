// How fast files become meshes and meshes files, without the disk: from memory, to memory.
#include <cagewright/io/read_mesh.h>
#include <cagewright/io/write_mesh.h>

#include "mesh/shapes.h"

#include <benchmark/benchmark.h>

namespace cagewright {
namespace {

// A torus of the given number of triangles, with full digits in most coordinates.
PolygonMesh make_model(std::int64_t triangles) {
  const auto around = static_cast<Index>(triangles / 200);
  return PolygonMesh(make_torus(0.3, around, 100));
}

void read(benchmark::State& state, MeshFormat format, WriteOptions options) {
  const Result<std::string> bytes = format_mesh(make_model(state.range(0)), format, options);
  for (auto _ : state) {
    benchmark::DoNotOptimize(read_mesh(*bytes, format, "model"));
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes->size()));
}

void write(benchmark::State& state, MeshFormat format, WriteOptions options) {
  const PolygonMesh mesh = make_model(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(format_mesh(mesh, format, options));
  }
}

#define CAGEWRIGHT_BENCH(name, ...)                                                                \
  BENCHMARK_CAPTURE(name, __VA_ARGS__)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond)

CAGEWRIGHT_BENCH(read, obj, MeshFormat::obj, {});
CAGEWRIGHT_BENCH(read, off, MeshFormat::off, {});
CAGEWRIGHT_BENCH(read, ply, MeshFormat::ply, {});
CAGEWRIGHT_BENCH(read, ply_text, MeshFormat::ply, {.ascii_ply = true});
CAGEWRIGHT_BENCH(read, stl_text, MeshFormat::stl, {});
CAGEWRIGHT_BENCH(write, obj, MeshFormat::obj, {});
CAGEWRIGHT_BENCH(write, ply, MeshFormat::ply, {});

} // namespace
} // namespace cagewright
