#include "envelope/handles.h"

#include "envelope/closing.h"
#include "envelope/well_composed.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// The 27 voxels round one, by number x + 3 y + 9 z; the one itself is number 13.
using Cube = std::array<bool, 27>;
constexpr int middle = 13;

bool touch(int a, int b, bool by_faces) {
  int apart = 0;
  for (const int k : {1, 3, 9}) {
    const int d = a / k % 3 - b / k % 3;
    if (d < -1 || d > 1) {
      return false;
    }
    apart += d != 0 ? 1 : 0;
  }
  return by_faces ? apart == 1 : apart > 0;
}

// Whether those that are `value`, without the middle and, of ways from face to face, without the
// corners, hang together; of ways from face to face only those count that reach the middle's faces.
bool is_one_part(const Cube& cube, bool value, bool by_faces) {
  std::array<bool, 27> belongs{};
  int first = -1;
  for (int i = 0; i < 27; ++i) {
    const bool is_corner = i / 1 % 3 != 1 && i / 3 % 3 != 1 && i / 9 % 3 != 1;
    belongs[i] = i != middle && cube[i] == value && !(by_faces && is_corner);
    if (belongs[i] && first < 0 && (!by_faces || touch(i, middle, true))) {
      first = i;
    }
  }
  if (first < 0) {
    return false;
  }
  std::array<int, 27> stack{};
  int count = 0;
  stack[count++] = first;
  belongs[first] = false;
  while (count > 0) {
    const int at = stack[--count];
    for (int i = 0; i < 27; ++i) {
      if (belongs[i] && touch(at, i, by_faces)) {
        belongs[i] = false;
        stack[count++] = i;
      }
    }
  }
  for (int i = 0; i < 27; ++i) {
    if (belongs[i] && (!by_faces || touch(i, middle, true))) {
      return false;
    }
  }
  return true;
}

// Takes away what was filled, the topology kept.
class Carving {
public:
  Carving(VoxelGrid& grid, const VoxelGrid& needed, bool mirrored)
      : grid_(grid), needed_(needed), mirrored_(mirrored), away_(distances()) {}

  void run() {
    for (std::size_t i = 0; i < grid_.kinds.size(); ++i) {
      offer(i);
    }
    while (!queue_.empty()) {
      const std::size_t i = queue_.top().second;
      queue_.pop();
      if (may_go(i) && take(i)) {
        offer_round(i);
        offer_round(image(i));
      }
    }
  }

private:
  [[nodiscard]] bool may_go(std::size_t i) const {
    return grid_.occupied(i) && !needed_.occupied(i);
  }

  // Steps from face to face to what is needed.
  [[nodiscard]] std::vector<int> distances() const {
    std::vector<int> away(grid_.kinds.size(), -1);
    std::vector<std::size_t> reached;
    for (std::size_t i = 0; i < away.size(); ++i) {
      if (needed_.occupied(i)) {
        away[i] = 0;
        reached.push_back(i);
      }
    }
    for (std::size_t n = 0; n < reached.size(); ++n) {
      const std::size_t at = reached[n];
      for (int k = 0; k < 3; ++k) {
        for (const std::size_t other : {at - grid_.stride(k), at + grid_.stride(k)}) {
          if (grid_.occupied(at) && grid_.occupied(other) && away[other] < 0) {
            away[other] = away[at] + 1;
            reached.push_back(other);
          }
        }
      }
    }
    return away;
  }

  void offer(std::size_t i) {
    if (may_go(i)) {
      queue_.emplace(away_[i], i);
    }
  }

  void offer_round(std::size_t i) {
    const auto [x, y, z] = grid_.cell(i);
    for (int n = 0; n < 27; ++n) {
      offer(grid_.index(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1));
    }
  }

  [[nodiscard]] std::size_t image(std::size_t i) const {
    const auto [x, y, z] = grid_.cell(i);
    return mirrored_ ? grid_.index(grid_.dims[0] - 1 - x, y, z) : i;
  }

  bool take(std::size_t i) {
    if (!take_one(i)) {
      return false;
    }
    const std::size_t other = image(i);
    if (other == i || take_one(other)) {
      return true;
    }
    grid_.kinds[i] = VoxelKind::inner;
    return false;
  }

  bool take_one(std::size_t i) {
    const auto [x, y, z] = grid_.cell(i);
    Cube cube{};
    for (int n = 0; n < 27; ++n) {
      cube[n] = grid_.occupied(grid_.index(x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1));
    }
    if (!is_one_part(cube, true, false) || !is_one_part(cube, false, true)) {
      return false;
    }
    grid_.kinds[i] = VoxelKind::outer;
    for (int n = 0; n < 8; ++n) {
      if (!is_well_composed(grid_, x - (n & 1), y - (n >> 1 & 1), z - (n >> 2))) {
        grid_.kinds[i] = VoxelKind::inner;
        return false;
      }
    }
    return true;
  }

  VoxelGrid& grid_;
  const VoxelGrid& needed_;
  bool mirrored_;
  std::vector<int> away_;
  std::priority_queue<std::pair<int, std::size_t>> queue_; // the farthest first
};

} // namespace

int genus_of(const VoxelGrid& grid) {
  long faces = 0;
  long corners = 0;
  for (int z = 0; z + 1 < grid.dims[2]; ++z) {
    for (int y = 0; y + 1 < grid.dims[1]; ++y) {
      for (int x = 0; x + 1 < grid.dims[0]; ++x) {
        const bool here = grid.occupied(grid.index(x, y, z));
        int round = here ? 1 : 0;
        for (int n = 1; n < 8; ++n) {
          const bool other = grid.occupied(grid.index(x + (n & 1), y + (n >> 1 & 1), z + (n >> 2)));
          round += other ? 1 : 0;
          faces += (n & (n - 1)) == 0 && other != here ? 1 : 0;
        }
        corners += round > 0 && round < 8 ? 1 : 0;
      }
    }
  }
  return static_cast<int>(1 - (corners - faces) / 2); // of quads: twice as many edges as faces
}

int fill_handles(VoxelGrid& grid, int most, double widest, bool mirrored) {
  const int before = genus_of(grid);
  if (before <= most) {
    return before;
  }
  VoxelGrid needed;
  for (double radius = 1; radius <= widest; radius *= 1.4) {
    needed = padded(grid, layers_to_close(radius) + 1);
    VoxelGrid closed = needed;
    close_gaps(closed, radius);
    make_manifold(closed, mirrored);
    if (genus_of(closed) <= most) {
      Carving(closed, needed, mirrored).run();
      grid = std::move(closed);
      return genus_of(grid);
    }
  }
  return before;
}

} // namespace cagewright
