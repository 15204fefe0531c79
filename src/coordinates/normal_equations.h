/// \file
/// Large dense systems in least squares, on all cores. Internal to this module.
#pragma once

#include <cagewright/coordinates/aligned_buffer.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <span>
#include <vector>

namespace cagewright {

/// Numbers side by side in all matrices of this header: 16 columns are a strip, in which row
/// follows row.
constexpr std::size_t strip_columns = 16;

/// Rows by columns in strips; columns are filled up to whole strips.
class StripMatrix {
public:
  StripMatrix() = default;
  /// All zeros.
  StripMatrix(std::size_t rows, std::size_t columns);

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t strips() const { return strips_; }
  /// 16 numbers a row.
  [[nodiscard]] double* strip(std::size_t s) { return data_.data() + s * rows_ * strip_columns; }
  [[nodiscard]] const double* strip(std::size_t s) const {
    return data_.data() + s * rows_ * strip_columns;
  }
  [[nodiscard]] double& at(std::size_t row, std::size_t column) {
    return strip(column / strip_columns)[row * strip_columns + column % strip_columns];
  }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return strip(column / strip_columns)[row * strip_columns + column % strip_columns];
  }

private:
  std::size_t rows_ = 0;
  std::size_t strips_ = 0;
  AlignedBuffer<double> data_;
};

/// s[j * 16 + i] += factor * sum over the rows of a[row * 16 + j] * b[row * 16 + i], for 16 by 16
/// numbers; on this thread, with the best instructions of this machine.
void add_product(std::size_t rows, double factor, const double* a, const double* b, double* s);

/// The x that minimise |A x - B|^2, for A of many rows, given some at a time: A^T A is factored
/// once for all sides. The same on any number of threads.
class PositiveSystem {
public:
  /// \param unknowns  N columns of A
  /// \param sides     columns of B
  PositiveSystem(std::size_t unknowns, std::size_t sides);

  /// Adds rows: as many of A as of B. Cost: O(rows N^2).
  void add(const StripMatrix& a, const StripMatrix& b);

  /// An entry of the matrix, row >= column; of the sides. All are 0 at first.
  [[nodiscard]] double& entry(std::size_t row, std::size_t column) {
    return tile(row / strip_columns,
                column /
                    strip_columns)[(column % strip_columns) * strip_columns + row % strip_columns];
  }
  [[nodiscard]] double& side(std::size_t row, std::size_t column) { return sides_.at(row, column); }

  /// N rows, padded to a multiple of 16, by sides. Cost: O(N^3). Errors: cancelled.
  /// \param least_pivot  what is left of a diagonal entry in the factor is at least this part of
  ///     it: entries that come of quadrature need not be those of a positive matrix
  Result<StripMatrix> solve(const Progress& progress, double least_pivot = 0);

  /// Bytes that a system takes.
  static double bytes(std::size_t unknowns);

private:
  [[nodiscard]] double* tile(std::size_t row, std::size_t column) {
    return lower_.data() + (row * (row + 1) / 2 + column) * strip_columns * strip_columns;
  }
  void factor_column(std::size_t column);
  void forward(double* side);
  void backward(double* side);

  std::size_t unknowns_;
  std::size_t tiles_; // of 16 unknowns
  std::vector<double> least_pivots_;
  AlignedBuffer<double> lower_; // tiles of the lower triangle, column by column inside
  StripMatrix sides_;           // A^T B
};

} // namespace cagewright
