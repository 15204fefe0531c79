#include "cage/canonical_model.h"

#include "symmetry/half.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace cagewright {
namespace {

/// Finer than what files of six digits resolve; coarser, by far, than what doubles do.
constexpr double usual_grid = 0x1.0p-20;
constexpr double of_the_clearance = 0x1.0p-8;

std::array<double, 3> key_of(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

/// The triangle begun at its first corner, in some order of the vertices.
Triangle turned_to_first(const Triangle& t, const std::vector<Index>& order) {
  const auto at = [&](std::size_t k) { return order[t[k]]; };
  const std::size_t k = at(0) <= at(1) && at(0) <= at(2) ? 0 : at(1) <= at(2) ? 1 : 2;
  return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
}

/// Both positions of every pair from the one that was made; on the plane, their own images.
void pair_exactly(std::vector<Vec3>& positions, MirrorPairing& pairing, const MirrorFrame& frame) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const std::size_t partner = pairing.vertex_partners[v];
    if (partner < v) {
      continue;
    }
    Vec3 p = frame.to_frame(positions[v]);
    if (partner == v) {
      p.x() = 0;
    }
    const auto [here, there] = frame.from_frame(p);
    positions[v] = here;
    positions[partner] = there;
  }
  pairing.error = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3& image = positions[pairing.vertex_partners[v]];
    pairing.error = std::max(pairing.error, (frame.plane().mirrored(positions[v]) - image).norm());
  }
  if (frame.plane().axis() >= 0) {
    pairing.error = 0; // the pairs are exact, which doubles need not show
  }
}

} // namespace

double canonical_grid(double clearance) {
  double grid = usual_grid;
  while (grid > of_the_clearance * clearance) {
    grid /= 2;
  }
  return grid;
}

CanonicalModel canonical_model(TriangleView model, const UnitFrame& frame, double grid,
                               const Progress& progress) {
  CanonicalModel result;
  result.frame = frame;
  std::vector<Vec3> rounded = to_unit(frame, model.positions);
  for (Vec3& p : rounded) {
    for (int a = 0; a < 3; ++a) {
      p[a] = std::round(p[a] / grid) * grid + 0.0; // no negative zeros
    }
  }
  result.vertices.resize(rounded.size());
  std::iota(result.vertices.begin(), result.vertices.end(), Index{0});
  std::stable_sort(result.vertices.begin(), result.vertices.end(),
                   [&](Index a, Index b) { return key_of(rounded[a]) < key_of(rounded[b]); });
  if (progress.cancelled()) {
    return result;
  }
  std::vector<Index> number(rounded.size());
  std::vector<Index> place(rounded.size()); // the same for all vertices at one place
  for (std::size_t i = 0; i < result.vertices.size(); ++i) {
    const Index v = result.vertices[i];
    result.mesh.positions.push_back(rounded[v]);
    number[v] = static_cast<Index>(i);
    place[i] = i > 0 && rounded[v] == rounded[result.vertices[i - 1]] ? place[i - 1]
                                                                      : static_cast<Index>(i);
  }
  for (const Triangle& t : model.triangles) {
    result.mesh.triangles.push_back(
        turned_to_first({number[t[0]], number[t[1]], number[t[2]]}, place));
  }
  if (progress.cancelled()) {
    return result;
  }
  const auto places = [&](const Triangle& t) {
    return std::array{place[t[0]], place[t[1]], place[t[2]]};
  };
  std::stable_sort(result.mesh.triangles.begin(), result.mesh.triangles.end(),
                   [&](const Triangle& s, const Triangle& t) { return places(s) < places(t); });
  return result;
}

void bring_back(GeneratedCage& made, TriangleView model, const UnitFrame& frame) {
  std::vector<Vec3>& positions = made.faces.positions;
  for (Vec3& p : positions) {
    p = frame.from_unit(p);
  }
  if (made.mirror) {
    MirrorPlane& plane = made.mirror->plane;
    plane.offset = plane.offset * frame.diagonal + plane.normal.dot(frame.center);
    made.mirror->error *= frame.diagonal;
    if (made.mirror->in_plane) {
      const MirrorFrame mirror(plane, bounding_box(model.positions));
      plane = mirror.plane();
      pair_exactly(positions, *made.mirror, mirror);
    }
  }
  made.triangles.positions = positions; // triangles have the same vertices
  for (Remark& remark : made.remarks) {
    if (remark.place) {
      remark.place = frame.from_unit(*remark.place);
    }
  }
}

} // namespace cagewright
