#include "coordinates/surface.h"

#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

namespace cagewright {
namespace {

using Real = long double; // rounded once, when they are stored
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

/// Edges whose triangles do not run along it as often one way as the other.
std::size_t count_open(const std::vector<EdgeUse>& uses) {
  std::size_t open = 0;
  for (std::size_t i = 0; i < uses.size();) {
    int balance = 0;
    std::size_t j = i;
    for (; j < uses.size() && uses[j].same_edge(uses[i]); ++j) {
      balance += uses[j].direction;
    }
    open += balance != 0 && uses[i].from != uses[i].to ? 1 : 0;
    i = j;
  }
  return open;
}

template <class Vector>
std::array<double, 4> affine(const Vector& gradient, const Vector& zero_at) {
  return {static_cast<double>(gradient.x()), static_cast<double>(gradient.y()),
          static_cast<double>(gradient.z()), static_cast<double>(-gradient.dot(zero_at))};
}

Surface::Face make_face(const Triangle& t, std::span<const Vec3> positions) {
  std::array<RealVec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = positions[t[i]].cast<Real>();
  }
  const RealVec3 area = (p[1] - p[0]).cross(p[2] - p[0]);
  const RealVec3 normal = area.normalized();
  Surface::Face face;
  face.vertices = t;
  face.normal = normal.cast<double>();
  face.twice_area = static_cast<double>(area.norm());
  // The height is 0 on the plane, positive behind the face: inside.
  face.height = affine<RealVec3>(-normal, p[0]);
  std::array<RealVec3, 3> outward;
  std::array<Real, 3> share;
  for (std::size_t e = 0; e < 3; ++e) {
    const RealVec3 edge = p[(e + 1) % 3] - p[e];
    const RealVec3 along = edge.normalized();
    outward[e] = along.cross(normal);
    face.along[e] = along.cast<double>();
    face.outward[e] = outward[e].cast<double>();
    face.length[e] = static_cast<double>(edge.norm());
    share[(e + 2) % 3] = edge.norm() / area.norm();
    face.rho[e] = affine<RealVec3>(-outward[e], p[e]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    face.share[i] = static_cast<double>(share[i]);
    for (std::size_t e = 0; e < 3; ++e) {
      face.slope[i][e] = static_cast<double>(-share[i] * outward[(i + 1) % 3].dot(outward[e]));
    }
  }
  return face;
}

Surface::Edge make_edge(Index from, Index to, std::span<const Vec3> positions) {
  const RealVec3 edge = positions[to].cast<Real>() - positions[from].cast<Real>();
  return {from, to, edge.normalized().cast<double>(), static_cast<double>(edge.norm())};
}

/// Six times the volume, about the origin.
Real signed_volume6(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  Real sum = 0;
  for (const Triangle& t : triangles) {
    sum += positions[t[0]].cast<Real>().dot(
        positions[t[1]].cast<Real>().cross(positions[t[2]].cast<Real>()));
  }
  return sum;
}

} // namespace

std::vector<EdgeUse> edge_uses(std::span<const Triangle> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = triangles[t][(i + 1) % 3];
      const Index b = triangles[t][(i + 2) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, i, a < b ? 1 : -1});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.from, a.to, a.triangle, a.opposite) <
           std::tie(b.from, b.to, b.triangle, b.opposite);
  });
  return uses;
}

Status check_surface(TriangleView cage, bool allow_open) {
  const auto invalid = [](std::string message) {
    return Error{ErrorCode::invalid_cage, std::move(message)};
  };
  if (cage.triangles.empty()) {
    return invalid("the cage has no faces");
  }
  for (std::size_t t = 0; t < cage.triangles.size(); ++t) {
    for (const Index v : cage.triangles[t]) {
      if (v >= cage.positions.size()) {
        return invalid("triangle " + std::to_string(t) + " of the cage refers to vertex " +
                       std::to_string(v) + ", but there are " +
                       std::to_string(cage.positions.size()));
      }
      if (!cage.positions[v].allFinite()) {
        return invalid("vertex " + std::to_string(v) + " of the cage is not finite");
      }
    }
  }
  if (!allow_open) {
    const std::size_t open = count_open(edge_uses(cage.triangles));
    if (open > 0) {
      return invalid("the cage has " + std::to_string(open) + " open or inconsistent edge" +
                     (open == 1 ? "" : "s"));
    }
  }
  return success();
}

TriangulatedCage triangulated(const PolygonMesh& cage, QuadTreatment quads) {
  TriangulatedCage result;
  result.mesh.positions = cage.positions;
  const Triangulation triangulation = triangulate(cage);
  for (std::size_t t = 0; t < triangulation.triangles.size(); ++t) {
    const std::span<const Index> corners = cage.face(triangulation.face_of[t]);
    if (corners.size() != 4 || quads == QuadTreatment::diagonal) {
      result.mesh.triangles.push_back(triangulation.triangles[t]);
      continue;
    }
    if (t > 0 && triangulation.face_of[t] == triangulation.face_of[t - 1]) {
      continue; // the second triangle of a quad
    }
    const auto middle = static_cast<Index>(cage.positions.size() + result.quads.size());
    for (std::size_t i = 0; i < 4; ++i) {
      result.mesh.triangles.push_back({corners[i], corners[(i + 1) % 4], middle});
    }
    result.quads.push_back({corners[0], corners[1], corners[2], corners[3]});
  }
  result.mesh.positions = with_middles(cage.positions, result.quads);
  return result;
}

std::vector<Vec3> with_middles(std::span<const Vec3> cage,
                               std::span<const std::array<Index, 4>> quads) {
  std::vector<Vec3> positions(cage.begin(), cage.end());
  for (const std::array<Index, 4>& quad : quads) {
    positions.emplace_back((cage[quad[0]] + cage[quad[1]] + cage[quad[2]] + cage[quad[3]]) / 4);
  }
  return positions;
}

Result<CageFrame> frame_of(TriangleView cage) {
  const Box3 box = bounding_box(cage);
  const double diagonal = box.diagonal().norm();
  if (!(diagonal > 0) || !std::isfinite(diagonal)) {
    return Error{ErrorCode::invalid_cage, "the cage has no extent"};
  }
  return CageFrame{box.center(), std::ldexp(1.0, -std::ilogb(diagonal) - 1), diagonal};
}

Result<Surface> Surface::create(const PolygonMesh& cage, QuadTreatment quads) {
  TriangulatedCage cut = triangulated(cage, quads);
  if (Status status = check_surface(cut.mesh, false); !status) {
    return status.error();
  }
  const Result<CageFrame> frame = frame_of(cut.mesh);
  if (!frame) {
    return frame.error();
  }
  Surface surface;
  surface.frame = *frame;
  surface.cage_vertices = cage.positions.size();
  surface.quads = std::move(cut.quads);
  std::vector<char> used(cut.mesh.positions.size(), 0);
  for (const Triangle& t : cut.mesh.triangles) {
    for (const Index v : t) {
      used[v] = 1;
    }
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    // A vertex without faces may be anywhere, even at infinity.
    surface.positions.push_back(used[v] != 0 ? frame->to_frame(cut.mesh.positions[v])
                                             : Vec3(Vec3::Zero()));
  }
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < cut.mesh.triangles.size(); ++i) {
    const Triangle& t = cut.mesh.triangles[i];
    if (!is_degenerate<RealVec3>(surface.positions[t[0]].cast<Real>(),
                                 surface.positions[t[1]].cast<Real>(),
                                 surface.positions[t[2]].cast<Real>())) {
      kept.push_back(t);
      surface.source.push_back(i);
    }
  }
  if (kept.empty()) {
    return Error{ErrorCode::invalid_cage, "the faces of the cage have no area"};
  }
  surface.is_turned = signed_volume6(surface.positions, kept) < 0;
  if (surface.is_turned) {
    for (Triangle& t : kept) {
      std::swap(t[1], t[2]);
    }
  }
  surface.connect(kept);
  return surface;
}

Surface Surface::of_triangles(const CageFrame& frame, std::vector<Vec3> positions,
                              std::span<const Triangle> triangles) {
  Surface surface;
  surface.frame = frame;
  surface.cage_vertices = positions.size();
  surface.positions = std::move(positions);
  surface.connect(triangles);
  return surface;
}

void Surface::connect(std::span<const Triangle> triangles) {
  for (const Triangle& t : triangles) {
    faces.push_back(make_face(t, positions));
  }
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == 0 || !uses[i].same_edge(uses[i - 1])) {
      edges.push_back(make_edge(uses[i].from, uses[i].to, positions));
    }
    // Edge e of a face is opposite corner e + 2.
    faces[uses[i].triangle].edges[(uses[i].opposite + 1) % 3] =
        static_cast<Index>(edges.size() - 1);
  }
}

std::vector<Triangle> Surface::triangles() const {
  std::vector<Triangle> all;
  for (const Face& face : faces) {
    all.push_back(face.vertices);
  }
  return all;
}

std::vector<Index> Surface::used_vertices() const {
  std::vector<char> used(positions.size(), 0);
  for (const Face& face : faces) {
    for (const Index v : face.vertices) {
      used[v] = 1;
    }
  }
  std::vector<Index> list;
  for (Index v = 0; v < used.size(); ++v) {
    if (used[v] != 0) {
      list.push_back(v);
    }
  }
  return list;
}

} // namespace cagewright
