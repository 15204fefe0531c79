#include <cagewright/validate/webbing.h>

#include "core/parallel.h"
#include "exact/predicates.h"
#include "voxel/voxelize.h"
#include <cagewright/mesh/measures.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <queue>
#include <span>
#include <utility>

namespace cagewright {
namespace {

constexpr int voxels_along_diagonal = 96;
constexpr double nearest = 0.03;      // of the diagonal: what is nearer counts as touching
constexpr double farthest = 0.35;     // of the diagonal: what is farther is not beside each other
constexpr double detour = 2;          // times as far through the model: less than 60 degrees apart
constexpr double narrow_width = 0.2;  // of the diagonal: a gap at most so wide is a narrow one ...
constexpr double narrow_detour = 3;   // ... if the way round it is so many times as long
constexpr double few_narrow = 64;     // points: the share of fewer is chance
constexpr double least_detour = 0.25; // of the diagonal
constexpr int block = 4;              // voxels: how finely ways are told apart

using Cell = std::array<int, 3>;

/// One of each two opposite directions to the 26 neighbors of a voxel, the one that leads to a
/// greater index.
std::vector<Cell> lines() {
  std::vector<Cell> result;
  for (int z = 0; z <= 1; ++z) {
    for (int y = z > 0 ? -1 : 0; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (z > 0 || y > 0 || (y == 0 && x > 0)) {
          result.push_back({x, y, z});
        }
      }
    }
  }
  return result;
}

Result<VoxelGrid> voxels_of(TriangleView model, const Progress& progress) {
  const Box3 box = bounding_box(model.positions);
  OrientedBox frame;
  frame.center = box.center();
  frame.axes = Mat3::Identity();
  frame.half = box.sizes() / 2;
  const double along = 2 * frame.half.maxCoeff() / box.diagonal().norm() * voxels_along_diagonal;
  VoxelizeOptions options;
  options.resolution = std::max(2, static_cast<int>(std::lround(along)) + 1);
  return voxelize(model, frame, options, progress.quiet());
}

/// The occupied voxels in clumps: in each block of the grid those that hang together. Ways lead
/// from the middle of a clump to that of a neighbor.
class Ways {
public:
  explicit Ways(const VoxelGrid& grid) : grid_(grid), clump_(grid.kinds.size(), none) {
    find_clumps();
    find_neighbors();
  }

  [[nodiscard]] Index clump(std::size_t voxel) const { return clump_[voxel]; }
  [[nodiscard]] std::size_t count() const { return middles_.size(); }

  /// The lengths of the shortest ways from one clump to all, in voxels; beyond `reach` infinite.
  [[nodiscard]] std::vector<double> lengths_from(Index start, double reach) const {
    std::vector<double> length(count(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    length[start] = 0;
    queue.push({0, start});
    while (!queue.empty()) {
      const auto [so_far, c] = queue.top();
      queue.pop();
      if (so_far > length[c] || so_far > reach) {
        continue;
      }
      for (std::size_t i = first_[c]; i < first_[c + 1]; ++i) {
        const auto [other, step] = neighbors_[i];
        if (so_far + step < length[other]) {
          length[other] = so_far + step;
          queue.push({so_far + step, other});
        }
      }
    }
    return length;
  }

private:
  static constexpr Index none = ~Index{0};

  [[nodiscard]] bool same_block(const Cell& a, const Cell& b) const {
    return a[0] / block == b[0] / block && a[1] / block == b[1] / block &&
           a[2] / block == b[2] / block;
  }

  /// Calls visit(voxel, cell) for every occupied neighbor.
  template <class Visit> void visit_neighbors(std::size_t voxel, const Visit& visit) const {
    const Cell at = grid_.cell(voxel);
    for (int z = -1; z <= 1; ++z) {
      for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) { // outer voxels are all round
          const Cell cell{at[0] + x, at[1] + y, at[2] + z};
          const std::size_t other = grid_.index(cell);
          if (other != voxel && grid_.occupied(other)) {
            visit(other, cell);
          }
        }
      }
    }
  }

  void find_clumps() {
    std::vector<std::size_t> stack;
    for (std::size_t i = 0; i < clump_.size(); ++i) {
      if (!grid_.occupied(i) || clump_[i] != none) {
        continue;
      }
      const auto c = static_cast<Index>(middles_.size());
      Vec3 sum = Vec3::Zero();
      double members = 0;
      clump_[i] = c;
      stack.push_back(i);
      while (!stack.empty()) {
        const std::size_t v = stack.back();
        stack.pop_back();
        const Cell at = grid_.cell(v);
        sum += Vec3(at[0], at[1], at[2]);
        members += 1;
        visit_neighbors(v, [&](std::size_t other, const Cell& cell) {
          if (clump_[other] == none && same_block(at, cell)) {
            clump_[other] = c;
            stack.push_back(other);
          }
        });
      }
      middles_.emplace_back(sum / members);
    }
  }

  void find_neighbors() {
    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t i = 0; i < clump_.size(); ++i) {
      if (clump_[i] != none) {
        visit_neighbors(i, [&](std::size_t other, const Cell&) {
          if (clump_[other] != clump_[i]) {
            pairs.emplace_back(clump_[i], clump_[other]);
          }
        });
      }
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    first_.assign(count() + 1, 0);
    for (const auto& [a, b] : pairs) {
      ++first_[a + 1];
      neighbors_.emplace_back(b, (middles_[a] - middles_[b]).norm());
    }
    for (std::size_t c = 0; c < count(); ++c) {
      first_[c + 1] += first_[c];
    }
  }

  const VoxelGrid& grid_;
  std::vector<Index> clump_; // by voxel
  std::vector<Vec3> middles_;
  std::vector<std::size_t> first_;
  std::vector<std::pair<Index, double>> neighbors_; // and how far
};

enum class Gap : std::uint8_t { none, wide, narrow };

/// A free voxel between two clumps, so far apart in voxels.
struct Crossing {
  Index from = 0;
  Index to = 0;
  std::size_t voxel = 0;
  double across = 0;
};

/// Whether p, moved a little along y and much less along z, is to the left of a b in the plane of
/// y and z: never both of a b and of b a, and never neither.
bool is_left(const Vec3& a, const Vec3& b, const Vec3& p) {
  const int side = orient2d(a, b, p, 0);
  if (side != 0) {
    return side > 0;
  }
  return a.z() != b.z() ? b.z() < a.z() : b.y() > a.y();
}

} // namespace

class SpaceBetweenFinder {
public:
  SpaceBetweenFinder(const VoxelGrid& grid, const Progress& progress)
      : grid_(grid), progress_(progress.quiet()) {}

  void run(SpaceBetween& space) const {
    space.corner_ = grid_.origin;
    space.size_ = grid_.size;
    space.rows_ = {grid_.dims[1], grid_.dims[2]};
    const std::vector<Gap> gaps = gaps_at_voxels();
    space.first_.assign(1, 0);
    space.narrow_before_.assign(1, 0);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      if (gaps[i] != Gap::none) {
        space.places_.push_back(grid_.center(i).x());
        space.narrow_before_.push_back(space.narrow_before_.back() +
                                       (gaps[i] == Gap::narrow ? 1 : 0));
      }
      if ((i + 1) % static_cast<std::size_t>(grid_.dims[0]) == 0) {
        space.first_.push_back(space.places_.size());
      }
    }
    space.count_ = space.places_.size();
  }

private:
  /// The narrowest gap that each voxel is in.
  [[nodiscard]] std::vector<Gap> gaps_at_voxels() const {
    const Ways ways(grid_);
    std::vector<Crossing> crossings;
    for (const Cell& line : lines()) {
      if (progress_.cancelled()) {
        return {};
      }
      find_crossings(line, ways, crossings);
    }
    const auto key = [](const Crossing& c) { return std::pair(c.from, c.voxel); };
    std::sort(crossings.begin(), crossings.end(),
              [&](const Crossing& a, const Crossing& b) { return key(a) < key(b); });
    std::vector<std::size_t> starts; // of the crossings from one clump
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      if (i == 0 || crossings[i].from != crossings[i - 1].from) {
        starts.push_back(i);
      }
    }
    starts.push_back(crossings.size());
    std::vector<Gap> gap(crossings.size(), Gap::none);
    parallel_for(0, starts.size() - 1, 1, progress_, [&](std::size_t s) {
      double reach = 0;
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        reach = std::max(reach, longest_asked(crossings[i]));
      }
      const std::vector<double> lengths = ways.lengths_from(crossings[starts[s]].from, reach);
      for (std::size_t i = starts[s]; i < starts[s + 1]; ++i) {
        gap[i] = gap_of(crossings[i], lengths[crossings[i].to]);
      }
    });
    std::vector<Gap> at_voxels(grid_.kinds.size(), Gap::none);
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      Gap& here = at_voxels[crossings[i].voxel];
      here = std::max(here, gap[i]);
    }
    return at_voxels;
  }

  static bool may_be_narrow(const Crossing& crossing) {
    return crossing.across <= narrow_width * voxels_along_diagonal;
  }

  /// Ways that are longer need not be known.
  static double longest_asked(const Crossing& crossing) {
    return std::max((may_be_narrow(crossing) ? narrow_detour : detour) * crossing.across,
                    least_detour * voxels_along_diagonal);
  }

  static Gap gap_of(const Crossing& crossing, double way) {
    if (way < std::max(detour * crossing.across, least_detour * voxels_along_diagonal)) {
      return Gap::none;
    }
    return way >= longest_asked(crossing) && may_be_narrow(crossing) ? Gap::narrow : Gap::wide;
  }

  /// How many steps of the line lead from each voxel to the next one that is occupied: 0 if none
  /// does within so many.
  [[nodiscard]] std::vector<std::uint8_t> steps_along(const Cell& line, bool forward,
                                                      int most) const {
    std::vector<std::uint8_t> steps(grid_.kinds.size(), 0);
    const std::size_t count = steps.size();
    const auto [dx, dy, dz] = line;
    const int sign = forward ? 1 : -1;
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t i = forward ? count - 1 - n : n;
      const Cell at = grid_.cell(i);
      const Cell next{at[0] + sign * dx, at[1] + sign * dy, at[2] + sign * dz};
      if (next[0] < 0 || next[1] < 0 || next[2] < 0 || next[0] >= grid_.dims[0] ||
          next[1] >= grid_.dims[1] || next[2] >= grid_.dims[2]) {
        continue;
      }
      const std::size_t j = grid_.index(next);
      if (grid_.occupied(j)) {
        steps[i] = 1;
      } else if (steps[j] != 0 && steps[j] < most) {
        steps[i] = static_cast<std::uint8_t>(steps[j] + 1);
      }
    }
    return steps;
  }

  void find_crossings(const Cell& line, const Ways& ways, std::vector<Crossing>& crossings) const {
    const auto [dx, dy, dz] = line;
    const double step = std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz));
    const int most = static_cast<int>(farthest * voxels_along_diagonal / step);
    const std::vector<std::uint8_t> ahead = steps_along(line, true, most);
    const std::vector<std::uint8_t> back = steps_along(line, false, most);
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      const int a = ahead[i];
      const int b = back[i];
      const double across = (a + b) * step;
      if (grid_.occupied(i) || a == 0 || b == 0 || 3 * std::min(a, b) < a + b ||
          across < nearest * voxels_along_diagonal || across > farthest * voxels_along_diagonal) {
        continue;
      }
      const Cell at = grid_.cell(i);
      const Index to = ways.clump(grid_.index(at[0] + a * dx, at[1] + a * dy, at[2] + a * dz));
      const Index from = ways.clump(grid_.index(at[0] - b * dx, at[1] - b * dy, at[2] - b * dz));
      crossings.push_back({std::min(from, to), std::max(from, to), i, across});
    }
  }

  const VoxelGrid& grid_;
  Progress progress_;
};

SpaceBetween::SpaceBetween(TriangleView model, const Progress& progress) {
  const bool is_finite = std::all_of(model.positions.begin(), model.positions.end(),
                                     [](const Vec3& p) { return p.allFinite(); });
  if (model.triangles.empty() || !is_finite || !(diagonal(model.positions) > 0)) {
    return;
  }
  if (const Result<VoxelGrid> grid = voxels_of(model, progress)) {
    SpaceBetweenFinder(*grid, progress).run(*this);
  }
}

std::vector<Vec3> SpaceBetween::points() const {
  std::vector<Vec3> result;
  result.reserve(count_);
  for (int k = 0; count_ > 0 && k < rows_[1]; ++k) {
    for (int j = 0; j < rows_[0]; ++j) {
      for (std::size_t i = first_[row(j, k)]; i < first_[row(j, k) + 1]; ++i) {
        result.emplace_back(places_[i], corner_.y() + (j + 0.5) * size_,
                            corner_.z() + (k + 0.5) * size_);
      }
    }
  }
  return result;
}

SpaceBetween SpaceBetween::right_half() const {
  SpaceBetween half;
  if (count_ == 0) {
    return half;
  }
  half.corner_ = corner_;
  half.size_ = size_;
  half.rows_ = rows_;
  half.first_.assign(1, 0);
  half.narrow_before_.assign(1, 0);
  for (std::size_t r = 0; r + 1 < first_.size(); ++r) {
    for (std::size_t i = first_[r]; i < first_[r + 1]; ++i) {
      if (places_[i] > 0) {
        half.places_.push_back(places_[i]);
        half.narrow_before_.push_back(half.narrow_before_.back() + narrow_before_[i + 1] -
                                      narrow_before_[i]);
      }
    }
    half.first_.push_back(half.places_.size());
  }
  half.count_ = half.places_.size();
  return half;
}

SpaceBetween::Count SpaceBetween::behind_of(const std::array<Vec3, 3>& t) const {
  Count sum;
  if (count_ == 0) {
    return sum;
  }
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  if (normal.x() == 0 || !normal.allFinite()) {
    return sum;
  }
  std::array<int, 2> low{};
  std::array<int, 2> high{};
  for (int a = 0; a < 2; ++a) {
    const auto [least, most] = std::minmax({t[0][a + 1], t[1][a + 1], t[2][a + 1]});
    const auto place = [&](double x) { // of the first row at x or beyond
      return static_cast<int>(
          std::clamp(std::ceil((x - corner_[a + 1]) / size_ - 0.5), 0.0, double(rows_[a])));
    };
    low[a] = std::max(0, place(least) - 1); // rounding
    high[a] = std::min(rows_[a], place(most) + 1);
  }
  for (int k = low[1]; k < high[1]; ++k) {
    for (int j = low[0]; j < high[0]; ++j) {
      const std::size_t begin = first_[row(j, k)];
      const std::size_t end = first_[row(j, k) + 1];
      if (begin == end) {
        continue;
      }
      const Vec3 p(0, corner_.y() + (j + 0.5) * size_, corner_.z() + (k + 0.5) * size_);
      const bool left = is_left(t[0], t[1], p);
      if (is_left(t[1], t[2], p) != left || is_left(t[2], t[0], p) != left) {
        continue;
      }
      const double x =
          t[0].x() -
          (normal.y() * (p.y() - t[0].y()) + normal.z() * (p.z() - t[0].z())) / normal.x();
      const std::span<const double> row_places = std::span(places_).subspan(begin, end - begin);
      const auto before =
          std::lower_bound(row_places.begin(), row_places.end(), x) - row_places.begin();
      const long narrow_ones =
          narrow_before_[begin + static_cast<std::size_t>(before)] - narrow_before_[begin];
      sum.all += left ? before : -before;
      sum.narrow += left ? narrow_ones : -narrow_ones;
    }
  }
  return sum;
}

long SpaceBetween::behind(const std::array<Vec3, 3>& triangle) const {
  return behind_of(triangle).all;
}

double SpaceBetween::share_inside(TriangleView surface) const {
  if (count_ == 0) {
    return 0;
  }
  Count sum;
  for (const Triangle& t : surface.triangles) {
    const Count behind =
        behind_of({surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]});
    sum.all += behind.all;
    sum.narrow += behind.narrow;
  }
  const auto share = [](long inside, double count) {
    return std::clamp(static_cast<double>(inside) / count, 0.0, 1.0);
  };
  const double all = share(sum.all, static_cast<double>(count_));
  const auto narrow_ones = static_cast<double>(narrow_before_.back());
  return narrow_ones < few_narrow ? all : std::max(all, share(sum.narrow, narrow_ones));
}

} // namespace cagewright
