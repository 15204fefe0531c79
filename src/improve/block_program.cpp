#include "improve/block_program.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace cagewright {

namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int most_iterations = 25;
constexpr double accuracy = 1e-6; // of the complementarity, relative to its start

class InteriorPoint {
public:
  InteriorPoint(const BlockQuadratic& quadratic, std::span<const BlockConstraint> constraints,
                double slack)
      : quadratic_(quadratic), constraints_(constraints), slack_(slack),
        size_(static_cast<Eigen::Index>(3 * quadratic.gradient.size())) {
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
        break;
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
      const double length = std::min(1.0, 0.99 * std::min(longest(s, step.s), longest(z, step.z)));
      x += length * step.x;
      s += length * step.s;
      z += length * step.z;
    }
    return x;
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

  // Lower triangle of the Hessian plus the constraints' outer products, weighted.
  [[nodiscard]] Sparse assemble(const Vector& weights) const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * (quadratic_.terms.size() + 6 * static_cast<std::size_t>(weights.size())));
    const auto add = [&](Index row, Index column, const Mat3& block) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const int r = static_cast<int>(3 * row) + i;
          const int c = static_cast<int>(3 * column) + j;
          if (r >= c) {
            entries.emplace_back(r, c, block(i, j));
          }
        }
      }
    };
    for (const BlockQuadratic::Term& t : quadratic_.terms) {
      if (t.row >= t.column) {
        add(t.row, t.column, t.block);
      } else {
        add(t.column, t.row, t.block.transpose());
      }
    }
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      const Mat3 outer = weights[k] * c.direction * c.direction.transpose();
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (c.vertex[i] >= c.vertex[j] && c.weight[i] != 0 && c.weight[j] != 0) {
            add(c.vertex[i], c.vertex[j], c.weight[i] * c.weight[j] * outer);
          }
        }
      }
    }
    Sparse matrix(size_, size_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  [[nodiscard]] Vector times_hessian(const Vector& x) const {
    return hessian_.selfadjointView<Eigen::Lower>() * x;
  }

  [[nodiscard]] Vector times(const Vector& x) const {
    Vector result(static_cast<Eigen::Index>(constraints_.size()));
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      double sum = 0;
      for (int i = 0; i < 3; ++i) {
        sum +=
            c.weight[i] * c.direction.dot(x.segment<3>(static_cast<Eigen::Index>(3) * c.vertex[i]));
      }
      result[static_cast<Eigen::Index>(k)] = sum;
    }
    return result;
  }

  [[nodiscard]] Vector transposed(const Vector& z) const {
    Vector result = Vector::Zero(size_);
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      for (int i = 0; i < 3; ++i) {
        result.segment<3>(static_cast<Eigen::Index>(3) * c.vertex[i]) +=
            z[static_cast<Eigen::Index>(k)] * c.weight[i] * c.direction;
      }
    }
    return result;
  }

  const BlockQuadratic& quadratic_;
  std::span<const BlockConstraint> constraints_;
  double slack_;
  Eigen::Index size_;
  Sparse hessian_;
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
