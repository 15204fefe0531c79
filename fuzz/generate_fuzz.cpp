// Small meshes and options made of any bytes: a cage that the judge finds valid and that is as
// asked for or says why not, or one line of error.
#include "require.h"

#include <cagewright/cage/generate.h>
#include <cagewright/cage/option_table.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using namespace cagewright;
using fuzz::require;
using fuzz::require_one_line;

constexpr int most_vertices = 12;
constexpr int most_triangles = 20;

/// A coordinate: mostly of a small grid, so that much touches, is flat, or lies on top of another.
double coordinate(FuzzedDataProvider& bytes) {
  switch (bytes.ConsumeIntegralInRange(0, 7)) {
  case 0:
    return bytes.ConsumeFloatingPointInRange(-4.0, 4.0);
  case 1:
    return bytes.ConsumeFloatingPoint<double>();
  case 2:
    return std::ldexp(1.0, bytes.ConsumeIntegralInRange(-60, 60));
  default:
    return bytes.ConsumeIntegralInRange(-4, 4);
  }
}

TriangleMesh mesh_of(FuzzedDataProvider& bytes) {
  TriangleMesh mesh;
  const int vertices = bytes.ConsumeIntegralInRange(3, most_vertices);
  for (int v = 0; v < vertices; ++v) {
    mesh.positions.emplace_back(coordinate(bytes), coordinate(bytes), coordinate(bytes));
  }
  const int triangles = bytes.ConsumeIntegralInRange(1, most_triangles);
  const auto corner = [&] {
    return static_cast<Index>(bytes.ConsumeIntegralInRange(0, vertices - 1));
  };
  for (int t = 0; t < triangles; ++t) {
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

/// Any value, more often one that is quick.
template <class T>
T mostly(FuzzedDataProvider& bytes, T quick_least, T quick_most, T least, T most) {
  if constexpr (std::is_integral_v<T>) {
    return bytes.ConsumeIntegralInRange(0, 31) == 0
               ? bytes.ConsumeIntegralInRange(least, most)
               : bytes.ConsumeIntegralInRange(quick_least, quick_most);
  } else {
    return bytes.ConsumeIntegralInRange(0, 31) == 0
               ? bytes.ConsumeFloatingPointInRange(least, most)
               : bytes.ConsumeFloatingPointInRange(quick_least, quick_most);
  }
}

GenerateOptions options_of(FuzzedDataProvider& bytes, std::size_t vertices,
                           std::vector<double>& density) {
  GenerateOptions options;
  options.method = bytes.PickValueInArray({Method::envelope, Method::envelope, Method::envelope,
                                           Method::boxes, Method::boxes_improved});
  options.symmetry = bytes.PickValueInArray(
      {Symmetry::off, Symmetry::automatic, Symmetry::x, Symmetry::y, Symmetry::z});
  options.pieces = bytes.PickValueInArray({Pieces::together, Pieces::apart});
  if (bytes.ConsumeBool()) {
    options.vertices = mostly(bytes, 4, 40, -1, 300);
  }
  if (bytes.ConsumeIntegralInRange(0, 3) == 0) {
    options.faces = mostly(bytes, 4, 80, -1, 400);
  }
  if (bytes.ConsumeIntegralInRange(0, 7) == 0) {
    options.max_gap = mostly(bytes, 0.05, 0.3, -1.0, 1.0);
  }
  options.clearance = mostly(bytes, 0.001, 0.05, -1.0, 1.0);
  options.quads = bytes.ConsumeBool();
  options.rounds = mostly(bytes, 0, 1, -1, 6);
  options.closing =
      bytes.ConsumeIntegralInRange(0, 3) == 0 ? mostly(bytes, 0.0, 0.2, -1.0, 1.0) : 0;
  options.envelope_resolution = mostly(bytes, 8, 24, 0, 48);
  options.resolution = mostly(bytes, 8, 24, -1, 48);
  options.depth = mostly(bytes, 0, 3, -1, 6);
  options.max_boxes = mostly(bytes, 0, 6, -1, 20);
  options.split_parts = bytes.ConsumeBool();
  options.registration = bytes.ConsumeBool();
  if (bytes.ConsumeIntegralInRange(0, 7) == 0) {
    for (std::size_t v = 0; v < vertices; ++v) {
      density.push_back(mostly(bytes, 0.1, 10.0, -1.0, 1e6));
    }
    options.density = density;
  }
  return options;
}

/// The command that shows what was found, and the model.
void show(const TriangleMesh& model, const GenerateOptions& options) {
  std::fputs("generate model.obj", stderr);
  for (const CageOption& option : cage_options()) {
    if (const std::string value = text_of(option, options); value != text_of(option, {})) {
      std::fprintf(stderr, " --%.*s %s", static_cast<int>(option.name.size()), option.name.data(),
                   value.c_str());
    }
  }
  std::fputs("\n", stderr);
  for (const double d : options.density) {
    std::fprintf(stderr, "# density %.17g\n", d);
  }
  for (const Vec3& p : model.positions) {
    std::fprintf(stderr, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
  }
  for (const Triangle& t : model.triangles) {
    std::fprintf(stderr, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
}

void check(const GeneratedCage& made, const TriangleMesh& model, const GenerateOptions& options) {
  ValidateOptions judge;
  judge.allow_pieces = made.pieces > 1;
  const auto report = validate_cage(made.faces, model, judge);
  if (!report->valid()) {
    show(model, options);
    for (const Violation& violation : report->violations) {
      std::fprintf(stderr, "%s\n", std::string(name_of(violation.kind)).c_str());
    }
  }
  require(report->valid(), "the cage is valid");
  require(made.pieces == 1 || options.pieces == Pieces::apart, "pieces are asked for");
  for (const Remark& remark : made.remarks) {
    require_one_line(remark.message);
  }
  if (made.is_as_asked() && options.method != Method::boxes) {
    const auto most = static_cast<std::size_t>(std::max(0, vertex_limit(options)));
    require(most == 0 || made.faces.positions.size() <= most, "vertices are as asked for");
    require(options.faces == 0 ||
                made.faces.face_count() <= static_cast<std::size_t>(options.faces),
            "faces are as asked for");
    require(options.max_gap == 0 || (made.gap && *made.gap > 0), "a gap is proved");
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  std::vector<double> density;
  const TriangleMesh model = mesh_of(bytes);
  const GenerateOptions options = options_of(bytes, model.positions.size(), density);
  if (std::getenv("CAGEWRIGHT_FUZZ_SHOW") != nullptr) { // for what takes too long
    show(model, options);
  }
  const auto made = generate(model, options);
  if (!made) {
    require_one_line(made.error().message);
    require(made.error().code != ErrorCode::cancelled, "nobody cancels");
    return 0;
  }
  check(*made, model, options);
  return 0;
}
