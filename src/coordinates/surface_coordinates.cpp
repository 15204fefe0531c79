#include "coordinates/surface_coordinates.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <string>

namespace cagewright {
namespace {

class InsideCoordinates : public SurfaceCoordinates {
public:
  InsideCoordinates(const PolygonMesh& cage, Surface surface, OutsideTreatment outside,
                    InsideTile tile)
      : SurfaceCoordinates(vertex_columns(cage.positions), std::move(surface), outside),
        used_(this->surface().used_vertices()), tile_(tile) {}

private:
  TileReport solve_framed(std::span<const Vec3> points, double* weights,
                          std::size_t stride) const override {
    return tile_({surface(), used_}, points, {weights, stride});
  }

  std::vector<Index> used_;
  InsideTile tile_;
};

} // namespace

TileReport FramedCoordinates::solve_tile(std::span<const Vec3> points, std::span<double> weights,
                                         std::size_t stride) const {
  assert(points.size() <= 16 && stride >= 16);
  assert(weights.size() >= (columns() - 1) * stride + 16);
  TileReport report;
  if (!points.empty()) {
    std::array<Vec3, 16> framed;
    std::transform(points.begin(), points.end(), framed.begin(),
                   [&](const Vec3& p) { return frame_.to_frame(p); });
    report = solve_framed(std::span(framed).first(points.size()), weights.data(), stride);
  }
  for (std::size_t k = 0; points.size() < 16 && k < columns(); ++k) {
    std::fill_n(weights.data() + k * stride + points.size(), 16 - points.size(), 0.0);
  }
  return report;
}

Result<OutsideTreatment> outside_without_continuation(const CoordinateSettings& settings) {
  const auto outside = static_cast<OutsideTreatment>(settings.choice(outside_option));
  if (outside == OutsideTreatment::continuation) {
    return Error{ErrorCode::invalid_option, "outside: " + std::string(settings.kind().name) +
                                                " coordinates cannot be continued outside the "
                                                "cage; give error or rest"};
  }
  return outside;
}

Result<std::shared_ptr<const ColumnRule>> vertex_rule(const PolygonMesh& cage,
                                                      const CoordinateSettings&) {
  return vertex_columns(cage.positions);
}

Result<std::shared_ptr<const Coordinates>> inside_coordinates(const PolygonMesh& cage,
                                                              QuadTreatment quads,
                                                              OutsideTreatment outside,
                                                              InsideTile tile) {
  Result<Surface> surface = Surface::create(cage, quads);
  if (!surface) {
    return surface.error();
  }
  return std::shared_ptr<const Coordinates>(
      std::make_shared<InsideCoordinates>(cage, *std::move(surface), outside, tile));
}

} // namespace cagewright
