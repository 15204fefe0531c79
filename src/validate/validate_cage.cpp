#include <cagewright/validate/validate_cage.h>

#include "core/parallel.h"
#include "exact/predicates.h"
#include "mesh/disjoint_sets.h"
#include "mesh/topology.h"
#include "validate/cage_parts.h"
#include "validate/containment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace cagewright {
namespace {

/// How far off an edge, of its length, a vertex is still called to lie on it: rounding.
constexpr double t_junction_tolerance = 1e-9;

/// Violations of one stage: all counted, some listed.
struct Findings {
  std::size_t count = 0;
  std::vector<Violation> listed;

  void add(const Violation& violation, std::size_t max_listed) {
    ++count;
    if (listed.size() < max_listed) {
      listed.push_back(violation);
    }
  }
  void append(const Findings& other, std::size_t max_listed) {
    count += other.count;
    const std::size_t room = max_listed - std::min(max_listed, listed.size());
    const std::size_t taken = std::min(room, other.listed.size());
    listed.insert(listed.end(), other.listed.begin(),
                  other.listed.begin() + static_cast<std::ptrdiff_t>(taken));
  }
};

Vec3 contact_place(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  return triangle_triangle_closest(a, b).on_a;
}

bool is_finite(const Vec3 (&t)[3]) {
  return t[0].allFinite() && t[1].allFinite() && t[2].allFinite();
}

/// One run of the judge, stage by stage in the order of the kinds.
class Judge {
public:
  Judge(const PolygonMesh& cage, const ValidateOptions& options, const Progress& progress)
      : given_(cage), options_(options), progress_(progress) {}

  /// The cage by itself. \returns false when nothing more can be judged or need be.
  bool judge_surface() {
    progress_(0, "topology");
    keep_usable_faces();
    if (cage_.face_count() == 0) {
      add({ViolationKind::no_faces});
      return false;
    }
    parts_ = cut_into_parts(cage_);
    topology_ = topology(cage_);
    list_vertices();
    list_degenerate_faces();
    list_edges();
    list_t_junctions();
    if (is_decided()) {
      return false;
    }
    progress_(0.1, "self-intersections");
    find_self_intersections();
    if (is_decided()) {
      return false;
    }
    judge_pieces();
    return !is_decided();
  }

  void judge_model(TriangleView model) {
    progress_(0.3, "contacts");
    std::vector<char> touches(model.triangles.size(), 0);
    Findings contacts = find_contacts(model, touches);
    if (options_.first_only && contacts.count > 0) {
      take(ViolationKind::face_contact, contacts);
      return;
    }
    progress_(0.7, "containment");
    locate_vertices(model, touches);
    take(ViolationKind::face_contact, contacts);
  }

  [[nodiscard]] bool is_decided() const { return options_.first_only && !report_.valid(); }

  ValidityReport finish() {
    std::stable_sort(report_.violations.begin(), report_.violations.end(),
                     [](const Violation& a, const Violation& b) { return a.kind < b.kind; });
    progress_(1, "done");
    return std::move(report_);
  }

private:
  void add(const Violation& violation) {
    std::size_t& count = report_.counts[static_cast<std::size_t>(violation.kind)];
    if (count++ < options_.max_listed) {
      report_.violations.push_back(violation);
    }
  }
  void add_face(ViolationKind kind, Index face) {
    add({kind, {face_of_[face], Violation::none}, center_of(face)});
  }
  void take(ViolationKind kind, const Findings& findings) {
    report_.counts[static_cast<std::size_t>(kind)] += findings.count;
    report_.violations.insert(report_.violations.end(), findings.listed.begin(),
                              findings.listed.end());
  }

  [[nodiscard]] Vec3 center_of(Index face) const {
    Vec3 sum = Vec3::Zero();
    for (const Index v : cage_.face(face)) {
      sum += cage_.positions[v];
    }
    return sum / static_cast<double>(cage_.face(face).size());
  }

  /// All later stages speak of cage_, which has only these; face_of_ leads back to the given cage.
  void keep_usable_faces() {
    cage_.positions = given_.positions;
    const WeldedPoints merged = options_.weld ? weld_points(given_.positions) : WeldedPoints();
    std::vector<Index> corners;
    for (std::size_t f = 0; f < given_.face_count(); ++f) {
      const std::span<const Index> face = given_.face(f);
      const bool usable = face.size() >= 3 && std::all_of(face.begin(), face.end(), [&](Index v) {
                            return v < given_.positions.size();
                          });
      if (usable) {
        corners.assign(face.begin(), face.end());
        if (options_.weld) {
          for (Index& v : corners) {
            v = merged.first_with[merged.point_of[v]];
          }
        }
        cage_.add_face(corners);
        face_of_.push_back(static_cast<Index>(f));
      } else {
        add({ViolationKind::bad_corner, {static_cast<Index>(f), Violation::none}});
      }
    }
  }

  /// How many vertices the corners name.
  static std::vector<char> used_vertices(std::span<const Index> corners, std::size_t count) {
    std::vector<char> used(count, 0);
    for (const Index v : corners) {
      if (v < count) {
        used[v] = 1;
      }
    }
    return used;
  }

  /// What welding has merged and left out.
  void count_welded(const std::vector<char>& used) {
    const std::vector<char> before = used_vertices(given_.corners(), given_.positions.size());
    const auto count = [](const std::vector<char>& flags) {
      return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
    };
    report_.merged_vertices = count(before) - count(used);
    report_.loose_vertices = before.size() - count(before);
  }

  void list_vertices() {
    for (std::size_t v = 0; v < cage_.positions.size(); ++v) {
      if (!cage_.positions[v].allFinite()) {
        add({ViolationKind::not_finite,
             {static_cast<Index>(v), Violation::none},
             cage_.positions[v]});
      }
    }
    const std::vector<char> used = used_vertices(cage_.corners(), cage_.positions.size());
    if (options_.weld) {
      count_welded(used);
      return;
    }
    std::vector<Index> first_used(parts_.welded.positions.size(), Violation::none);
    for (Index v = 0; v < used.size(); ++v) {
      if (used[v] == 0) {
        add({ViolationKind::unused_vertex, {v, Violation::none}, cage_.positions[v]});
        continue;
      }
      Index& first = first_used[parts_.welded.point_of[v]];
      if (first == Violation::none) {
        first = v;
      } else {
        add({ViolationKind::coincident_vertices, {first, v}, cage_.positions[v]});
      }
    }
  }

  void list_degenerate_faces() {
    std::vector<char> degenerate(cage_.face_count(), 0);
    for (const Index f : topology_.repeated_corner_faces) {
      degenerate[f] = 1;
    }
    for (const CagePart& part : parts_.parts) {
      degenerate[part.face] |= part.is_degenerate ? 1 : 0;
    }
    for (Index f = 0; f < degenerate.size(); ++f) {
      if (degenerate[f] != 0) {
        add_face(ViolationKind::degenerate_face, f);
      }
    }
    for (const Index f : topology_.duplicate_faces) {
      add_face(ViolationKind::duplicate_face, f);
    }
  }

  void list_edges() {
    const auto list = [&](ViolationKind kind, const std::vector<EdgeVertices>& edges) {
      for (const EdgeVertices& edge : edges) {
        add({kind, edge, (cage_.positions[edge[0]] + cage_.positions[edge[1]]) / 2});
      }
    };
    list(ViolationKind::open_edge, topology_.boundary_edges);
    list(ViolationKind::nonmanifold_edge, topology_.nonmanifold_edges);
    list(ViolationKind::flipped_edge, topology_.inconsistent_edges);
    for (const Index v : topology_.nonmanifold_vertices) {
      add({ViolationKind::nonmanifold_vertex, {v, Violation::none}, cage_.positions[v]});
    }
  }

  /// Names the vertices that lie on open edges of others: where a face was cut and its neighbor was
  /// not. The edges are open all the same, so that this may be judged in doubles.
  void list_t_junctions() {
    if (topology_.boundary_edges.empty()) {
      return;
    }
    std::vector<Triangle> edges; // without area: for the hierarchy
    std::map<EdgeVertices, Index> face_of_edge;
    for (const EdgeVertices& edge : topology_.boundary_edges) {
      edges.push_back({edge[0], edge[1], edge[1]});
      face_of_edge.emplace(edge, Violation::none);
    }
    for (Index f = 0; f < cage_.face_count(); ++f) {
      const std::span<const Index> face = cage_.face(f);
      for (std::size_t k = 0; k < face.size(); ++k) {
        const auto found = face_of_edge.find({face[k], face[(k + 1) % face.size()]});
        if (found != face_of_edge.end()) {
          found->second = f;
        }
      }
    }
    const TriangleBvh bvh({cage_.positions, edges});
    std::vector<Index> ends;
    for (const EdgeVertices& edge : topology_.boundary_edges) {
      ends.insert(ends.end(), edge.begin(), edge.end());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (const Index v : ends) {
      const Vec3& p = cage_.positions[v];
      if (!p.allFinite()) {
        continue;
      }
      const Vec3 reach = Vec3::Constant(t_junction_tolerance * (1 + p.cwiseAbs().maxCoeff()));
      bvh.visit_box(Box3(p - reach, p + reach), [&](Index i) {
        const EdgeVertices& edge = topology_.boundary_edges[i];
        if (is_within_edge(p, cage_.positions[edge[0]], cage_.positions[edge[1]])) {
          add({ViolationKind::t_junction, {v, face_of_[face_of_edge.at(edge)]}, p});
          return false;
        }
        return true;
      });
    }
  }

  /// Strictly between the ends, and on the line but for rounding.
  static bool is_within_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double length = along.norm();
    const double at = (p - a).dot(along) / length;
    return at > t_junction_tolerance * length && at < (1 - t_junction_tolerance) * length &&
           (p - a - at / length * along).norm() <= t_junction_tolerance * length;
  }

  void find_self_intersections() {
    find_folded_faces(); // first: what a fold crosses besides is no news
    const Findings findings = parallel_reduce_ordered(
        0, cage_.face_count(), 64, Findings(),
        [&](std::size_t first, std::size_t last) {
          Findings found;
          for (std::size_t f = first; f < last && !progress_.cancelled(); ++f) {
            find_crossings_of(static_cast<Index>(f), found);
          }
          return found;
        },
        [&](Findings& all, const Findings& part) { all.append(part, options_.max_listed); });
    take(ViolationKind::self_intersection, findings);
  }

  void find_folded_faces() {
    folded_cuttings_.assign(cage_.face_count(), 0);
    for (Index f = 0; f < cage_.face_count() && !progress_.cancelled(); ++f) {
      std::uint8_t folded = 0;
      for (std::size_t i = parts_.first_of_face[f]; i < parts_.first_of_face[f + 1]; ++i) {
        for (std::size_t k = i + 1; k < parts_.first_of_face[f + 1]; ++k) {
          const CagePart& a = parts_.parts[i];
          const CagePart& b = parts_.parts[k];
          if (!a.is_degenerate && !b.is_degenerate && (a.cuttings & b.cuttings) != 0 &&
              parts_cross(parts_, a, b)) {
            folded = static_cast<std::uint8_t>(folded | (a.cuttings & b.cuttings));
          }
        }
      }
      folded_cuttings_[f] = folded;
      if (folded != 0) {
        add_face(ViolationKind::folded_face, f);
      }
    }
  }

  /// Whether the part is there only when its face is cut as it folds over.
  [[nodiscard]] bool is_of_fold(const CagePart& part) const {
    return (part.cuttings & ~folded_cuttings_[part.face]) == 0;
  }

  /// The faces beyond f that face f crosses, each once.
  void find_crossings_of(Index f, Findings& found) const {
    std::map<Index, Vec3> crossed;
    for (std::size_t i = parts_.first_of_face[f]; i < parts_.first_of_face[f + 1]; ++i) {
      const CagePart& part = parts_.parts[i];
      if (part.is_degenerate || is_of_fold(part)) {
        continue;
      }
      const auto& corners = parts_.bvh.corners(static_cast<Index>(i));
      Box3 box(corners[0]);
      box.extend(corners[1]);
      box.extend(corners[2]);
      parts_.bvh.visit_box(box, [&](Index k) {
        const CagePart& other = parts_.parts[k];
        if (other.face <= f || other.is_degenerate || is_of_fold(other) ||
            crossed.contains(other.face)) {
          return true;
        }
        if (parts_cross(parts_, part, other)) {
          crossed.emplace(other.face, contact_place(corners, parts_.bvh.corners(k)));
        }
        return true;
      });
    }
    for (const auto& [g, place] : crossed) {
      found.add({ViolationKind::self_intersection, {face_of_[f], face_of_[g]}, place},
                options_.max_listed);
    }
  }

  /// Closed pieces: how many, each outward, none within another.
  void judge_pieces() {
    std::vector<Triangle> first_cutting;
    for (const CagePart& part : parts_.parts) {
      if ((part.cuttings & 1U) != 0) {
        first_cutting.push_back(part.corners);
      }
    }
    closure_ = closure_of(first_cutting);
    weights_.assign(parts_.parts.size(), 1);
    const std::vector<Index> first_faces = first_faces_of_pieces();
    const bool has_sides = closure_ == Closure::oriented; // else outward means nothing
    std::vector<char> nested(first_faces.size(), 0);
    bool has_piece = false;
    for (std::size_t piece = 0; piece < first_faces.size(); ++piece) {
      const Index face = first_faces[piece];
      if (face == Violation::none) {
        continue;
      }
      nested[piece] = has_sides && is_nested(piece, face) ? 1 : 0;
      if (nested[piece] != 0) {
        continue; // told or accepted as such, below
      }
      if (has_piece && !options_.allow_pieces) {
        add_face(ViolationKind::several_pieces, face);
      }
      has_piece = true;
    }
    if (!has_sides) {
      return;
    }
    std::vector<std::vector<Triangle>> triangles(first_faces.size());
    for (const CagePart& part : parts_.parts) {
      if ((part.cuttings & 1U) != 0) {
        triangles[topology_.component_of_face[part.face]].push_back(part.corners);
      }
    }
    for (std::size_t piece = 0; piece < first_faces.size(); ++piece) {
      if (first_faces[piece] == Violation::none) {
        continue;
      }
      const int sign = volume_sign({parts_.welded.positions, triangles[piece]});
      if (nested[piece] != 0 && options_.allow_inner_shells) {
        inner_.push_back(static_cast<Index>(piece));
        if (sign > 0) {
          add_face(ViolationKind::inverted_piece, first_faces[piece]);
        }
      } else if (nested[piece] != 0) {
        add_face(ViolationKind::nested_piece, first_faces[piece]);
      } else if (sign < 0) {
        add_face(ViolationKind::inverted_piece, first_faces[piece]);
        inverted_.push_back(static_cast<Index>(piece));
      }
    }
    // The model is judged as if an inverted piece had been turned: one defect, one report.
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const Index piece = topology_.component_of_face[parts_.parts[i].face];
      const auto is_among = [&](const std::vector<Index>& pieces) {
        return std::find(pieces.begin(), pieces.end(), piece) != pieces.end();
      };
      weights_[i] = is_among(inner_) ? 0 : is_among(inverted_) ? -1 : 1;
    }
  }

  /// By piece; `none` for one of nothing but faces that name a vertex twice.
  [[nodiscard]] std::vector<Index> first_faces_of_pieces() const {
    std::vector<char> dropped(cage_.face_count(), 0);
    for (const Index f : topology_.repeated_corner_faces) {
      dropped[f] = 1;
    }
    std::vector<Index> first(topology_.components, Violation::none);
    for (Index f = 0; f < cage_.face_count(); ++f) {
      Index& slot = first[topology_.component_of_face[f]];
      slot = slot == Violation::none && dropped[f] == 0 ? f : slot;
    }
    return first;
  }

  /// Pieces that cross have no nesting. Otherwise the rest of the cage is even round all of a
  /// piece: one of its points tells.
  [[nodiscard]] bool is_nested(std::size_t piece, Index face) const {
    if (topology_.components < 2 || report_.count(ViolationKind::self_intersection) > 0) {
      return false;
    }
    std::vector<int> weights(parts_.parts.size());
    for (std::size_t i = 0; i < weights.size(); ++i) {
      weights[i] = topology_.component_of_face[parts_.parts[i].face] != piece ? 1 : 0;
    }
    const Vec3& point = cage_.positions[cage_.face(face)[0]];
    return Containment(parts_, Closure::even, std::move(weights)).locate(point) == Location::inside;
  }

  Findings find_contacts(TriangleView model, std::vector<char>& touches) const {
    return parallel_reduce_ordered(
        0, model.triangles.size(), 1024, Findings(),
        [&](std::size_t first, std::size_t last) {
          Findings found;
          std::vector<std::pair<Index, Index>> touched; // cage face, its part
          for (std::size_t t = first; t < last && !progress_.cancelled(); ++t) {
            touches[t] = find_contacts_of(model, static_cast<Index>(t), touched, found) ? 1 : 0;
          }
          return found;
        },
        [&](Findings& all, const Findings& part) { all.append(part, options_.max_listed); });
  }

  bool find_contacts_of(TriangleView model, Index t, std::vector<std::pair<Index, Index>>& touched,
                        Findings& found) const {
    const Triangle& corners = model.triangles[t];
    const Vec3 triangle[3] = {model.positions[corners[0]], model.positions[corners[1]],
                              model.positions[corners[2]]};
    if (!is_finite(triangle)) {
      return true;
    }
    Box3 box(triangle[0]);
    box.extend(triangle[1]);
    box.extend(triangle[2]);
    touched.clear();
    parts_.bvh.visit_box(box, [&](Index i) {
      if (triangles_intersect(triangle, parts_.bvh.corners(i))) {
        touched.emplace_back(parts_.parts[i].face, i);
      }
      return true;
    });
    std::sort(touched.begin(), touched.end());
    for (std::size_t k = 0; k < touched.size(); ++k) {
      if (k == 0 || touched[k].first != touched[k - 1].first) {
        found.add({ViolationKind::face_contact,
                   {t, face_of_[touched[k].first]},
                   contact_place(triangle, parts_.bvh.corners(touched[k].second))},
                  options_.max_listed);
      }
    }
    return !touched.empty();
  }

  /// Vertices joined by faces that do not touch the cage lie on one side of it: one of each such
  /// group is located.
  void locate_vertices(TriangleView model, const std::vector<char>& touches) {
    const std::vector<Index> group = groups(model, touches);
    const std::vector<char> judged = judged_vertices(model);
    report_.loose_model_vertices =
        static_cast<std::size_t>(std::count(judged.begin(), judged.end(), 0));
    std::vector<Index> leaders;
    for (Index v = 0; v < group.size(); ++v) {
      if (group[v] == v && judged[v] != 0) {
        leaders.push_back(v);
      }
    }
    const Containment containment(parts_, closure_, weights_);
    std::vector<Location> location(group.size(), Location::inside);
    std::vector<Index> face(group.size(), Violation::none);
    parallel_for(0, leaders.size(), 16, [&](std::size_t i) {
      const Index v = leaders[i];
      if (!progress_.cancelled()) {
        location[v] = containment.locate(model.positions[v], &face[v]);
      }
    });
    for (Index v = 0; v < group.size(); ++v) {
      const Index leader = group[v];
      if (location[leader] == Location::outside) {
        add({ViolationKind::vertex_outside, {v, Violation::none}, model.positions[v]});
      } else if (location[leader] == Location::on_surface) {
        add({ViolationKind::vertex_on_cage, {v, face_of_[face[leader]]}, model.positions[v]});
      }
    }
    report_.containment_approximate = closure_ == Closure::open;
  }

  /// Those of triangles; of a cloud of points, all.
  static std::vector<char> judged_vertices(TriangleView model) {
    if (model.triangles.empty()) {
      return std::vector<char>(model.positions.size(), 1);
    }
    std::vector<char> judged(model.positions.size(), 0);
    for (const Triangle& t : model.triangles) {
      judged[t[0]] = judged[t[1]] = judged[t[2]] = 1;
    }
    return judged;
  }

  /// For each model vertex, the first of its group.
  static std::vector<Index> groups(TriangleView model, const std::vector<char>& touches) {
    DisjointSets sets(model.positions.size());
    for (std::size_t t = 0; t < model.triangles.size(); ++t) {
      if (touches[t] != 0) {
        continue;
      }
      sets.join(model.triangles[t]);
    }
    std::vector<Index> firsts(model.positions.size());
    for (Index v = 0; v < firsts.size(); ++v) {
      firsts[v] = sets.find(v);
    }
    return firsts;
  }

  const PolygonMesh& given_;
  ValidateOptions options_;
  const Progress& progress_;
  ValidityReport report_;

  PolygonMesh cage_;           // the usable faces
  std::vector<Index> face_of_; // their indices in the given cage
  CageParts parts_;
  std::vector<std::uint8_t> folded_cuttings_; // of each face: see CagePart::cuttings
  TopologyReport topology_;
  Closure closure_ = Closure::open;
  std::vector<int> weights_;    // of the parts' crossings
  std::vector<Index> inverted_; // pieces
  std::vector<Index> inner_;    // pieces within others, where they are allowed
};

} // namespace

std::string_view name_of(ViolationKind kind) {
  switch (kind) {
  case ViolationKind::no_faces:
    return "no_faces";
  case ViolationKind::bad_corner:
    return "bad_corner";
  case ViolationKind::not_finite:
    return "not_finite";
  case ViolationKind::unused_vertex:
    return "unused_vertex";
  case ViolationKind::coincident_vertices:
    return "coincident_vertices";
  case ViolationKind::degenerate_face:
    return "degenerate_face";
  case ViolationKind::folded_face:
    return "folded_face";
  case ViolationKind::duplicate_face:
    return "duplicate_face";
  case ViolationKind::open_edge:
    return "open_edge";
  case ViolationKind::t_junction:
    return "t_junction";
  case ViolationKind::nonmanifold_edge:
    return "nonmanifold_edge";
  case ViolationKind::flipped_edge:
    return "flipped_edge";
  case ViolationKind::nonmanifold_vertex:
    return "nonmanifold_vertex";
  case ViolationKind::self_intersection:
    return "self_intersection";
  case ViolationKind::inverted_piece:
    return "inverted_piece";
  case ViolationKind::several_pieces:
    return "several_pieces";
  case ViolationKind::nested_piece:
    return "nested_piece";
  case ViolationKind::vertex_outside:
    return "vertex_outside";
  case ViolationKind::vertex_on_cage:
    return "vertex_on_cage";
  case ViolationKind::face_contact:
    return "face_contact";
  }
  return "unknown"; // no default above: the compiler points here when a kind is added
}

bool ValidityReport::valid() const {
  return std::all_of(counts.begin(), counts.end(), [](std::size_t count) { return count == 0; });
}

Result<ValidityReport> validate_cage(const PolygonMesh& cage, TriangleView model,
                                     const ValidateOptions& options, const Progress& progress) {
  Judge judge(cage, options, progress);
  if (judge.judge_surface() && !progress.cancelled()) {
    judge.judge_model(model);
  }
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  return judge.finish();
}

Result<ValidityReport> validate_cage(TriangleView cage, TriangleView model,
                                     const ValidateOptions& options, const Progress& progress) {
  PolygonMesh polygons;
  polygons.positions.assign(cage.positions.begin(), cage.positions.end());
  for (const Triangle& t : cage.triangles) {
    polygons.add_face(t);
  }
  return validate_cage(polygons, model, options, progress);
}

bool is_embedded(TriangleView mesh) {
  ValidateOptions options;
  options.allow_pieces = true;
  options.first_only = true;
  const auto report = validate_cage(mesh, {}, options);
  return report && report->valid();
}

} // namespace cagewright
