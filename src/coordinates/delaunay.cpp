#include "coordinates/delaunay.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace cagewright {
namespace {

__extension__ using Wide = __int128;

// Coordinates stay below 2^22: the determinant of five points is below 2^123.
constexpr double grid = 4194304;
constexpr int longest_shift = 4;
constexpr Index box_corners = 8;

/// Steps of the grid in [-4, 4], as good as random.
std::int64_t shift(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ z >> 27U) * 0x94d049bb133111ebULL;
  return static_cast<std::int64_t>((z >> 33U) % (2 * longest_shift + 1)) - longest_shift;
}

constexpr std::array<std::array<unsigned, 3>, 4> other_corners = {
    {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}};

} // namespace

Delaunay::Delaunay() {
  const auto end = static_cast<std::int64_t>(grid);
  for (unsigned i = 0; i < box_corners; ++i) {
    places_.push_back(
        {(i & 1U) != 0 ? end : -end, (i & 2U) != 0 ? end : -end, (i & 4U) != 0 ? end : -end});
  }
  // Four corners cut off a cube leave a tetrahedron.
  for (Cell cell :
       {Cell{0, 3, 5, 6}, Cell{1, 0, 3, 5}, Cell{2, 0, 3, 6}, Cell{4, 0, 5, 6}, Cell{7, 3, 5, 6}}) {
    if (orientation(places_[cell[0]], places_[cell[1]], places_[cell[2]], places_[cell[3]]) < 0) {
      std::swap(cell[2], cell[3]);
    }
    cells_.push_back({cell, {-1, -1, -1, -1}});
  }
  for (std::int32_t c = 1; c < 5; ++c) { // each touches the first with the face opposite to its own
    cells_[static_cast<std::size_t>(c)].beside[0] = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const Cell& other = cells_[static_cast<std::size_t>(c)].corners;
      if (std::find(other.begin(), other.end(), cells_[0].corners[i]) == other.end()) {
        cells_[0].beside[i] = c;
      }
    }
  }
  seen_.assign(cells_.size(), 0);
}

int Delaunay::orientation(const Place& a, const Place& b, const Place& c, const Place& d) {
  const std::int64_t ax = a.x - d.x;
  const std::int64_t ay = a.y - d.y;
  const std::int64_t az = a.z - d.z;
  const std::int64_t bx = b.x - d.x;
  const std::int64_t by = b.y - d.y;
  const std::int64_t bz = b.z - d.z;
  const std::int64_t cx = c.x - d.x;
  const std::int64_t cy = c.y - d.y;
  const std::int64_t cz = c.z - d.z;
  const Wide sum = static_cast<Wide>(bx * cy - cx * by) * az +
                   static_cast<Wide>(cx * ay - ax * cy) * bz +
                   static_cast<Wide>(ax * by - bx * ay) * cz;
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

bool Delaunay::in_sphere(const Place& a, const Place& b, const Place& c, const Place& d,
                         const Place& e) {
  struct Row {
    std::int64_t x, y, z;
    [[nodiscard]] Wide lift() const { return static_cast<Wide>(x * x + y * y + z * z); }
  };
  const auto row = [&](const Place& p) { return Row{p.x - e.x, p.y - e.y, p.z - e.z}; };
  const Row ra = row(a);
  const Row rb = row(b);
  const Row rc = row(c);
  const Row rd = row(d);
  const auto minor = [](const Row& p, const Row& q) {
    return static_cast<Wide>(p.x * q.y - q.x * p.y);
  };
  const Wide ab = minor(ra, rb);
  const Wide bc = minor(rb, rc);
  const Wide cd = minor(rc, rd);
  const Wide da = minor(rd, ra);
  const Wide ac = minor(ra, rc);
  const Wide bd = minor(rb, rd);
  const Wide abc = ra.z * bc - rb.z * ac + rc.z * ab;
  const Wide bcd = rb.z * cd - rc.z * bd + rd.z * bc;
  const Wide cda = rc.z * da + rd.z * ac + ra.z * cd;
  const Wide dab = rd.z * ab + ra.z * bd + rb.z * da;
  return rd.lift() * abc - rc.lift() * dab + rb.lift() * cda - ra.lift() * bcd > 0;
}

bool Delaunay::insert(const Vec3& point) {
  assert(point.cwiseAbs().maxCoeff() <= 0.9);
  const auto name = static_cast<Index>(places_.size());
  places_.emplace_back();
  std::uint64_t state = name;
  constexpr int most_tries = 16;
  for (int i = 0; i < most_tries; ++i) {
    const auto on_grid = [&](double x) {
      return static_cast<std::int64_t>(std::nearbyint(x * grid)) + shift(state);
    };
    places_[name] = {on_grid(point.x()), on_grid(point.y()), on_grid(point.z())};
    if (try_insert(name)) {
      return true;
    }
  }
  return false;
}

/// Walks towards the point: in Delaunay tetrahedra that ends.
std::int32_t Delaunay::find(const Place& p) const {
  std::int32_t cell = last_;
  for (unsigned turn = 0;; ++turn) {
    const Tetrahedron& here = cells_[static_cast<std::size_t>(cell)];
    std::int32_t next = -1;
    for (unsigned k = 0; k < 4 && next < 0; ++k) {
      const unsigned i = (k + turn) % 4;
      std::array<const Place*, 4> corners;
      for (unsigned j = 0; j < 4; ++j) {
        corners[j] = j == i ? &p : &places_[here.corners[j]];
      }
      if (orientation(*corners[0], *corners[1], *corners[2], *corners[3]) < 0) {
        next = here.beside[i];
      }
    }
    if (next < 0) {
      return cell;
    }
    cell = next;
  }
}

bool Delaunay::is_in_conflict(std::int32_t cell, const Place& p) const {
  const Cell& corners = cells_[static_cast<std::size_t>(cell)].corners;
  return in_sphere(places_[corners[0]], places_[corners[1]], places_[corners[2]],
                   places_[corners[3]], p);
}

bool Delaunay::try_insert(Index name) {
  const Place& p = places_[name];
  const std::uint32_t outside = 2 * ++tries_;
  const std::int32_t first = find(p);
  hole_.assign(1, first);
  rim_.clear();
  seen_[static_cast<std::size_t>(first)] = outside + 1;
  for (std::size_t i = 0; i < hole_.size(); ++i) {
    const std::int32_t cell = hole_[i];
    const Tetrahedron here = cells_[static_cast<std::size_t>(cell)];
    for (unsigned face = 0; face < 4; ++face) {
      const std::int32_t beside = here.beside[face];
      if (beside >= 0 && seen_[static_cast<std::size_t>(beside)] < outside) {
        const bool is_in = is_in_conflict(beside, p);
        seen_[static_cast<std::size_t>(beside)] = outside + (is_in ? 1U : 0U);
        if (is_in) {
          hole_.push_back(beside);
        }
      }
      if (beside < 0 || seen_[static_cast<std::size_t>(beside)] == outside) {
        std::array<const Place*, 4> corners;
        for (unsigned j = 0; j < 4; ++j) {
          corners[j] = j == face ? &p : &places_[here.corners[j]];
        }
        if (orientation(*corners[0], *corners[1], *corners[2], *corners[3]) <= 0) {
          return false; // in the plane of a face
        }
        rim_.push_back({cell, face});
      }
    }
  }
  fill_hole(name);
  return true;
}

void Delaunay::fill_hole(Index name) {
  sides_.clear();
  std::vector<std::int32_t> made;
  for (const Rim& rim : rim_) {
    Tetrahedron fresh = cells_[static_cast<std::size_t>(rim.cell)];
    fresh.corners[rim.face] = name;
    const std::int32_t outer = fresh.beside[rim.face];
    fresh.beside = {-1, -1, -1, -1};
    fresh.beside[rim.face] = outer;
    std::int32_t index = 0;
    if (free_.empty()) {
      index = static_cast<std::int32_t>(cells_.size());
      cells_.push_back(fresh);
      seen_.push_back(0);
    } else {
      index = free_.back();
      free_.pop_back();
      cells_[static_cast<std::size_t>(index)] = fresh;
      seen_[static_cast<std::size_t>(index)] = 0;
    }
    made.push_back(index);
    if (outer >= 0) {
      std::array<std::int32_t, 4>& back = cells_[static_cast<std::size_t>(outer)].beside;
      *std::find(back.begin(), back.end(), rim.cell) = index;
    }
    for (const unsigned face : other_corners[rim.face]) {
      std::array<Index, 2> ends{};
      std::size_t count = 0;
      for (const unsigned corner : other_corners[rim.face]) {
        if (corner != face) {
          ends[count++] = fresh.corners[corner];
        }
      }
      sides_.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), index, face});
    }
  }
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.cell < b.cell;
  });
  for (std::size_t i = 0; i + 1 < sides_.size(); i += 2) { // each edge of the rim has two faces
    cells_[static_cast<std::size_t>(sides_[i].cell)].beside[sides_[i].face] = sides_[i + 1].cell;
    cells_[static_cast<std::size_t>(sides_[i + 1].cell)].beside[sides_[i + 1].face] =
        sides_[i].cell;
  }
  for (const std::int32_t cell : hole_) {
    cells_[static_cast<std::size_t>(cell)].corners.fill(0);
    free_.push_back(cell);
  }
  last_ = made.front();
}

std::vector<Delaunay::Cell> Delaunay::cells() const {
  std::vector<Cell> result;
  for (const Tetrahedron& cell : cells_) {
    if (std::all_of(cell.corners.begin(), cell.corners.end(),
                    [](Index v) { return v >= box_corners; })) {
      Cell corners = cell.corners;
      for (Index& v : corners) {
        v -= box_corners;
      }
      result.push_back(corners);
    }
  }
  return result;
}

} // namespace cagewright
