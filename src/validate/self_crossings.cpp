#include "validate/self_crossings.h"

#include "core/parallel.h"
#include "exact/predicates.h"
#include "spatial/bvh.h"
#include <cagewright/mesh/weld.h>

#include <algorithm>

namespace cagewright {
namespace {

int shared_corners(const Triangle& a, const Triangle& b) {
  return static_cast<int>(std::count_if(
      a.begin(), a.end(), [&](Index v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

} // namespace

Result<std::size_t> count_self_crossings(TriangleView mesh, const Progress& progress) {
  const TriangleMesh welded = weld(mesh);
  const TriangleBvh bvh(welded);
  constexpr std::size_t block = 256;
  const std::size_t count = parallel_reduce_ordered(
      0, welded.triangles.size(), block, std::size_t{0},
      [&](std::size_t first, std::size_t last) {
        std::size_t found = 0;
        for (std::size_t i = first; i < last && !progress.cancelled(); ++i) {
          const auto& corners = bvh.corners(static_cast<Index>(i));
          Box3 box(corners[0]);
          box.extend(corners[1]);
          box.extend(corners[2]);
          bvh.visit_box(box, [&](Index j) {
            const bool candidate =
                j > i && shared_corners(welded.triangles[i], welded.triangles[j]) < 2;
            found += candidate && triangles_cross_properly(corners, bvh.corners(j)) ? 1 : 0;
            return true;
          });
        }
        return found;
      },
      [](std::size_t& all, std::size_t part) { all += part; });
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return count;
}

} // namespace cagewright
