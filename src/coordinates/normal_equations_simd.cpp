// Products of strips. Compiled once for each instruction set (Highway includes this file again and
// again); the best is chosen when the program runs. All work of factoring and solving is such
// products of 16 by 16 numbers.

#include "coordinates/normal_equations.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "coordinates/normal_equations_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace cagewright {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 16>;
using V = hn::VFromD<D>;
constexpr std::size_t lanes = hn::MaxLanes(D());
constexpr std::size_t vectors = 16 / lanes;
/// As many sums as there are registers for.
constexpr std::size_t at_once = lanes >= 8 ? 8 : lanes >= 4 ? 2 : 1;

void product(std::size_t rows, double factor, const double* a, const double* b, double* s) {
  const D d;
  for (std::size_t j = 0; j < 16; j += at_once) {
    V sums[at_once][vectors];
    for (auto& row : sums) {
      for (V& sum : row) {
        sum = hn::Zero(d);
      }
    }
    for (std::size_t r = 0; r < rows; ++r) {
      V right[vectors];
      for (std::size_t v = 0; v < vectors; ++v) {
        right[v] = hn::Load(d, b + 16 * r + v * lanes);
      }
      for (std::size_t k = 0; k < at_once; ++k) {
        const V left = hn::Set(d, a[16 * r + j + k]);
        for (std::size_t v = 0; v < vectors; ++v) {
          sums[k][v] = hn::MulAdd(left, right[v], sums[k][v]);
        }
      }
    }
    const V scale = hn::Set(d, factor);
    for (std::size_t k = 0; k < at_once; ++k) {
      for (std::size_t v = 0; v < vectors; ++v) {
        double* const to = s + 16 * (j + k) + v * lanes;
        hn::Store(hn::MulAdd(scale, sums[k][v], hn::Load(d, to)), d, to);
      }
    }
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace cagewright
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace cagewright {

HWY_EXPORT(product);

namespace {

constexpr std::size_t tile_size = strip_columns * strip_columns;

/// Of a tile that holds the lower triangle of a matrix column by column: its factor, in place.
/// \param least  pivots
void factor_diagonal(double* tile, const double* least) {
  for (std::size_t j = 0; j < strip_columns; ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      const double below = tile[k * strip_columns + j];
      for (std::size_t i = j; i < strip_columns; ++i) {
        tile[j * strip_columns + i] -= below * tile[k * strip_columns + i];
      }
    }
    const double pivot = std::sqrt(std::max(tile[j * strip_columns + j], least[j]));
    for (std::size_t i = 0; i < strip_columns; ++i) {
      tile[j * strip_columns + i] = i < j ? 0 : tile[j * strip_columns + i] / pivot;
    }
  }
}

/// tile = tile * diagonal^-T.
void divide_by_diagonal(const double* diagonal, double* tile) {
  for (std::size_t j = 0; j < strip_columns; ++j) {
    double* const column = tile + j * strip_columns;
    for (std::size_t k = 0; k < j; ++k) {
      const double factor = diagonal[k * strip_columns + j];
      for (std::size_t i = 0; i < strip_columns; ++i) {
        column[i] -= factor * tile[k * strip_columns + i];
      }
    }
    const double pivot = diagonal[j * strip_columns + j];
    for (std::size_t i = 0; i < strip_columns; ++i) {
      column[i] /= pivot;
    }
  }
}

std::array<double, tile_size> transposed(const double* tile) {
  std::array<double, tile_size> other;
  for (std::size_t j = 0; j < strip_columns; ++j) {
    for (std::size_t i = 0; i < strip_columns; ++i) {
      other[i * strip_columns + j] = tile[j * strip_columns + i];
    }
  }
  return other;
}

} // namespace

void add_product(std::size_t rows, double factor, const double* a, const double* b, double* s) {
  HWY_DYNAMIC_DISPATCH(product)(rows, factor, a, b, s);
}

StripMatrix::StripMatrix(std::size_t rows, std::size_t columns)
    : rows_(rows), strips_((columns + strip_columns - 1) / strip_columns),
      data_(rows_ * strips_ * strip_columns) {
  std::fill(data_.span().begin(), data_.span().end(), 0.0);
}

PositiveSystem::PositiveSystem(std::size_t unknowns, std::size_t sides)
    : unknowns_(unknowns), tiles_((unknowns + strip_columns - 1) / strip_columns),
      lower_(tiles_ * (tiles_ + 1) / 2 * tile_size), sides_(tiles_ * strip_columns, sides) {
  std::fill(lower_.span().begin(), lower_.span().end(), 0.0);
}

double PositiveSystem::bytes(std::size_t unknowns) {
  return static_cast<double>(unknowns) * static_cast<double>(unknowns) / 2 * sizeof(double);
}

void PositiveSystem::add(const StripMatrix& a, const StripMatrix& b) {
  constexpr std::size_t group = 4; // strips that share what they read
  const std::size_t groups = (tiles_ + group - 1) / group;
  parallel_for(0, groups, 1, [&](std::size_t g) {
    // Long rows of tiles and short ones by turns, so that all threads have as much to do.
    const std::size_t chosen = g % 2 == 0 ? g / 2 : groups - 1 - g / 2;
    const std::size_t end = std::min((chosen + 1) * group, tiles_);
    for (std::size_t column = 0; column < end; ++column) {
      for (std::size_t row = std::max(chosen * group, column); row < end; ++row) {
        add_product(a.rows(), 1, a.strip(column), a.strip(row), tile(row, column));
      }
    }
    for (std::size_t row = chosen * group; row < end; ++row) {
      for (std::size_t side = 0; side < sides_.strips(); ++side) {
        add_product(a.rows(), 1, a.strip(row), b.strip(side), sides_.strip(side) + row * tile_size);
      }
    }
  });
}

void PositiveSystem::factor_column(std::size_t column) {
  const auto subtract = [&](std::size_t row) { // the tiles of a row are one strip
    add_product(strip_columns * column, -1, tile(column, 0), tile(row, 0), tile(row, column));
  };
  subtract(column);
  factor_diagonal(tile(column, column), &least_pivots_[column * strip_columns]);
  parallel_for(column + 1, tiles_, 4, [&](std::size_t row) {
    subtract(row);
    divide_by_diagonal(tile(column, column), tile(row, column));
  });
}

void PositiveSystem::forward(double* side) {
  for (std::size_t row = 0; row < tiles_; ++row) {
    double* const here = side + row * tile_size;
    add_product(strip_columns * row, -1, tile(row, 0), side, here);
    const double* const diagonal = tile(row, row);
    for (std::size_t i = 0; i < strip_columns; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const double factor = diagonal[k * strip_columns + i];
        for (std::size_t c = 0; c < strip_columns; ++c) {
          here[i * strip_columns + c] -= factor * here[k * strip_columns + c];
        }
      }
      for (std::size_t c = 0; c < strip_columns; ++c) {
        here[i * strip_columns + c] /= diagonal[i * strip_columns + i];
      }
    }
  }
}

void PositiveSystem::backward(double* side) {
  for (std::size_t row = tiles_; row-- > 0;) {
    double* const here = side + row * tile_size;
    for (std::size_t below = row + 1; below < tiles_; ++below) {
      const std::array<double, tile_size> turned = transposed(tile(below, row));
      add_product(strip_columns, -1, turned.data(), side + below * tile_size, here);
    }
    const double* const diagonal = tile(row, row);
    for (std::size_t i = strip_columns; i-- > 0;) {
      for (std::size_t k = i + 1; k < strip_columns; ++k) {
        const double factor = diagonal[i * strip_columns + k];
        for (std::size_t c = 0; c < strip_columns; ++c) {
          here[i * strip_columns + c] -= factor * here[k * strip_columns + c];
        }
      }
      for (std::size_t c = 0; c < strip_columns; ++c) {
        here[i * strip_columns + c] /= diagonal[i * strip_columns + i];
      }
    }
  }
}

Result<StripMatrix> PositiveSystem::solve(const Progress& progress, double least_pivot) {
  double trace = 0;
  for (std::size_t u = 0; u < unknowns_; ++u) {
    const std::size_t at = u % strip_columns;
    trace += tile(u / strip_columns, u / strip_columns)[at * strip_columns + at];
  }
  for (std::size_t u = 0; u < tiles_ * strip_columns; ++u) {
    const std::size_t at = u % strip_columns;
    double& diagonal = tile(u / strip_columns, u / strip_columns)[at * strip_columns + at];
    // A trifle of each, so that rounding leaves all pivots positive.
    diagonal = u < unknowns_ ? diagonal * (1 + 1e-15) + 1e-300 : trace / 16 + 1;
    least_pivots_.push_back(std::max(least_pivot * diagonal, 1e-290));
  }
  for (std::size_t column = 0; column < tiles_; ++column) {
    if (progress.cancelled()) {
      return Error::cancelled();
    }
    factor_column(column);
    const double done = static_cast<double>(column + 1) / static_cast<double>(tiles_);
    progress(done * done, "bind");
  }
  parallel_for(0, sides_.strips(), 1, [&](std::size_t side) {
    forward(sides_.strip(side));
    backward(sides_.strip(side));
  });
  return std::move(sides_);
}

} // namespace cagewright
#endif
