#include "envelope/well_composed.h"

#include "voxel/mirrored_grid.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace cagewright {

namespace {

// A block of eight voxels is a set of bits: bit x + 2 y + 4 z.
using Block = std::uint32_t;

bool hangs_together(Block set) {
  if (set == 0) {
    return true;
  }
  Block reached = set & (~set + 1);
  for (;;) {
    Block next = reached;
    next |= ((reached & 0x55U) << 1U) | ((reached & 0xaaU) >> 1U);
    next |= ((reached & 0x33U) << 2U) | ((reached & 0xccU) >> 2U);
    next |= ((reached & 0x0fU) << 4U) | ((reached & 0xf0U) >> 4U);
    next &= set;
    if (next == reached) {
      return reached == set;
    }
    reached = next;
  }
}

bool is_well_composed(Block set) {
  return hangs_together(set) && hangs_together(~set & 0xffU);
}

Block block_at(const VoxelGrid& grid, int i, int j, int k) {
  Block set = 0;
  for (Block b = 0; b < 8; ++b) {
    set |= static_cast<Block>(grid.occupied(grid.index(i + static_cast<int>(b & 1U),
                                                       j + static_cast<int>(b >> 1U & 1U),
                                                       k + static_cast<int>(b >> 2U))))
           << b;
  }
  return set;
}

// For every block the smallest well-composed one that contains it.
std::array<std::uint8_t, 256> repairs() {
  std::array<std::uint8_t, 256> table{};
  for (Block set = 0; set < 256; ++set) {
    Block best = 0xffU;
    for (Block other = 0; other < 256; ++other) {
      if ((other & set) == set && is_well_composed(other) &&
          std::popcount(other) < std::popcount(best)) {
        best = other;
      }
    }
    table[set] = static_cast<std::uint8_t>(best);
  }
  return table;
}

} // namespace

std::size_t fill_cavities(VoxelGrid& grid) {
  std::vector<std::uint8_t> reached(grid.kinds.size(), 0);
  std::vector<std::size_t> stack;
  const auto reach = [&](std::size_t i) {
    if (!grid.occupied(i) && reached[i] == 0) {
      reached[i] = 1;
      stack.push_back(i);
    }
  };
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    const std::array<int, 3> c = grid.cell(i);
    for (int k = 0; k < 3; ++k) {
      if (c[k] == 0 || c[k] + 1 == grid.dims[k]) {
        reach(i);
      }
    }
  }
  while (!stack.empty()) {
    const std::size_t i = stack.back();
    stack.pop_back();
    const std::array<int, 3> c = grid.cell(i);
    for (int k = 0; k < 3; ++k) {
      if (c[k] > 0) {
        reach(i - grid.stride(k));
      }
      if (c[k] + 1 < grid.dims[k]) {
        reach(i + grid.stride(k));
      }
    }
  }
  std::size_t filled = 0;
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) {
    if (!grid.occupied(i) && reached[i] == 0) {
      grid.kinds[i] = VoxelKind::inner;
      ++filled;
    }
  }
  return filled;
}

bool is_well_composed(const VoxelGrid& grid, int i, int j, int k) {
  return is_well_composed(block_at(grid, i, j, k));
}

std::size_t make_well_composed(VoxelGrid& grid) {
  static const std::array<std::uint8_t, 256> repair = repairs();
  std::size_t filled = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k + 1 < grid.dims[2]; ++k) {
      for (int j = 0; j + 1 < grid.dims[1]; ++j) {
        for (int i = 0; i + 1 < grid.dims[0]; ++i) {
          const Block set = block_at(grid, i, j, k);
          const Block add = repair[set] & ~set;
          for (Block b = 0; b < 8; ++b) {
            if ((add >> b & 1U) != 0) {
              grid.kinds[grid.index(i + static_cast<int>(b & 1U),
                                    j + static_cast<int>(b >> 1U & 1U),
                                    k + static_cast<int>(b >> 2U))] = VoxelKind::inner;
              ++filled;
              changed = true;
            }
          }
        }
      }
    }
  }
  return filled;
}

void make_manifold(VoxelGrid& grid, bool mirrored) {
  std::size_t changed = 0;
  do { // no repair heeds the plane
    changed = mirrored ? mirror_occupied(grid) : 0;
    changed += make_well_composed(grid);
    changed += fill_cavities(grid);
  } while (changed > 0);
}

} // namespace cagewright
