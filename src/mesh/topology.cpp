#include "mesh/topology.h"

#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <numeric>
#include <span>

namespace cagewright {
namespace {

/// A side of a face: the edge from `low`, in whose bucket it lies, to `high`.
struct Side {
  Index high;
  Index face;
  std::size_t corner; // where the side starts, among all corners
  bool forward;       // the face runs from low to high
};

/// Works on faces as runs of corners, whatever mesh they came from.
template <class FaceOf> class Analysis {
public:
  Analysis(std::size_t vertices, std::size_t faces, const FaceOf& face_of)
      : vertices_(vertices), faces_(faces), face_of_(face_of) {}

  TopologyReport run() {
    list_repeated_corners();
    list_duplicates();
    bucket_sides();
    find_components();
    list_edges();
    list_vertices();
    count_loops();
    if (report_.is_manifold()) {
      const long euler =
          static_cast<long>(report_.used_vertices + live_faces_) - static_cast<long>(report_.edges);
      const long capped = euler + static_cast<long>(report_.boundary_loops);
      report_.genus = static_cast<long>(report_.components) - capped / 2;
    }
    return std::move(report_);
  }

private:
  void list_repeated_corners() {
    is_live_.assign(faces_, true);
    first_corner_.assign(faces_ + 1, 0);
    std::vector<Index> seen_by(vertices_, 0); // one more than the face that named the vertex last
    for (std::size_t f = 0; f < faces_; ++f) {
      bool repeated = face_of_(f).size() < 3;
      for (const Index v : face_of_(f)) {
        repeated = repeated || seen_by[v] == f + 1;
        seen_by[v] = static_cast<Index>(f + 1);
      }
      is_live_[f] = !repeated;
      live_faces_ += repeated ? 0 : 1;
      first_corner_[f + 1] = first_corner_[f] + face_of_(f).size();
      if (repeated) {
        report_.repeated_corner_faces.push_back(static_cast<Index>(f));
      }
    }
  }

  /// Faces are compared within buckets of the same smallest corner.
  void list_duplicates() {
    std::vector<Index> smallest(faces_, 0);
    std::vector<std::size_t> begins(vertices_ + 1, 0);
    for (std::size_t f = 0; f < faces_; ++f) {
      if (is_live_[f]) {
        smallest[f] = *std::min_element(face_of_(f).begin(), face_of_(f).end());
        ++begins[smallest[f] + 1];
      }
    }
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    std::vector<Index> bucketed(live_faces_);
    std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
    for (std::size_t f = 0; f < faces_; ++f) {
      if (is_live_[f]) {
        bucketed[next[smallest[f]]++] = static_cast<Index>(f);
      }
    }
    std::vector<std::pair<std::vector<Index>, Index>> keys;
    for (std::size_t v = 0; v < vertices_; ++v) {
      if (begins[v + 1] - begins[v] < 2) {
        continue;
      }
      keys.clear();
      for (std::size_t k = begins[v]; k < begins[v + 1]; ++k) {
        const auto face = face_of_(bucketed[k]);
        keys.emplace_back(std::vector<Index>(face.begin(), face.end()), bucketed[k]);
        std::sort(keys.back().first.begin(), keys.back().first.end());
      }
      std::sort(keys.begin(), keys.end());
      for (std::size_t k = 1; k < keys.size(); ++k) {
        if (keys[k].first == keys[k - 1].first) {
          report_.duplicate_faces.push_back(keys[k].second);
        }
      }
    }
    std::sort(report_.duplicate_faces.begin(), report_.duplicate_faces.end());
  }

  void bucket_sides() {
    buckets_.assign(vertices_ + 1, 0);
    for_each_side([&](Index low, const Side&) { ++buckets_[low + 1]; });
    std::partial_sum(buckets_.begin(), buckets_.end(), buckets_.begin());
    sides_.resize(buckets_.back());
    std::vector<std::size_t> next(buckets_.begin(), buckets_.end() - 1);
    for_each_side([&](Index low, const Side& side) { sides_[next[low]++] = side; });
    for (std::size_t v = 0; v < vertices_; ++v) {
      std::sort(sides_.begin() + static_cast<std::ptrdiff_t>(buckets_[v]),
                sides_.begin() + static_cast<std::ptrdiff_t>(buckets_[v + 1]),
                [](const Side& a, const Side& b) {
                  return a.high != b.high ? a.high < b.high : a.corner < b.corner;
                });
    }
  }

  template <class Visit> void for_each_side(const Visit& visit) const {
    for (std::size_t f = 0; f < faces_; ++f) {
      if (!is_live_[f]) {
        continue;
      }
      const auto face = face_of_(f);
      for (std::size_t i = 0; i < face.size(); ++i) {
        const Index a = face[i];
        const Index b = face[i + 1 == face.size() ? 0 : i + 1];
        visit(std::min(a, b),
              Side{std::max(a, b), static_cast<Index>(f), first_corner_[f] + i, a < b});
      }
    }
  }

  /// Calls visit(low, high, sides) for each edge with all sides that lie on it.
  template <class Visit> void for_each_edge(const Visit& visit) const {
    for (std::size_t v = 0; v < vertices_; ++v) {
      for (std::size_t begin = buckets_[v]; begin < buckets_[v + 1];) {
        std::size_t end = begin + 1;
        while (end < buckets_[v + 1] && sides_[end].high == sides_[begin].high) {
          ++end;
        }
        visit(static_cast<Index>(v), sides_[begin].high,
              std::span(sides_).subspan(begin, end - begin));
        begin = end;
      }
    }
  }

  void list_edges() {
    for_each_edge([&](Index low, Index high, std::span<const Side> sides) {
      ++report_.edges;
      if (sides.size() == 1) {
        report_.boundary_edges.push_back(sides[0].forward ? EdgeVertices{low, high}
                                                          : EdgeVertices{high, low});
      } else if (sides.size() > 2) {
        report_.nonmanifold_edges.push_back({low, high});
      } else if (sides[0].forward == sides[1].forward) {
        report_.inconsistent_edges.push_back({low, high});
      }
    });
    std::sort(report_.boundary_edges.begin(), report_.boundary_edges.end());
  }

  void find_components() {
    DisjointSets sets(vertices_);
    for (std::size_t f = 0; f < faces_; ++f) {
      for (const Index v : face_of_(f)) {
        sets.join(face_of_(f)[0], v);
      }
    }
    constexpr Index unnamed = ~Index{0};
    std::vector<Index> label(vertices_, unnamed);
    report_.component_of_face.assign(faces_, 0);
    for (std::size_t f = 0; f < faces_; ++f) {
      if (face_of_(f).empty()) {
        continue;
      }
      Index& name = label[sets.find(face_of_(f)[0])];
      if (name == unnamed) {
        name = static_cast<Index>(report_.components++);
      }
      report_.component_of_face[f] = name;
    }
  }

  /// The corners at a vertex are joined across the edges that leave it: more than one set left is a
  /// vertex where fans of faces touch in a point.
  void list_vertices() {
    DisjointSets corners(first_corner_.back());
    const auto corner_at = [&](const Side& side, bool at_low) {
      const std::size_t size = face_of_(side.face).size();
      const std::size_t local = side.corner - first_corner_[side.face];
      const std::size_t other = first_corner_[side.face] + (local + 1 == size ? 0 : local + 1);
      return static_cast<Index>(side.forward == at_low ? side.corner : other);
    };
    for_each_edge([&](Index, Index, std::span<const Side> sides) {
      for (std::size_t k = 1; k < sides.size(); ++k) {
        corners.join(corner_at(sides[0], true), corner_at(sides[k], true));
        corners.join(corner_at(sides[0], false), corner_at(sides[k], false));
      }
    });
    std::vector<Index> fans(vertices_, 0);
    for (std::size_t f = 0; f < faces_; ++f) {
      if (is_live_[f]) {
        const auto face = face_of_(f);
        for (std::size_t i = 0; i < face.size(); ++i) {
          const auto corner = static_cast<Index>(first_corner_[f] + i);
          fans[face[i]] += corners.find(corner) == corner ? 1 : 0;
        }
      }
    }
    for (std::size_t v = 0; v < vertices_; ++v) {
      if (fans[v] == 0) {
        report_.unused_vertices.push_back(static_cast<Index>(v));
      } else if (fans[v] > 1) {
        report_.nonmanifold_vertices.push_back(static_cast<Index>(v));
      }
    }
    report_.used_vertices = vertices_ - report_.unused_vertices.size();
  }

  void count_loops() {
    DisjointSets sets(vertices_);
    std::vector<bool> on_boundary(vertices_, false);
    for (const auto& [a, b] : report_.boundary_edges) {
      sets.join(a, b);
      on_boundary[a] = true;
      on_boundary[b] = true;
    }
    for (std::size_t v = 0; v < vertices_; ++v) {
      report_.boundary_loops += on_boundary[v] && sets.find(static_cast<Index>(v)) == v ? 1 : 0;
    }
  }

  std::size_t vertices_;
  std::size_t faces_;
  const FaceOf& face_of_;
  TopologyReport report_;
  std::vector<bool> is_live_; // names no vertex twice
  std::size_t live_faces_ = 0;
  std::vector<std::size_t> first_corner_; // F + 1
  std::vector<std::size_t> buckets_;      // V + 1 offsets into sides_
  std::vector<Side> sides_;
};

} // namespace

TopologyReport topology(TriangleView mesh) {
  const auto face_of = [&](std::size_t f) { return std::span<const Index>(mesh.triangles[f]); };
  return Analysis(mesh.positions.size(), mesh.triangles.size(), face_of).run();
}

TopologyReport topology(const PolygonMesh& mesh) {
  const auto face_of = [&](std::size_t f) { return mesh.face(f); };
  return Analysis(mesh.positions.size(), mesh.face_count(), face_of).run();
}

} // namespace cagewright
