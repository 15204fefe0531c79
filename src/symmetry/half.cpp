#include "symmetry/half.h"

#include "mesh/disjoint_sets.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace cagewright {
namespace {

constexpr Index none = std::numeric_limits<Index>::max();

Vec3 image_of(const Vec3& p) {
  return {-p.x(), p.y(), p.z()};
}

/// Vertices of the whole, and their partners.
struct PairedVertices {
  std::vector<Vec3> positions;
  std::vector<Index> images; ///< of each vertex of the half, the number of its image
};

PairedVertices pair_vertices(std::span<const Vec3> half, const MirrorFrame& frame) {
  PairedVertices result;
  result.positions.reserve(2 * half.size());
  std::vector<Vec3> images;
  for (const Vec3& p : half) {
    const auto [at, image] = frame.from_frame(p);
    result.positions.push_back(at);
    if (p.x() == 0) {
      result.images.push_back(static_cast<Index>(result.images.size()));
    } else {
      result.images.push_back(static_cast<Index>(half.size() + images.size()));
      images.push_back(image);
    }
  }
  result.positions.insert(result.positions.end(), images.begin(), images.end());
  return result;
}

MirrorPairing pairing_of(const PairedVertices& vertices, std::size_t half_faces,
                         const MirrorFrame& frame) {
  MirrorPairing pairing;
  pairing.plane = frame.plane();
  pairing.vertex_partners.resize(vertices.positions.size());
  for (Index v = 0; v < vertices.images.size(); ++v) {
    pairing.vertex_partners[v] = vertices.images[v];
    pairing.vertex_partners[vertices.images[v]] = v;
    const Vec3& p = vertices.positions[v];
    const Vec3& q = vertices.positions[vertices.images[v]];
    const int axis = pairing.plane.axis();
    Vec3 off = q - pairing.plane.mirrored(p);
    if (axis >= 0) { // each difference below is exact, or shows that it is not zero
      off = q - p;
      off[axis] = (p[axis] + q[axis]) - 2 * pairing.plane.offset;
    }
    pairing.error = std::max(pairing.error, off.norm());
  }
  pairing.face_partners.resize(2 * half_faces);
  for (std::size_t f = 0; f < half_faces; ++f) {
    pairing.face_partners[f] = static_cast<Index>(f + half_faces);
    pairing.face_partners[f + half_faces] = static_cast<Index>(f);
  }
  return pairing;
}

} // namespace

MirrorFrame::MirrorFrame(const MirrorPlane& plane, const Box3& box)
    : plane_(plane), axis_(plane.axis()) {
  if (axis_ < 0) {
    Eigen::Index least = 0;
    plane_.normal.cwiseAbs().minCoeff(&least);
    const Vec3 u = plane_.normal.cross(Vec3::Unit(least)).normalized();
    axes_.col(0) = plane_.normal;
    axes_.col(1) = u;
    axes_.col(2) = plane_.normal.cross(u);
    const Vec3 center = box.center();
    origin_ = center - (plane_.normal.dot(center) - plane_.offset) * plane_.normal;
    return;
  }
  if (plane_.offset != 0) {
    // Multiples of a power of two, fewer than 2^53 of it up to the largest coordinate there can be:
    // their sums and differences are exact.
    const double largest = std::abs(plane_.offset) + 4 * box.diagonal().norm();
    constexpr int digits = std::numeric_limits<double>::digits;
    unit_ = std::ldexp(1.0, std::ilogb(largest) + 1 - digits);
    plane_.offset = std::round(plane_.offset / unit_) * unit_;
  }
}

Vec3 MirrorFrame::to_frame(const Vec3& p) const {
  if (axis_ < 0) {
    return axes_.transpose() * (p - origin_);
  }
  return {p[axis_] - plane_.offset, p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]};
}

std::array<Vec3, 2> MirrorFrame::from_frame(const Vec3& p) const {
  if (axis_ < 0) {
    return {origin_ + axes_ * p, origin_ + axes_ * image_of(p)};
  }
  const double d = unit_ > 0 ? std::round(p.x() / unit_) * unit_ : p.x();
  std::array<Vec3, 2> pair;
  for (Vec3& at : pair) {
    at[(axis_ + 1) % 3] = p.y();
    at[(axis_ + 2) % 3] = p.z();
  }
  pair[0][axis_] = plane_.offset + d;
  pair[1][axis_] = plane_.offset - d;
  return pair;
}

HalfModel half_model(TriangleView model, const MirrorFrame& frame) {
  const TriangleMesh whole = in_frame(model, frame);
  HalfModel half;
  const auto count = static_cast<Index>(whole.positions.size());
  std::vector<Index> number(2 * whole.positions.size(), none); // of vertices, and of their images
  const auto vertex = [&](Index v, bool image) {
    Index& n = number[image ? v + count : v];
    if (n == none) {
      n = static_cast<Index>(half.mesh.positions.size());
      half.mesh.positions.push_back(image ? image_of(whole.positions[v]) : whole.positions[v]);
      half.vertices.push_back(v);
    }
    return n;
  };
  std::vector<bool> used(count, false);
  for (const auto& [a, b, c] : whole.triangles) {
    const double xa = whole.positions[a].x();
    const double xb = whole.positions[b].x();
    const double xc = whole.positions[c].x();
    used[a] = used[b] = used[c] = true;
    if (std::max({xa, xb, xc}) >= 0) {
      half.mesh.triangles.push_back({vertex(a, false), vertex(b, false), vertex(c, false)});
    }
    if (std::min({xa, xb, xc}) <= 0) {
      half.mesh.triangles.push_back({vertex(a, true), vertex(c, true), vertex(b, true)});
    }
  }
  for (Index v = 0; v < count; ++v) {
    if (!used[v]) {
      vertex(v, whole.positions[v].x() < 0);
    }
  }
  return half;
}

TriangleMesh mirror_image(TriangleView model, const MirrorPlane& plane) {
  TriangleMesh image;
  image.positions.reserve(model.positions.size());
  for (const Vec3& p : model.positions) {
    image.positions.push_back(plane.mirrored(p));
  }
  image.triangles.reserve(model.triangles.size());
  for (const auto& [a, b, c] : model.triangles) {
    image.triangles.push_back({a, c, b});
  }
  return image;
}

TriangleMesh in_frame(TriangleView model, const MirrorFrame& frame) {
  TriangleMesh result;
  result.positions.reserve(model.positions.size());
  for (const Vec3& p : model.positions) {
    result.positions.push_back(frame.to_frame(p));
  }
  result.triangles.assign(model.triangles.begin(), model.triangles.end());
  return result;
}

std::optional<TriangleMesh> cut_half(TriangleView surface) {
  TriangleMesh cut{{surface.positions.begin(), surface.positions.end()}, {}};
  // No vertex may lie on the plane but those that the cut makes.
  const double least = 1e-9 * diagonal(surface.positions);
  for (Vec3& p : cut.positions) {
    if (std::abs(p.x()) < least) {
      p.x() = p.x() < 0 ? -least : least;
    }
  }
  std::map<std::array<Index, 2>, Index> crossings;
  const auto crossing = [&](Index a, Index b) {
    const std::array<Index, 2> edge = {std::min(a, b), std::max(a, b)};
    const auto [at, fresh] = crossings.try_emplace(edge, static_cast<Index>(cut.positions.size()));
    if (fresh) {
      const Vec3 p = cut.positions[edge[0]];
      const Vec3 q = cut.positions[edge[1]];
      Vec3 middle = p + p.x() / (p.x() - q.x()) * (q - p);
      middle.x() = 0;
      cut.positions.push_back(middle);
    }
    return at->second;
  };
  for (const Triangle& t : surface.triangles) {
    std::array<bool, 3> kept{};
    for (int i = 0; i < 3; ++i) {
      kept[i] = cut.positions[t[i]].x() > 0;
    }
    const auto count = std::count(kept.begin(), kept.end(), true);
    if (count == 3) {
      cut.triangles.push_back(t);
    } else if (count > 0) {
      // The corner that is alone on its side comes first.
      int first = 0;
      while (kept[first] != (count == 1)) {
        ++first;
      }
      const Index a = t[first];
      const Index b = t[(first + 1) % 3];
      const Index c = t[(first + 2) % 3];
      const Index ab = crossing(a, b);
      const Index ca = crossing(c, a);
      if (count == 1) {
        cut.triangles.push_back({a, ab, ca});
      } else {
        cut.triangles.push_back({ab, b, c});
        cut.triangles.push_back({ab, c, ca});
      }
    }
  }
  if (crossings.empty()) {
    return std::nullopt;
  }
  // The largest piece: seen from a point of the plane what closes it has no volume.
  DisjointSets pieces(cut.positions.size());
  for (const Triangle& t : cut.triangles) {
    pieces.join(t);
  }
  std::vector<double> volume(cut.positions.size(), 0);
  const Vec3 origin = cut.positions[crossings.begin()->second];
  for (const Triangle& t : cut.triangles) {
    volume[pieces.find(t[0])] +=
        (cut.positions[t[0]] - origin)
            .dot((cut.positions[t[1]] - origin).cross(cut.positions[t[2]] - origin));
  }
  const auto largest =
      static_cast<Index>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  TriangleMesh result;
  std::vector<Index> number(cut.positions.size(), none);
  for (Triangle t : cut.triangles) {
    if (pieces.find(t[0]) != largest) {
      continue;
    }
    for (Index& v : t) {
      if (number[v] == none) {
        number[v] = static_cast<Index>(result.positions.size());
        result.positions.push_back(cut.positions[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(t);
  }
  const bool is_cut = std::any_of(result.positions.begin(), result.positions.end(),
                                  [](const Vec3& p) { return p.x() == 0; });
  return is_cut ? std::optional(std::move(result)) : std::nullopt;
}

Whole<TriangleMesh> join_halves(const TriangleMesh& half, const MirrorFrame& frame) {
  PairedVertices vertices = pair_vertices(half.positions, frame);
  Whole<TriangleMesh> whole;
  whole.pairing = pairing_of(vertices, half.triangles.size(), frame);
  whole.mesh.triangles = half.triangles;
  for (const auto& [a, b, c] : half.triangles) {
    whole.mesh.triangles.push_back({vertices.images[a], vertices.images[c], vertices.images[b]});
  }
  whole.mesh.positions = std::move(vertices.positions);
  return whole;
}

Whole<PolygonMesh> join_halves(const PolygonMesh& half, const MirrorFrame& frame) {
  PairedVertices vertices = pair_vertices(half.positions, frame);
  Whole<PolygonMesh> whole;
  whole.pairing = pairing_of(vertices, half.face_count(), frame);
  for (const bool image : {false, true}) {
    for (std::size_t f = 0; f < half.face_count(); ++f) {
      const auto face = half.face(f);
      std::vector<Index> corners(face.begin(), face.end());
      if (image) {
        for (Index& v : corners) {
          v = vertices.images[v];
        }
        std::reverse(corners.begin() + 1, corners.end());
      }
      whole.mesh.add_face(corners);
    }
  }
  whole.mesh.positions = std::move(vertices.positions);
  return whole;
}

} // namespace cagewright
