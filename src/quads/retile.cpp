#include "quads/retile.h"

#include "core/parallel.h"
#include "improve/objective.h"

#include <tbb/concurrent_unordered_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace cagewright {
namespace {

struct HashOfCorners {
  std::size_t operator()(const std::array<Index, 4>& corners) const {
    return hash_of_indices(corners);
  }
};

/// Triangles and quads over the corners 0, 1, ... of a polygon.
using Tiling = std::vector<CageFace>;

int triangles_in(std::span<const CageFace> faces) {
  return static_cast<int>(
      std::count_if(faces.begin(), faces.end(), [](const CageFace& f) { return !f.is_quad(); }));
}

Tiling joined(const Tiling& a, const Tiling& b) {
  Tiling all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

/// All tilings of the polygon with corners first, first + 1, ... last that have at most so many
/// triangles, by its side last first.
std::vector<Tiling> tilings(Index first, Index last, int triangles) {
  if (last == first + 1) {
    return {Tiling{}};
  }
  if (static_cast<int>(last - first + 1) % 2 > triangles) {
    return {};
  }
  std::vector<Tiling> all;
  for (Index i = first + 1; i < last; ++i) {
    const std::vector<Tiling> before = tilings(first, i, triangles);
    const std::vector<Tiling> after = tilings(i, last, triangles);
    for (const Tiling& a : before) {
      for (const Tiling& b : after) {
        all.push_back(joined(a, b));
        all.back().push_back(CageFace::triangle(first, i, last));
      }
    }
    for (Index j = i + 1; j < last; ++j) {
      const std::vector<Tiling> between = tilings(i, j, triangles);
      const std::vector<Tiling> end = tilings(j, last, triangles);
      for (const Tiling& a : before) {
        for (const Tiling& b : between) {
          for (const Tiling& c : end) {
            all.push_back(joined(joined(a, b), c));
            all.back().push_back(CageFace::quad(first, i, j, last));
          }
        }
      }
    }
  }
  return all;
}

constexpr int most_corners = 10;

/// The tilings of a polygon, over a list of all the faces that occur in them.
struct TilingTable {
  std::vector<CageFace> faces;
  struct Entry {
    std::vector<std::uint16_t> faces; ///< indices
    int triangles = 0;
  };
  std::vector<Entry> tilings; ///< those with the fewest triangles first

  explicit TilingTable(int corners) {
    // Those with the fewest triangles, 0 or 1; and up to six corners those with two more.
    const int most = corners % 2 + (corners <= 6 ? 2 : 0);
    std::map<std::vector<Index>, std::uint16_t> numbers;
    for (const Tiling& tiling : cagewright::tilings(0, static_cast<Index>(corners - 1), most)) {
      Entry entry;
      entry.triangles = triangles_in(tiling);
      for (const CageFace& face : tiling) {
        const auto [it, is_new] = numbers.try_emplace({face.span().begin(), face.span().end()},
                                                      static_cast<std::uint16_t>(faces.size()));
        if (is_new) {
          faces.push_back(face);
        }
        entry.faces.push_back(it->second);
      }
      if (entry.triangles <= most) {
        tilings.push_back(std::move(entry));
      }
    }
    std::stable_sort(tilings.begin(), tilings.end(),
                     [](const Entry& a, const Entry& b) { return a.triangles < b.triangles; });
  }
};

/// By the number of corners.
std::vector<TilingTable> useful_tilings() {
  std::vector<TilingTable> tables;
  for (int n = 4; n <= most_corners; ++n) {
    tables.emplace_back(n);
  }
  return tables;
}

struct Exchange {
  double gain = 0;
  std::vector<Index> removed;
  std::vector<CageFace> added;
};

class Retiling {
public:
  Retiling(QuadCage& cage, const QuadGuard& guard, const DirectionField& field, const Taste& taste)
      : cage_(cage), guard_(guard), field_(field), taste_(taste), tilings_(useful_tilings()),
        boxes_(face_boxes(cage, cage.positions())) {}

  std::size_t run(const Progress& progress) {
    std::vector<std::uint8_t> changed(cage_.vertex_end(), 1);
    std::size_t total = 0;
    constexpr int most_rounds = 40;
    for (int round = 0; round < most_rounds && !progress.cancelled(); ++round) {
      const std::vector<std::vector<Index>> regions = regions_at(changed);
      std::vector<std::optional<Exchange>> found(regions.size());
      parallel_for(0, regions.size(), 4,
                   [&](std::size_t i) { found[i] = best_exchange(regions[i]); });
      std::vector<Exchange> exchanges;
      for (std::optional<Exchange>& exchange : found) {
        if (exchange) {
          exchanges.push_back(std::move(*exchange));
        }
      }
      std::stable_sort(exchanges.begin(), exchanges.end(),
                       [](const Exchange& a, const Exchange& b) { return a.gain > b.gain; });
      std::fill(changed.begin(), changed.end(), 0);
      const std::size_t made = make(exchanges, changed);
      total += made;
      if (made == 0) {
        break;
      }
    }
    return total;
  }

private:
  // Two or three neighbouring faces with a corner that has changed, each set once.
  [[nodiscard]] std::vector<std::vector<Index>>
  regions_at(const std::vector<std::uint8_t>& changed) const {
    std::set<std::vector<Index>> regions;
    const auto neighbors = [&](Index f) {
      std::vector<Index> result;
      const CageFace& face = cage_.face(f);
      for (int i = 0; i < face.size; ++i) {
        const Index other = cage_.face_left_of(face[i + 1], face[i]);
        if (other != no_index && cage_.face(other).part == face.part) {
          result.push_back(other);
        }
      }
      return result;
    };
    const auto is_changed = [&](const std::vector<Index>& region) {
      for (const Index f : region) {
        for (const Index v : cage_.face(f).span()) {
          if (changed[v] != 0) {
            return true;
          }
        }
      }
      return false;
    };
    const auto add = [&](std::vector<Index> region) {
      std::sort(region.begin(), region.end());
      if (std::adjacent_find(region.begin(), region.end()) == region.end() && is_changed(region)) {
        regions.insert(std::move(region));
      }
    };
    for (Index f = 0; f < cage_.face_end(); ++f) {
      if (!cage_.has_face(f)) {
        continue;
      }
      const std::vector<Index> beside = neighbors(f);
      for (std::size_t i = 0; i < beside.size(); ++i) {
        add({f, beside[i]});
        for (std::size_t j = 0; j < i; ++j) {
          add({f, beside[i], beside[j]});
        }
      }
      if (!cage_.face(f).is_quad()) {
        std::vector<Index> strip{f};
        visit_strips(strip, neighbors, add);
      }
    }
    return {regions.begin(), regions.end()};
  }

  // Strips of a triangle, two or three quads, and a triangle.
  template <class Neighbors, class Add>
  void visit_strips(std::vector<Index>& strip, const Neighbors& neighbors, const Add& add) const {
    constexpr std::size_t most_faces = 4;
    for (const Index next : neighbors(strip.back())) {
      if (std::find(strip.begin(), strip.end(), next) != strip.end()) {
        continue;
      }
      strip.push_back(next);
      if (!cage_.face(next).is_quad()) {
        if (strip.size() > 3) {
          add(strip);
        }
      } else if (strip.size() < most_faces) {
        visit_strips(strip, neighbors, add);
      }
      strip.pop_back();
    }
  }

  // The corners round the faces, if these are a disc without a corner inside.
  [[nodiscard]] std::vector<Index> border_of(const std::vector<Index>& region) const {
    std::vector<std::array<Index, 2>> sides;
    std::set<Index> corners;
    for (const Index f : region) {
      const CageFace& face = cage_.face(f);
      for (int i = 0; i < face.size; ++i) {
        corners.insert(face[i]);
        const auto back = std::find(sides.begin(), sides.end(), std::array{face[i + 1], face[i]});
        if (back != sides.end()) {
          sides.erase(back);
        } else {
          sides.push_back({face[i], face[i + 1]});
        }
      }
    }
    std::vector<Index> ring{sides[0][0]};
    while (ring.size() <= sides.size()) {
      const auto next = std::find_if(sides.begin(), sides.end(),
                                     [&](const auto& side) { return side[0] == ring.back(); });
      if (next == sides.end() || (*next)[1] == ring[0]) {
        break;
      }
      ring.push_back((*next)[1]);
    }
    const bool is_disc = ring.size() == sides.size() && ring.size() == corners.size();
    return is_disc ? ring : std::vector<Index>();
  }

  [[nodiscard]] double valence_cost(Index v, int change) const {
    const int half = cage_.on_border(v) ? 2 : 1;
    const int valence = half * (static_cast<int>(cage_.around(v).size()) + change);
    constexpr int least = 3;
    return valence < least ? unfit : taste_.valence * (valence - 4) * (valence - 4);
  }

  // The volume between the face and a point: of a quad the mean over its two cuttings.
  [[nodiscard]] double volume_from(const Vec3& origin, const CageFace& face) const {
    const std::vector<Vec3>& x = cage_.positions();
    const FaceParts parts(face, FaceParts::Of::all);
    double sum = 0;
    for (const Triangle& t : parts) {
      sum += (x[t[0]] - origin).dot((x[t[1]] - origin).cross(x[t[2]] - origin)) / 6;
    }
    return parts.count == 4 ? sum / 2 : sum;
  }

  // What a face costs, which is asked again and again while no vertex moves. It is taken begun at
  // its least corner: then it does not matter who asks first.
  [[nodiscard]] double known_cost(const CageFace& face) const {
    int least = 0;
    for (int i = 1; i < face.size; ++i) {
      least = face[i] < face[least] ? i : least;
    }
    CageFace begun = face;
    for (int i = 0; i < face.size; ++i) {
      begun.corners[i] = face[least + i];
    }
    const std::array<Index, 4> key{begun[0], begun[1], begun[2],
                                   face.is_quad() ? begun[3] : no_index};
    if (const auto it = costs_.find(key); it != costs_.end()) {
      return it->second;
    }
    const double cost = cost_of(cage_.positions(), field_, taste_, begun);
    costs_.emplace(key, cost);
    return cost;
  }

  // What is known of a face that a region may be tiled with.
  struct Known {
    CageFace face; // on the ring
    double cost = 0;
    bool has_cost = false;
    enum class Fits { unknown, yes, no } fits = Fits::unknown;
  };

  [[nodiscard]] std::optional<Exchange> best_exchange(const std::vector<Index>& region) const {
    const std::vector<Index> ring = border_of(region);
    if (ring.size() < 4 || ring.size() > most_corners) {
      return std::nullopt;
    }
    int triangles = 0;
    double now = 0;
    for (const Index f : region) {
      now += cost_of(cage_.positions(), field_, taste_, cage_.face(f));
      triangles += cage_.face(f).is_quad() ? 0 : 1;
    }
    std::vector<int> faces_at(ring.size(), 0);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      for (const Index f : region) {
        faces_at[i] -= cage_.face(f).has(ring[i]) ? 1 : 0;
      }
      now += valence_cost(ring[i], 0);
    }
    // Of all tilings the one that encloses least is best: the others span limbs.
    double volume_now = 0;
    double area = 0;
    const Vec3& origin = cage_.positions()[ring[0]];
    for (const Index f : region) {
      volume_now += volume_from(origin, cage_.face(f));
      area += area_vector(cage_.positions(), cage_.face(f)).norm() / 2;
    }
    const double face_area = area / static_cast<double>(region.size());
    const double volume_cost = taste_.volume / std::max(face_area * std::sqrt(face_area), 1e-300);
    now += volume_cost * volume_now;
    const TilingTable& table = tilings_[ring.size() - 4];
    std::vector<Known> known(table.faces.size());
    for (std::size_t k = 0; k < known.size(); ++k) {
      known[k].face = table.faces[k].of_part(cage_.face(region.front()).part);
      for (int i = 0; i < known[k].face.size; ++i) {
        known[k].face.corners[i] = ring[table.faces[k].corners[i]];
      }
    }
    constexpr double least_gain = 1e-3;
    struct Better {
      double gain = 0;
      const TilingTable::Entry* tiling = nullptr;
    };
    std::vector<Better> better;
    std::vector<int> change;
    for (const TilingTable::Entry& tiling : table.tilings) {
      if (tiling.triangles > triangles) {
        break;
      }
      double then = 0;
      change = faces_at;
      for (std::size_t i = 0; i < tiling.faces.size(); ++i) {
        Known& face = known[tiling.faces[i]];
        if (!face.has_cost) {
          face.cost = known_cost(face.face) + volume_cost * volume_from(origin, face.face);
          face.has_cost = true;
        }
        then += face.cost;
        for (const Index corner : table.faces[tiling.faces[i]].span()) {
          ++change[corner];
        }
      }
      for (std::size_t i = 0; i < ring.size() && then < now; ++i) {
        then += valence_cost(ring[i], change[i]);
      }
      if (now - then > least_gain) {
        better.push_back({now - then, &tiling});
      }
    }
    std::stable_sort(better.begin(), better.end(),
                     [](const Better& a, const Better& b) { return a.gain > b.gain; });
    if (better.empty()) {
      return std::nullopt;
    }
    Place place(*this, region, ring);
    for (const auto& [gain, tiling] : better) {
      Exchange exchange;
      exchange.gain = gain;
      exchange.removed = region;
      bool all_fit = true;
      for (std::size_t i = 0; i < tiling->faces.size() && all_fit; ++i) {
        Known& face = known[tiling->faces[i]];
        if (face.fits == Known::Fits::unknown) {
          const bool fits = place.fits(table.faces[tiling->faces[i]], face.face);
          face.fits = fits ? Known::Fits::yes : Known::Fits::no;
        }
        all_fit = face.fits == Known::Fits::yes;
        exchange.added.push_back(face.face);
      }
      if (all_fit && fit_beside_each_other(exchange)) {
        return exchange;
      }
    }
    return std::nullopt;
  }

  // Whether faces may take the place of a region, each by itself. What is found out about a part of
  // one serves for all that have it.
  class Place {
  public:
    Place(const Retiling& all, const std::vector<Index>& region, const std::vector<Index>& ring)
        : all_(all), region_(region), ring_(ring), free_(ring.size() * ring.size() * ring.size()) {
      Box3 box;
      for (const Index v : ring) {
        box.extend(all.cage_.positions()[v]);
      }
      for (Index f = 0; f < all.boxes_.size(); ++f) {
        if (all.boxes_[f].intersects(box) && all.cage_.has_face(f) &&
            std::find(region.begin(), region.end(), f) == region.end()) {
          near_.push_back(f);
        }
      }
    }

    // \param local its corners as places on the ring
    bool fits(const CageFace& local, CageFace& face) {
      if (!all_.keeps_shape(region_, face) ||
          !QuadGuard::keeps_halves_apart(all_.cage_, {&face, 1}) ||
          !std::all_of(near_.begin(), near_.end(),
                       [&](Index f) { return fit_together(face, all_.cage_.face(f)); })) {
        return false;
      }
      const FaceParts parts(local);
      if (!face.is_quad()) {
        return is_free(parts.triangles[0]);
      }
      const bool first = is_free(parts.triangles[0]) && is_free(parts.triangles[1]);
      if (!first && !all_.may_be_tentative()) {
        return false;
      }
      const bool second = is_free(parts.triangles[2]) && is_free(parts.triangles[3]);
      const std::vector<Vec3>& x = all_.cage_.positions();
      face.tentative =
          !(first && second && shape_of(corners_of(x, face)).within(all_.guard_.limits()) &&
            !all_.guard_.encloses_a_part(x, face));
      if (face.tentative && !first) {
        face = face.turned(1);
      }
      return !face.tentative || (all_.may_be_tentative() && (first || second));
    }

  private:
    bool is_free(Triangle local) {
      // The same triangle begun at its least corner.
      std::rotate(local.begin(), std::min_element(local.begin(), local.end()), local.end());
      char& known = free_[(local[0] * ring_.size() + local[1]) * ring_.size() + local[2]];
      if (known == 0) {
        const Triangle part{ring_[local[0]], ring_[local[1]], ring_[local[2]]};
        known = all_.guard_.is_free(all_.cage_, near_, part) ? 1 : 2;
      }
      return known == 1;
    }

    const Retiling& all_;
    const std::vector<Index>& region_;
    const std::vector<Index>& ring_;
    std::vector<Index> near_; // faces that those of the region may cross
    std::vector<char> free_;  // of triangles on the ring: 1 yes, 2 no
  };

  [[nodiscard]] bool may_be_tentative() const { return taste_.wishes.beyond > 0; }

  // Whether new faces each of which fits in the place of the old ones fit together, too.
  [[nodiscard]] bool fit_beside_each_other(const Exchange& exchange) const {
    const std::span<const CageFace> added = exchange.added;
    for (std::size_t i = 1; i < added.size(); ++i) {
      if (QuadGuard::is_crossed_by(cage_.positions(), added[i], added.first(i))) {
        return false;
      }
    }
    return pays(exchange) && !guard_.loses_a_part(cage_, exchange.removed, exchange.added);
  }

  // Quads that have to be tentative cost more: it must pay all the same.
  [[nodiscard]] bool pays(const Exchange& exchange) const {
    const auto tentative = std::count_if(exchange.added.begin(), exchange.added.end(),
                                         [](const CageFace& face) { return face.tentative; });
    return exchange.gain > taste_.tentative * static_cast<double>(tentative);
  }

  [[nodiscard]] bool allows(Exchange& exchange) const {
    return guard_.allows(cage_, boxes_, exchange.removed, exchange.added,
                         taste_.wishes.beyond > 0) &&
           pays(exchange);
  }

  // No new triangle is a needle, no new face folds onto a neighbour.
  [[nodiscard]] bool keeps_shape(const std::vector<Index>& region, const CageFace& face) const {
    constexpr double worst_defect = 8;
    constexpr double sharpest = -0.8;
    const std::vector<Vec3>& x = cage_.positions();
    if (!face.is_quad()) {
      const Corners t{x[face[0]], x[face[1]], x[face[2]]};
      if (shape_defect(t) > worst_defect || shape_quality(t) < guard_.limits().min_quality) {
        return false;
      }
    }
    const Vec3 n = area_vector(x, face).normalized();
    for (int i = 0; i < face.size; ++i) {
      const Index other = cage_.face_left_of(face[i + 1], face[i]);
      const bool stays =
          other != no_index && std::find(region.begin(), region.end(), other) == region.end();
      if (stays && n.dot(area_vector(x, cage_.face(other)).normalized()) < sharpest) {
        return false;
      }
    }
    return true;
  }

  std::size_t make(std::vector<Exchange>& exchanges, std::vector<std::uint8_t>& changed) {
    std::size_t made = 0;
    for (Exchange& exchange : exchanges) {
      const bool is_stale =
          std::any_of(exchange.removed.begin(), exchange.removed.end(), [&](Index f) {
            const auto corners = cage_.face(f).span();
            return !cage_.has_face(f) || std::any_of(corners.begin(), corners.end(),
                                                     [&](Index v) { return changed[v] != 0; });
          });
      if (is_stale || !allows(exchange)) {
        continue;
      }
      for (const Index f : exchange.removed) {
        for (const Index v : cage_.face(f).span()) {
          changed[v] = 1;
        }
      }
      cage_.replace(exchange.removed, exchange.added);
      for (const CageFace& face : exchange.added) {
        boxes_.push_back(box_of(cage_.positions(), face));
      }
      ++made;
    }
    return made;
  }

  QuadCage& cage_;
  const QuadGuard& guard_;
  const DirectionField& field_;
  const Taste& taste_;
  std::vector<TilingTable> tilings_;
  std::vector<Box3> boxes_;
  mutable tbb::concurrent_unordered_map<std::array<Index, 4>, double, HashOfCorners> costs_;
};

} // namespace

std::size_t retile(QuadCage& cage, const QuadGuard& guard, const DirectionField& field,
                   const Taste& taste, const Progress& progress) {
  return Retiling(cage, guard, field, taste).run(progress);
}

} // namespace cagewright
