#include <cagewright/mesh/weld.h>

#include <bit>
#include <cstdint>
#include <limits>

namespace cagewright {
namespace {

std::uint64_t mixed(std::uint64_t h) {
  h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27U)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 31U);
}

std::uint64_t hash_of(const Vec3& p) {
  std::uint64_t h = 0;
  for (const double x : p) {
    h = mixed(h + 0x9e3779b97f4a7c15ULL + std::bit_cast<std::uint64_t>(x + 0.0)); // -0 becomes 0
  }
  return h;
}

} // namespace

WeldedPoints weld_points(std::span<const Vec3> positions) {
  constexpr Index empty = std::numeric_limits<Index>::max();
  const std::size_t slots = std::bit_ceil(2 * positions.size() + 1);
  std::vector<Index> table(slots, empty); // open addressing: indices of distinct positions
  WeldedPoints result;
  result.positions.reserve(positions.size());
  result.point_of.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& p = positions[i];
    std::size_t slot = hash_of(p) & (slots - 1);
    while (table[slot] != empty && result.positions[table[slot]] != p) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] == empty) {
      table[slot] = static_cast<Index>(result.positions.size());
      result.positions.push_back(p);
      result.first_with.push_back(static_cast<Index>(i));
    }
    result.point_of.push_back(table[slot]);
  }
  return result;
}

TriangleMesh weld(TriangleView mesh) {
  WeldedPoints points = weld_points(mesh.positions);
  TriangleMesh result;
  result.positions = std::move(points.positions);
  result.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.triangles.push_back(
        {points.point_of[t[0]], points.point_of[t[1]], points.point_of[t[2]]});
  }
  return result;
}

PolygonMesh weld(const PolygonMesh& mesh) {
  WeldedPoints points = weld_points(mesh.positions);
  PolygonMesh result;
  result.positions = std::move(points.positions);
  std::vector<Index> face;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    face.clear();
    for (const Index v : mesh.face(f)) {
      face.push_back(points.point_of[v]);
    }
    result.add_face(face);
  }
  return result;
}

} // namespace cagewright
