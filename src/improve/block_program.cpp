#include "improve/block_program.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace cagewright {

namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int most_iterations = 25;
constexpr double accuracy = 1e-4; // of the complementarity, relative to its start

class InteriorPoint {
public:
  InteriorPoint(const BlockQuadratic& quadratic, std::span<const BlockConstraint> constraints,
                double slack)
      : quadratic_(quadratic), constraints_(constraints), slack_(slack),
        size_(static_cast<Eigen::Index>(3 * quadratic.gradient.size())) {
    lay_out();
    hessian_ = assemble({});
    gradient_.resize(size_);
    for (std::size_t v = 0; v < quadratic.gradient.size(); ++v) {
      gradient_.segment<3>(static_cast<Eigen::Index>(3 * v)) = quadratic.gradient[v];
    }
  }

  Vector solve() {
    const auto count = static_cast<Eigen::Index>(constraints_.size());
    Vector x = Vector::Zero(size_);
    Vector bound(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      bound[k] = constraints_[k].bound;
    }
    // Slacks as they are, but off the boundary; multipliers that make all products equal.
    const double typical = std::max(1e-12, bound.cwiseAbs().sum() / static_cast<double>(count + 1));
    Vector s = (-bound).cwiseMax(0.1 * typical);
    constexpr double least_multiplier = 0.01;
    Vector z = Vector::Constant(count, std::max(least_multiplier, gradient_.cwiseAbs().mean()));
    const double start = count > 0 ? s.dot(z) / static_cast<double>(count) : 0;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Vector dual = times_hessian(x) + gradient_ - transposed(z);
      const Vector primal = times(x) - bound + slack_ * z - s;
      const double mu = count > 0 ? s.dot(z) / static_cast<double>(count) : 0;
      if (mu <= accuracy * start &&
          primal.cwiseAbs().sum() <= 1e-4 * typical * static_cast<double>(count) &&
          dual.cwiseAbs().maxCoeff() <= 1e-6 * (1 + gradient_.cwiseAbs().maxCoeff())) {
        return x;
      }
      const Vector scale = s + slack_ * z;
      factor_.factorize_with(assemble(z.cwiseQuotient(scale)), iteration == 0);
      const auto direction = [&](const Vector& product) { // of the Newton step, for s z = product
        Step step;
        const Vector right = (product + z.cwiseProduct(primal)).cwiseQuotient(scale);
        step.x = factor_.solve(-dual - transposed(right));
        step.z = -right - z.cwiseProduct(times(step.x)).cwiseQuotient(scale);
        step.s = times(step.x) + slack_ * step.z + primal;
        return step;
      };
      const Step affine = direction(s.cwiseProduct(z));
      const double reach = std::min(longest(s, affine.s), longest(z, affine.z));
      const double after =
          count > 0 ? (s + reach * affine.s).dot(z + reach * affine.z) / static_cast<double>(count)
                    : 0;
      const double sigma = mu > 0 ? std::pow(after / mu, 3) : 0;
      const Step step =
          direction((s.cwiseProduct(z) + affine.s.cwiseProduct(affine.z)).array() - sigma * mu);
      const double longest_step = std::min(longest(s, step.s), longest(z, step.z));
      const double length = count > 0 ? 0.99 * longest_step : 1;
      x += length * step.x;
      s += length * step.s;
      z += length * step.z;
    }
    return Vector::Zero(size_);
  }

private:
  struct Step {
    Vector x, s, z;
  };

  class Factor {
  public:
    void factorize_with(const Sparse& matrix, bool first) {
      if (first) {
        llt_.analyzePattern(matrix);
      }
      llt_.factorize(matrix);
    }
    [[nodiscard]] Vector solve(const Vector& right) const { return llt_.solve(right); }

  private:
    Eigen::SimplicialLDLT<Sparse, Eigen::Lower> llt_;
  };

  // The greatest step in [0, 1] that keeps all of v + step * d at or above zero.
  static double longest(const Vector& v, const Vector& d) {
    double step = 1;
    for (Eigen::Index i = 0; i < v.size(); ++i) {
      if (d[i] < 0) {
        step = std::min(step, -v[i] / d[i]);
      }
    }
    return step;
  }

  // The blocks on and below the diagonal that are not zero, and where each goes.
  void lay_out() {
    std::vector<std::array<Index, 2>> all;
    // A row has few blocks: their numbers are found by going through them.
    std::vector<std::vector<Index>> of_row(quadratic_.gradient.size());
    const auto at = [&](Index row, Index column) {
      for (const Index block : of_row[row]) {
        if (all[block][1] == column) {
          return block;
        }
      }
      of_row[row].push_back(static_cast<Index>(all.size()));
      all.push_back({row, column});
      return of_row[row].back();
    };
    for (const BlockQuadratic::Term& t : quadratic_.terms) {
      term_block_.push_back(at(std::max(t.row, t.column), std::min(t.row, t.column)));
    }
    for (const BlockConstraint& c : constraints_) {
      for_pairs(c, [&](int i, int j) {
        constraint_block_.push_back(at(c.vertex_of(i), c.vertex_of(j)));
      });
    }
    blocks_.resize(all.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& [row, column] : all) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (row != column || i >= j) {
            entries.emplace_back(static_cast<int>(3 * row) + i, static_cast<int>(3 * column) + j,
                                 1.0);
          }
        }
      }
    }
    matrix_.resize(size_, size_);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    for (const Eigen::Triplet<double>& e : entries) {
      slot_.push_back(&matrix_.coeffRef(e.row(), e.col()));
    }
    is_diagonal_.resize(all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      is_diagonal_[k] = all[k][0] == all[k][1];
    }
  }

  // Calls with the pairs (i, j) of a constraint's corners that make blocks on or below the
  // diagonal.
  template <class Visit> static void for_pairs(const BlockConstraint& c, const Visit& visit) {
    for (int i = 0; i < c.size(); ++i) {
      for (int j = 0; j < c.size(); ++j) {
        if (c.weight_of(i) != 0 && c.weight_of(j) != 0 && c.vertex_of(i) >= c.vertex_of(j)) {
          visit(i, j);
        }
      }
    }
  }

  // Lower triangle of the Hessian plus the constraints' outer products, weighted.
  const Sparse& assemble(const Vector& weights) {
    std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero());
    for (std::size_t k = 0; k < quadratic_.terms.size(); ++k) {
      const BlockQuadratic::Term& t = quadratic_.terms[k];
      if (t.row >= t.column) {
        blocks_[term_block_[k]] += t.block;
      } else {
        blocks_[term_block_[k]] += t.block.transpose();
      }
    }
    auto block = constraint_block_.begin();
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      const Mat3 outer = weights[k] * c.direction * c.direction.transpose();
      for_pairs(
          c, [&](int i, int j) { blocks_[*block++] += c.weight_of(i) * c.weight_of(j) * outer; });
    }
    auto slot = slot_.begin();
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < (is_diagonal_[k] ? i + 1 : 3); ++j) {
          **slot++ = blocks_[k](i, j);
        }
      }
    }
    return matrix_;
  }

  [[nodiscard]] Vector times_hessian(const Vector& x) const {
    return hessian_.selfadjointView<Eigen::Lower>() * x;
  }

  [[nodiscard]] Vector times(const Vector& x) const {
    Vector result(static_cast<Eigen::Index>(constraints_.size()));
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      double sum = 0;
      for (int i = 0; i < c.size(); ++i) {
        sum += c.weight_of(i) *
               c.direction.dot(x.segment<3>(static_cast<Eigen::Index>(3) * c.vertex_of(i)));
      }
      result[static_cast<Eigen::Index>(k)] = sum;
    }
    return result;
  }

  [[nodiscard]] Vector transposed(const Vector& z) const {
    Vector result = Vector::Zero(size_);
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      for (int i = 0; i < c.size(); ++i) {
        result.segment<3>(static_cast<Eigen::Index>(3) * c.vertex_of(i)) +=
            z[static_cast<Eigen::Index>(k)] * c.weight_of(i) * c.direction;
      }
    }
    return result;
  }

  const BlockQuadratic& quadratic_;
  std::span<const BlockConstraint> constraints_;
  double slack_;
  Eigen::Index size_;
  Sparse hessian_;
  Sparse matrix_; // of the Newton steps, made anew for each
  std::vector<Mat3> blocks_;
  std::vector<bool> is_diagonal_;
  std::vector<double*> slot_; // in matrix_, for the entries of the blocks in turn
  std::vector<Index> term_block_;
  std::vector<Index> constraint_block_;
  Vector gradient_;
  Factor factor_;
};

} // namespace

std::vector<Vec3> minimize(const BlockQuadratic& quadratic,
                           std::span<const BlockConstraint> constraints, double slack) {
  const Vector x = InteriorPoint(quadratic, constraints, slack).solve();
  std::vector<Vec3> result(quadratic.gradient.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    result[v] = x.segment<3>(static_cast<Eigen::Index>(3 * v));
  }
  return result;
}

} // namespace cagewright
