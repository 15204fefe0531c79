// The one translation unit that uses the GPL packages of CGAL.
#include "cage/unite.h"

#include "core/maths.h"
#include "mesh/disjoint_sets.h"
#include <cagewright/validate/validate_cage.h>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Exact::Point_3;

/// Triangles with exact corners; plane[t] tells which plane of the input triangle t lies in.
struct ExactMesh {
  std::vector<ExactPoint> points;
  std::vector<Triangle> triangles;
  std::vector<Index> planes;
};

ExactPoint exact(const Vec3& p) {
  return {p.x(), p.y(), p.z()};
}

Vec3 rounded(const ExactPoint& p) {
  const auto& e = p.exact();
  return {CGAL::to_double(e.x()), CGAL::to_double(e.y()), CGAL::to_double(e.z())};
}

// ---------------------------------------------------------------------------------------------
// The solids, made larger by distinct amounts
// ---------------------------------------------------------------------------------------------

Box3 bounds(const Hexahedron& solid) {
  Box3 box;
  for (const Vec3& corner : solid.corners) {
    box.extend(corner);
  }
  return box;
}

/// A color for each solid, such that solids within `distance` of each other differ in color.
std::vector<int> color_neighbors(std::span<const Hexahedron> solids, double distance) {
  std::vector<Box3> boxes;
  for (const Hexahedron& solid : solids) {
    boxes.push_back(bounds(solid));
  }
  std::vector<int> colors(solids.size(), 0);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    std::vector<bool> taken(i + 1, false);
    for (std::size_t j = 0; j < i; ++j) {
      if (boxes[i].squaredExteriorDistance(boxes[j]) <= distance * distance) {
        taken[colors[j]] = true;
      }
    }
    colors[i] = static_cast<int>(std::find(taken.begin(), taken.end(), false) - taken.begin());
  }
  return colors;
}

/// The amounts by which to enlarge the solids, in (0, separation]: neighbors differ, and the
/// differences change from one attempt to the next.
std::vector<double> separations(std::span<const Hexahedron> solids, double separation,
                                int attempt) {
  const std::vector<int> colors = color_neighbors(solids, 2 * separation);
  const double count = 1 + *std::max_element(colors.begin(), colors.end());
  std::vector<double> amounts;
  for (const int color : colors) {
    amounts.push_back(separation * maths::pow((color + 1) / count, 1 / (1 + 0.3 * attempt)));
  }
  return amounts;
}

/// The solid with every corner moved out by `amount` along its three edges, except the corners of
/// shared faces.
Hexahedron enlarged(const Hexahedron& solid, double amount) {
  std::array<bool, 8> fixed{};
  for (int f = 0; f < 6; ++f) {
    for (const Index corner : hexahedron_faces[f]) {
      fixed[corner] = fixed[corner] || solid.shared[f];
    }
  }
  Hexahedron larger = solid;
  for (unsigned i = 0; i < 8; ++i) {
    for (const unsigned axis : {1U, 2U, 4U}) {
      if (!fixed[i]) {
        larger.corners[i] += amount * (solid.corners[i] - solid.corners[i ^ axis]).normalized();
      }
    }
  }
  larger.is_box =
      solid.is_box && std::none_of(fixed.begin(), fixed.end(), [](bool b) { return b; });
  return larger;
}

/// The solid right side out.
Hexahedron oriented(const Hexahedron& solid) {
  if (volume(solid) >= 0) {
    return solid;
  }
  Hexahedron mirrored = solid;
  for (unsigned i = 0; i < 8; ++i) {
    mirrored.corners[i] = solid.corners[i ^ 1U];
  }
  std::swap(mirrored.shared[0], mirrored.shared[1]);
  return mirrored;
}

/// A plane of the input, to tell exactly whether two are the same.
struct Plane {
  std::array<ExactPoint, 3> points;
  Vec3 normal; ///< unit, outward, rounded
  Vec3 point;  ///< on the plane, rounded
};

/// The planes of the input, each one once.
class Planes {
public:
  explicit Planes(double size) : size_(size) {}

  Index add(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c) {
    const Vec3 origin = rounded(a);
    const Vec3 normal = (rounded(b) - origin).cross(rounded(c) - origin).normalized();
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      const Plane& other = planes_[i];
      const bool near = normal.dot(other.normal) > 0.999 &&
                        std::abs(other.normal.dot(origin - other.point)) < 1e-6 * size_;
      if (near && contains(other, a) && contains(other, b) && contains(other, c)) {
        return static_cast<Index>(i);
      }
    }
    planes_.push_back({{a, b, c}, normal, origin});
    return static_cast<Index>(planes_.size() - 1);
  }

  [[nodiscard]] const Vec3& normal(Index plane) const { return planes_[plane].normal; }

  /// The first plane that this one is the same as but for rounding: the two halves of a quad whose
  /// corners were computed to lie in a plane.
  [[nodiscard]] Index nearly_same(Index plane) const {
    constexpr double rounding = 1e-11;
    const Plane& p = planes_[plane];
    for (Index i = 0; i < plane; ++i) {
      const Plane& other = planes_[i];
      if (p.normal.dot(other.normal) > 0 && p.normal.cross(other.normal).norm() < rounding &&
          std::abs(other.normal.dot(p.point - other.point)) < rounding * size_) {
        return i;
      }
    }
    return plane;
  }

private:
  static bool contains(const Plane& plane, const ExactPoint& p) {
    return CGAL::coplanar(plane.points[0], plane.points[1], plane.points[2], p);
  }

  double size_;
  std::vector<Plane> planes_;
};

ExactMesh exact_mesh(const Hexahedron& solid, Planes& planes) {
  ExactMesh mesh;
  for (const Vec3& corner : solid.corners) {
    mesh.points.push_back(exact(corner));
  }
  if (solid.is_box) {
    const ExactPoint origin = mesh.points[0];
    const std::array<Exact::Vector_3, 3> edges = {mesh.points[1] - origin, mesh.points[2] - origin,
                                                  mesh.points[4] - origin};
    for (unsigned i : {3U, 5U, 6U, 7U}) {
      mesh.points[i] = origin;
      for (unsigned axis = 0; axis < 3; ++axis) {
        if ((i >> axis) & 1U) {
          mesh.points[i] = mesh.points[i] + edges[axis];
        }
      }
      mesh.points[i].exact();
    }
  }
  for (const Triangle& t : triangulate(solid)) {
    mesh.triangles.push_back(t);
    mesh.planes.push_back(planes.add(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]));
  }
  return mesh;
}

// ---------------------------------------------------------------------------------------------
// Flat faces: as few vertices as there can be, triangulated well
// ---------------------------------------------------------------------------------------------

struct FaceMark {
  int depth = -1; ///< how many boundaries lie between the face and infinity
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Exact>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<
    Exact, CGAL::Triangulation_face_base_with_info_2<FaceMark, Exact>>;
using Flat = CGAL::Constrained_Delaunay_triangulation_2<
    Exact, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;

/// The connected triangles of one plane: its boundary as directed edges.
struct Region {
  Index plane = 0;
  std::vector<std::array<Index, 2>> boundary;
};

/// Marks every face of the triangulation by how many constraints lie between it and infinity.
void mark_depths(Flat& flat) {
  std::vector<Flat::Face_handle> level = {flat.infinite_face()};
  for (int depth = 0; !level.empty(); ++depth) {
    std::vector<Flat::Face_handle> next;
    while (!level.empty()) {
      const Flat::Face_handle face = level.back();
      level.pop_back();
      if (face->info().depth >= 0) {
        continue;
      }
      face->info().depth = depth;
      for (int i = 0; i < 3; ++i) {
        if (face->neighbor(i)->info().depth < 0) {
          (face->is_constrained(i) ? next : level).push_back(face->neighbor(i));
        }
      }
    }
    level = std::move(next);
  }
}

/// Triangulates the region in coordinates of its plane that keep lengths and angles up to rounding.
/// The coordinates are exact linear functions of the points: the topology is exact too.
void triangulate_region(const Region& region, const Vec3& normal,
                        const std::vector<ExactPoint>& points, ExactMesh& out) {
  const Vec3 u = normal.unitOrthogonal();
  const Vec3 v = normal.cross(u);
  const Exact::Vector_3 across(u.x(), u.y(), u.z());
  const Exact::Vector_3 along(v.x(), v.y(), v.z());
  std::vector<Index> corners;
  for (const auto& edge : region.boundary) {
    corners.push_back(edge[0]);
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  Flat flat;
  std::map<Index, Flat::Vertex_handle> handles;
  for (const Index corner : corners) {
    const Exact::Vector_3 p = points[corner] - CGAL::ORIGIN;
    const Flat::Vertex_handle handle = flat.insert(Exact::Point_2(p * across, p * along));
    handle->info() = corner;
    handles[corner] = handle;
  }
  for (const auto& [from, to] : region.boundary) {
    flat.insert_constraint(handles[from], handles[to]);
  }
  mark_depths(flat);
  std::vector<Triangle> triangles;
  for (const Flat::Face_handle face : flat.finite_face_handles()) {
    if (face->info().depth % 2 == 1) {
      Triangle t = {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      triangles.push_back(t);
    }
  }
  std::sort(triangles.begin(), triangles.end());
  for (const Triangle& t : triangles) {
    out.triangles.push_back(t);
    out.planes.push_back(region.plane);
  }
}

using Surface = CGAL::Surface_mesh<ExactPoint>;
using Vertex = Surface::Vertex_index;
using Halfedge = Surface::Halfedge_index;
using Face = Surface::Face_index;
using PlaneMap = Surface::Property_map<Face, Index>;

PlaneMap plane_map(Surface& mesh) {
  return mesh.add_property_map<Face, Index>("f:plane", 0).first;
}

/// A closed surface seen as flat regions that meet in straight edges.
class FlatRegions {
public:
  FlatRegions(const Surface& mesh, const PlaneMap& planes) : mesh_(mesh), planes_(planes) {}

  /// The same surface with vertices only where three or more regions meet, sorted by position, and
  /// each region triangulated anew: a normal form, whatever the triangulation was.
  ExactMesh simplified(const Planes& planes) {
    keep_corners();
    flood_regions();
    trace_boundaries();
    ExactMesh out;
    out.points = std::move(points_);
    std::sort(regions_.begin(), regions_.end(), [](const Region& a, const Region& b) {
      return std::tie(a.plane, a.boundary) < std::tie(b.plane, b.boundary);
    });
    for (const Region& region : regions_) {
      triangulate_region(region, planes.normal(region.plane), out.points, out);
    }
    return out;
  }

private:
  [[nodiscard]] bool is_border(Halfedge h) const {
    return planes_[mesh_.face(h)] != planes_[mesh_.face(mesh_.opposite(h))];
  }

  /// Keeps the vertices where three or more borders meet: a vertex on two lies within a straight
  /// edge, because two planes meet in a line.
  void keep_corners() {
    std::vector<Vertex> corners;
    for (const Vertex v : mesh_.vertices()) {
      int borders = 0;
      for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
        borders += is_border(h) ? 1 : 0;
      }
      if (borders >= 3) {
        corners.push_back(v);
      }
    }
    std::sort(corners.begin(), corners.end(), [&](Vertex a, Vertex b) {
      return CGAL::compare_xyz(mesh_.point(a), mesh_.point(b)) == CGAL::SMALLER;
    });
    index_.assign(mesh_.num_vertices(), dropped);
    for (const Vertex v : corners) {
      index_[v] = static_cast<Index>(points_.size());
      points_.push_back(mesh_.point(v));
      points_.back().exact(); // cuts off the history of the point, which would grow without bound
    }
  }

  void flood_regions() {
    region_.assign(mesh_.num_faces(), dropped);
    std::vector<Face> stack;
    for (const Face seed : mesh_.faces()) {
      if (region_[seed] != dropped) {
        continue;
      }
      region_[seed] = static_cast<Index>(regions_.size());
      regions_.push_back({planes_[seed], {}});
      stack.push_back(seed);
      while (!stack.empty()) {
        const Face face = stack.back();
        stack.pop_back();
        for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(face))) {
          const Face next = mesh_.face(mesh_.opposite(h));
          if (!is_border(h) && region_[next] == dropped) {
            region_[next] = region_[seed];
            stack.push_back(next);
          }
        }
      }
    }
  }

  /// Follows every border from corner to corner, on both sides.
  void trace_boundaries() {
    for (const Halfedge h : mesh_.halfedges()) {
      if (!is_border(h) || index_[mesh_.source(h)] == dropped) {
        continue;
      }
      Halfedge end = h;
      while (index_[mesh_.target(end)] == dropped) {
        end = mesh_.next(end);
        while (!is_border(end)) {
          end = mesh_.next(mesh_.opposite(end));
        }
      }
      regions_[region_[mesh_.face(h)]].boundary.push_back(
          {index_[mesh_.source(h)], index_[mesh_.target(end)]});
    }
    for (Region& region : regions_) {
      std::sort(region.boundary.begin(), region.boundary.end());
    }
  }

  static constexpr Index dropped = static_cast<Index>(-1);
  const Surface& mesh_;
  const PlaneMap& planes_;
  std::vector<ExactPoint> points_;
  std::vector<Index> index_;  // of each vertex in points_, or dropped
  std::vector<Index> region_; // of each face
  std::vector<Region> regions_;
};

// ---------------------------------------------------------------------------------------------
// The union of two, and of all
// ---------------------------------------------------------------------------------------------

/// Why a union could not be made; caught within this file.
struct Failure {
  std::string reason;
};

void fill(Surface& surface, const ExactMesh& mesh) {
  PlaneMap planes = plane_map(surface);
  for (const ExactPoint& p : mesh.points) {
    surface.add_vertex(p);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Face face = surface.add_face(Vertex(a), Vertex(b), Vertex(c));
    if (face == Surface::null_face()) {
      throw Failure{"their union is not a manifold"};
    }
    planes[face] = mesh.planes[t];
  }
}

/// Hands the planes of the triangles on to the parts they are cut into.
struct PlaneKeeper : PMP::Corefinement::Default_visitor<Surface> {
  void before_subface_creations(Face whole, Surface& mesh) { plane_ = plane_map(mesh)[whole]; }
  void after_subface_created(Face part, Surface& mesh) { plane_map(mesh)[part] = plane_; }
  void after_face_copy(Face from, const Surface& source, Face to, Surface& target) {
    plane_map(target)[to] = source.property_map<Face, Index>("f:plane").first[from];
  }

private:
  Index plane_ = 0;
};

ExactMesh union_of(const ExactMesh& a, const ExactMesh& b, const Planes& planes) {
  // In one array, because the library orders the two by their addresses.
  std::array<Surface, 3> surfaces;
  fill(surfaces[0], a);
  fill(surfaces[1], b);
  const PlaneMap out_planes = plane_map(surfaces[2]);
  const bool manifold = PMP::corefine_and_compute_union(surfaces[0], surfaces[1], surfaces[2],
                                                        PMP::parameters::visitor(PlaneKeeper()));
  if (!manifold) {
    throw Failure{"their union is not a manifold"};
  }
  surfaces[2].collect_garbage();
  return FlatRegions(surfaces[2], out_planes).simplified(planes);
}

/// Counts finished unions, from any thread.
class Counter {
public:
  Counter(std::size_t total, const Progress& progress)
      : total_(static_cast<double>(total)), progress_(progress) {}

  void step() {
    const std::lock_guard lock(mutex_);
    progress_(++done_ / total_, "unite");
  }
  void stop_if_cancelled() const {
    if (progress_.cancelled()) {
      throw Error::cancelled();
    }
  }

private:
  std::mutex mutex_;
  double done_ = 0;
  double total_;
  const Progress& progress_;
};

struct Leaf {
  ExactMesh mesh;
  Vec3 center;
};

/// Unites the leaves: splits them in two halves along the axis of the widest spread and unites
/// these first, so that every union is one of neighbors and of equals.
ExactMesh union_of_all(std::span<Leaf> leaves, const Planes& planes, Counter& counter) {
  counter.stop_if_cancelled();
  if (leaves.size() == 1) {
    return std::move(leaves[0].mesh);
  }
  Box3 centers;
  for (const Leaf& leaf : leaves) {
    centers.extend(leaf.center);
  }
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  std::stable_sort(leaves.begin(), leaves.end(), [axis](const Leaf& a, const Leaf& b) {
    return a.center[axis] < b.center[axis];
  });
  ExactMesh first;
  ExactMesh second;
  tbb::parallel_invoke(
      [&] { first = union_of_all(leaves.first(leaves.size() / 2), planes, counter); },
      [&] { second = union_of_all(leaves.subspan(leaves.size() / 2), planes, counter); });
  if (first.triangles.empty() || second.triangles.empty()) {
    return {}; // a union elsewhere failed or was cancelled, and tasks not yet begun were dropped
  }
  ExactMesh both = union_of(first, second, planes);
  counter.step();
  return both;
}

// ---------------------------------------------------------------------------------------------
// Outer shells, rounding and the check
// ---------------------------------------------------------------------------------------------

/// The connected component of each triangle, by shared vertices; numbered in order of appearance.
std::vector<Index> components(const ExactMesh& mesh, Index& count) {
  DisjointSets sets(mesh.points.size());
  for (const Triangle& t : mesh.triangles) {
    sets.join(t);
  }
  std::map<Index, Index> number;
  std::vector<Index> component;
  for (const Triangle& t : mesh.triangles) {
    component.push_back(
        number.try_emplace(sets.find(t[0]), static_cast<Index>(number.size())).first->second);
  }
  count = static_cast<Index>(number.size());
  return component;
}

/// The part of the mesh whose triangles are chosen, without stray points.
template <class Chosen> ExactMesh part_of(const ExactMesh& mesh, const Chosen& chosen) {
  ExactMesh part;
  std::map<Index, Index> index;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (chosen(i)) {
      for (const Index corner : mesh.triangles[i]) {
        index[corner] = 0;
      }
    }
  }
  for (auto& [from, to] : index) { // in order, so that the points stay sorted
    to = static_cast<Index>(part.points.size());
    part.points.push_back(mesh.points[from]);
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (chosen(i)) {
      const auto& [a, b, c] = mesh.triangles[i];
      part.triangles.push_back({index[a], index[b], index[c]});
      part.planes.push_back(mesh.planes[i]);
    }
  }
  return part;
}

/// Whether the closed mesh is oriented outward: so is a triangle at its least vertex whose normal
/// tells, found exactly by the sign of the volume.
bool is_outer_shell(const ExactMesh& shell) {
  Exact::FT six_volumes = 0;
  for (const auto& [a, b, c] : shell.triangles) {
    six_volumes +=
        CGAL::determinant(shell.points[a] - shell.points[0], shell.points[b] - shell.points[0],
                          shell.points[c] - shell.points[0]);
    six_volumes.exact();
  }
  return six_volumes > 0;
}

/// The mesh without its inner shells and what is inside them.
ExactMesh outer_shells(ExactMesh mesh) {
  Index count = 0;
  const std::vector<Index> component = components(mesh, count);
  if (count == 1) {
    return mesh;
  }
  std::vector<ExactMesh> shells;
  std::vector<bool> keep;
  for (Index c = 0; c < count; ++c) {
    shells.push_back(part_of(mesh, [&](std::size_t i) { return component[i] == c; }));
    keep.push_back(is_outer_shell(shells.back()));
  }
  const std::vector<bool> outward = keep;
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) {
    return mesh; // without a cavity no shell can lie within another
  }
  for (Index c = 0; c < count; ++c) {
    if (!outward[c]) {
      continue;
    }
    Surface surface;
    fill(surface, shells[c]);
    const CGAL::Side_of_triangle_mesh<Surface, Exact> side(surface);
    for (Index other = 0; other < count; ++other) {
      if (other != c && keep[other] && side(shells[other].points[0]) == CGAL::ON_BOUNDED_SIDE) {
        keep[other] = false;
      }
    }
  }
  return part_of(mesh, [&](std::size_t i) { return keep[component[i]]; });
}

/// The mesh with faces that are flat but for rounding made one region each. Otherwise a vertex
/// stays where an edge crosses from one half of such a quad to the other, in line with its
/// neighbors until it is rounded. This is the last step, as the surface is exact no longer.
ExactMesh without_rounding_kinks(const ExactMesh& mesh, const Planes& planes) {
  Surface surface;
  fill(surface, mesh);
  PlaneMap map = plane_map(surface);
  for (const Face face : surface.faces()) {
    map[face] = planes.nearly_same(map[face]);
  }
  return FlatRegions(surface, map).simplified(planes);
}

/// The mesh with its edges of no length (relative to `size`) collapsed. Where planes that differ
/// only by rounding meet a third, exact corners come out so near to each other that they round to
/// one. The caller checks that the result is still embedded.
TriangleMesh without_tiny_edges(const TriangleMesh& mesh, double size) {
  constexpr double tiny = 1e-10;
  DisjointSets sets(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = t[i];
      const Index b = t[(i + 1) % 3];
      if ((mesh.positions[a] - mesh.positions[b]).norm() <= tiny * size) {
        sets.join(a, b);
      }
    }
  }
  TriangleMesh kept;
  std::vector<Index> index(mesh.positions.size());
  for (Index v = 0; v < index.size(); ++v) {
    if (sets.find(v) == v) {
      index[v] = static_cast<Index>(kept.positions.size());
      kept.positions.push_back(mesh.positions[v]);
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle t = {index[sets.find(a)], index[sets.find(b)], index[sets.find(c)]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) {
      kept.triangles.push_back(t);
    }
  }
  return kept;
}

TriangleMesh unite_once(std::span<const Hexahedron> solids, double separation, int attempt,
                        const Progress& progress) {
  const std::vector<double> amounts = separations(solids, separation, attempt);
  Box3 box;
  for (const Hexahedron& solid : solids) {
    box.extend(bounds(solid));
  }
  Planes planes(box.diagonal().norm());
  std::vector<Leaf> leaves;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Hexahedron larger = enlarged(solids[i], amounts[i]);
    leaves.push_back({exact_mesh(larger, planes), bounds(larger).center()});
  }
  Counter counter(solids.size(), progress);
  const ExactMesh all =
      without_rounding_kinks(outer_shells(union_of_all(leaves, planes, counter)), planes);
  TriangleMesh result;
  for (const ExactPoint& p : all.points) {
    result.positions.push_back(rounded(p));
  }
  result.triangles = all.triangles;
  result = without_tiny_edges(result, box.diagonal().norm());
  if (!is_embedded(result)) {
    throw Failure{"their union does not survive the rounding to doubles"};
  }
  return result;
}

Status check_input(std::span<const Hexahedron> solids, const UniteOptions& options) {
  if (solids.empty()) {
    return Error{ErrorCode::invalid_option, "there is no solid to unite"};
  }
  if (!(options.separation >= 0) || !std::isfinite(options.separation) || options.attempts < 1) {
    return Error{ErrorCode::invalid_option,
                 "the separation must not be negative, and one attempt must be allowed"};
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const double size = volume(solids[i]);
    if (!std::isfinite(size) || size == 0) {
      return Error{ErrorCode::invalid_option, "solid " + std::to_string(i) + " has no volume"};
    }
  }
  return success();
}

} // namespace

bool can_unite() {
  return true;
}

Result<TriangleMesh> unite(std::span<const Hexahedron> solids, const UniteOptions& options,
                           const Progress& progress) {
  if (const Status status = check_input(solids, options); !status) {
    return status.error();
  }
  std::vector<Hexahedron> right_side_out;
  Box3 box;
  for (const Hexahedron& solid : solids) {
    right_side_out.push_back(oriented(solid));
    box.extend(bounds(solid));
  }
  const double separation =
      options.separation > 0 ? options.separation : 1e-3 * box.diagonal().norm();
  std::string reason;
  for (int attempt = 0; attempt < options.attempts; ++attempt) {
    if (attempt > 0 && attempt == options.attempts - 1) {
      for (Hexahedron& solid : right_side_out) {
        solid.shared = {}; // rather two solids that overlap than none
      }
    }
    try {
      return unite_once(right_side_out, separation, attempt, progress);
    } catch (const Failure& failure) {
      reason = failure.reason;
    } catch (const Error& error) {
      return error;
    } catch (const std::exception& error) { // the library's own checks
      reason = error.what();
    }
  }
  return Error{ErrorCode::no_valid_cage, "the boxes cannot be united: " + reason};
}

} // namespace cagewright
