#include "app/edit/cage_watch.h"

#include "core/parallel.h"
#include "exact/predicates.h"
#include "mesh/disjoint_sets.h"
#include "mesh/topology.h"
#include "validate/containment.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>

namespace cagewright::app {
namespace {

// A face is looked up piece by piece, each no larger than this fraction of the model's diagonal: a
// box round a large slanted face would hold a good part of the model.
constexpr double piece_size = 0.02;
constexpr int deepest_cut = 6;

class Cut {
public:
  Cut(const TriangleBvh& model, const Vec3 (&triangle)[3], double diagonal)
      : model_(model), triangle_(triangle), margin_(1e-12 * diagonal),
        size_(piece_size * diagonal) {}

  /// Whether the triangle touches the model.
  [[nodiscard]] bool touches(const Vec3& a, const Vec3& b, const Vec3& c, int depth) const {
    Box3 box(a);
    box.extend(b);
    box.extend(c);
    if (depth < deepest_cut && box.sizes().maxCoeff() > size_) {
      // Nothing in the box of the whole: nothing in those of its parts.
      bool empty = true;
      model_.visit_box(grown(box), [&](Index) { return empty = false; });
      if (empty) {
        return false;
      }
      const Vec3 ab = (a + b) / 2;
      const Vec3 bc = (b + c) / 2;
      const Vec3 ca = (c + a) / 2;
      return touches(a, ab, ca, depth + 1) || touches(ab, b, bc, depth + 1) ||
             touches(ca, bc, c, depth + 1) || touches(ab, bc, ca, depth + 1);
    }
    return !model_.visit_box(
        grown(box), [&](Index t) { return !triangles_intersect(model_.corners(t), triangle_); });
  }

private:
  [[nodiscard]] Box3 grown(const Box3& box) const {
    return {box.min().array() - margin_, box.max().array() + margin_};
  }

  const TriangleBvh& model_;
  const Vec3 (&triangle_)[3];
  double margin_;
  double size_;
};

} // namespace

// ---------------------------------------------------------------- the model

WatchedModel::WatchedModel(TriangleView model)
    : WatchedModel(WatchedPoints(model), std::make_shared<const TriangleBvh>(model)) {}

WatchedPoints::WatchedPoints(TriangleView model) {
  diagonal = cagewright::diagonal(model.positions);
  DisjointSets sets(model.positions.size());
  for (const Triangle& t : model.triangles) {
    sets.join(t);
  }
  for (Index v = 0; v < model.positions.size(); ++v) {
    is_finite = is_finite && model.positions[v].allFinite();
    if (sets.find(v) == v) {
      points.push_back(model.positions[v]);
    }
  }
}

// ---------------------------------------------------------------- the watch

CageWatch::CageWatch(PolygonMesh cage, std::shared_ptr<const WatchedModel> model,
                     const WatchOptions& options)
    : cage_(std::move(cage)), model_(std::move(model)), options_(options) {
  const TopologyReport topology = cagewright::topology(cage_);
  pieces_ = topology.components;
  piece_of_face_ = topology.component_of_face;
  used_vertices_ = topology.used_vertices;
  sound_topology_ = cage_.face_count() > 0 && topology.is_closed() && topology.is_manifold() &&
                    topology.is_oriented() && topology.repeated_corner_faces.empty() &&
                    topology.duplicate_faces.empty() && topology.unused_vertices.empty() &&
                    (pieces_ == 1 || options_.allow_pieces);
  faces_of_.resize(cage_.positions.size());
  std::vector<Index> all;
  for (Index f = 0; f < cage_.face_count(); ++f) {
    for (const Index v : cage_.face(f)) {
      if (faces_of_[v].empty() || faces_of_[v].back() != f) {
        faces_of_[v].push_back(f);
      }
    }
    all.push_back(f);
  }
  touches_.resize(cage_.face_count());
  degenerate_.resize(cage_.face_count());
  crossed_.resize(cage_.face_count());
  judge(all);
}

void CageWatch::move(std::span<const Index> vertices, std::span<const Vec3> positions) {
  std::vector<Index> faces;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Index v = vertices[i];
    if (cage_.positions[v] != positions[i]) {
      cage_.positions[v] = positions[i];
      faces.insert(faces.end(), faces_of_[v].begin(), faces_of_[v].end());
    }
  }
  if (faces.empty()) {
    return;
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  judge(faces);
}

void CageWatch::judge(const std::vector<Index>& faces) {
  parts_ = cut_into_parts(cage_);
  for (const Index f : faces) {
    std::vector<Index> crossed = std::move(crossed_[f]);
    crossed_[f].clear();
    for (const Index g : crossed) {
      std::erase(crossed_[g], f);
    }
  }
  std::vector<std::vector<Index>> found(faces.size());
  parallel_for(0, faces.size(), 1, [&](std::size_t i) {
    const Index f = faces[i];
    const std::size_t begin = parts_.first_of_face[f];
    const std::size_t end = parts_.first_of_face[f + 1];
    degenerate_[f] = begin == end ? 1 : 0; // a coordinate that is not finite
    for (std::size_t p = begin; p < end; ++p) {
      degenerate_[f] = degenerate_[f] != 0 || parts_.parts[p].is_degenerate ? 1 : 0;
    }
    touches_[f] = find_contact(f) ? 1 : 0;
    found[i] = find_crossings(f);
  });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (const Index g : found[i]) {
      crossed_[faces[i]].push_back(g);
      crossed_[g].push_back(faces[i]);
    }
  }
  for (const Index f : faces) {
    for (const Index g : std::vector<Index>(crossed_[f])) {
      std::sort(crossed_[g].begin(), crossed_[g].end());
      crossed_[g].erase(std::unique(crossed_[g].begin(), crossed_[g].end()), crossed_[g].end());
    }
    std::sort(crossed_[f].begin(), crossed_[f].end());
    crossed_[f].erase(std::unique(crossed_[f].begin(), crossed_[f].end()), crossed_[f].end());
  }
  judge_whole();
}

bool CageWatch::find_contact(Index face) const {
  if (!model_) {
    return false;
  }
  for (std::size_t p = parts_.first_of_face[face]; p < parts_.first_of_face[face + 1]; ++p) {
    const Vec3(&t)[3] = parts_.bvh.corners(static_cast<Index>(p));
    if (Cut(*model_->bvh, t, model_->diagonal).touches(t[0], t[1], t[2], 0)) {
      return true;
    }
  }
  return false;
}

std::vector<Index> CageWatch::find_crossings(Index face) const {
  std::vector<Index> crossed;
  for (std::size_t p = parts_.first_of_face[face]; p < parts_.first_of_face[face + 1]; ++p) {
    const CagePart& part = parts_.parts[p];
    if (part.is_degenerate) {
      continue;
    }
    const Vec3(&t)[3] = parts_.bvh.corners(static_cast<Index>(p));
    Box3 box(t[0]);
    box.extend(t[1]);
    box.extend(t[2]);
    parts_.bvh.visit_box(box, [&](Index k) {
      const CagePart& other = parts_.parts[k];
      const bool same_face = other.face == face;
      const bool apart = same_face && (k == p || (other.cuttings & part.cuttings) == 0);
      if (!apart && !other.is_degenerate &&
          std::find(crossed.begin(), crossed.end(), other.face) == crossed.end() &&
          parts_cross(parts_, part, other)) {
        crossed.push_back(other.face);
      }
      return true;
    });
  }
  return crossed;
}

/// What hangs on all faces together, as validate_cage() judges it.
void CageWatch::judge_whole() {
  outside_.clear();
  sound_whole_ = sound_topology_ && parts_.welded.positions.size() >= used_vertices_;
  if (!sound_topology_) {
    return;
  }
  std::vector<std::vector<Triangle>> first_cutting(pieces_);
  for (const CagePart& part : parts_.parts) {
    if ((part.cuttings & 1U) != 0) {
      first_cutting[piece_of_face_[part.face]].push_back(part.corners);
    }
  }
  for (std::size_t piece = 0; piece < pieces_; ++piece) {
    sound_whole_ = sound_whole_ && volume_sign({parts_.welded.positions, first_cutting[piece]}) > 0;
  }
  if (pieces_ > 1) {
    for (std::size_t piece = 0; piece < pieces_ && sound_whole_; ++piece) {
      std::vector<int> others(parts_.parts.size());
      for (std::size_t i = 0; i < others.size(); ++i) {
        others[i] = piece_of_face_[parts_.parts[i].face] != piece ? 1 : 0;
      }
      const auto first =
          std::find(piece_of_face_.begin(), piece_of_face_.end(), static_cast<Index>(piece));
      const Vec3& point =
          cage_.positions[cage_.face(static_cast<std::size_t>(first - piece_of_face_.begin()))[0]];
      sound_whole_ =
          Containment(parts_, Closure::even, std::move(others)).locate(point) != Location::inside;
    }
  }
  if (!model_) {
    return;
  }
  const Containment containment(parts_, Closure::oriented,
                                std::vector<int>(parts_.parts.size(), 1));
  std::vector<char> is_outside(model_->points.size());
  parallel_for(0, is_outside.size(), 16, [&](std::size_t i) {
    is_outside[i] = containment.locate(model_->points[i]) != Location::inside ? 1 : 0;
  });
  for (std::size_t i = 0; i < is_outside.size(); ++i) {
    if (is_outside[i] != 0) {
      outside_.push_back(model_->points[i]);
    }
  }
}

bool CageWatch::is_valid() const {
  const auto none = [](const std::vector<char>& marks) {
    return std::find(marks.begin(), marks.end(), 1) == marks.end();
  };
  return sound_whole_ && outside_.empty() && (!model_ || model_->is_finite) && none(touches_) &&
         none(degenerate_) &&
         std::all_of(crossed_.begin(), crossed_.end(), [](const auto& c) { return c.empty(); });
}

std::vector<Index> CageWatch::bad_faces() const {
  std::vector<Index> bad;
  for (Index f = 0; f < touches_.size(); ++f) {
    if (touches_[f] != 0 || degenerate_[f] != 0 || !crossed_[f].empty()) {
      bad.push_back(f);
    }
  }
  return bad;
}

double CageWatch::advance(std::span<const Index> vertices, std::span<const Vec3> targets) {
  if (!is_valid()) {
    move(vertices, targets);
    return 1;
  }
  std::vector<Vec3> start;
  double way = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    start.push_back(cage_.positions[vertices[i]]);
    way = std::max(way, (targets[i] - start[i]).norm());
  }
  std::vector<Vec3> at(start.size());
  const auto go_to = [&](double fraction) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = fraction == 1 ? targets[i] : Vec3(start[i] + fraction * (targets[i] - start[i]));
    }
    move(vertices, at);
    return is_valid();
  };
  const double unit = model_ && model_->diagonal > 0 ? model_->diagonal : diagonal(cage_.positions);
  const double step = 0.02 * unit;
  const int steps = std::isfinite(way) && way > step
                        ? static_cast<int>(std::min(16.0, std::ceil(way / step)))
                        : 1;
  double good = 0;
  double bad = 2;
  for (int i = 1; i <= steps && bad > 1; ++i) {
    const double fraction = static_cast<double>(i) / steps;
    (go_to(fraction) ? good : bad) = fraction;
  }
  if (bad > 1) {
    return 1;
  }
  for (int i = 0; i < 8; ++i) {
    const double middle = (good + bad) / 2;
    (go_to(middle) ? good : bad) = middle;
  }
  // Where it began is valid, but only if the very coordinates are put back.
  if (good > 0) {
    go_to(good);
  } else {
    move(vertices, start);
  }
  return good;
}

} // namespace cagewright::app
