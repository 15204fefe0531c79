#include "improve/block_program.h"

#include "core/maths.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace cagewright {

namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int most_iterations = 25;

class InteriorPoint {
public:
  InteriorPoint(const BlockQuadratic& quadratic, std::span<const BlockConstraint> constraints,
                const BlockProgramOptions& options)
      : quadratic_(quadratic), constraints_(constraints), slack_(options.slack),
        accuracy_(options.accuracy),
        size_(static_cast<Eigen::Index>(3 * quadratic.gradient.size())) {
    find_groups();
    lay_out();
    hessian_ = assemble({});
    gradient_.resize(size_);
    for (std::size_t v = 0; v < quadratic.gradient.size(); ++v) {
      gradient_.segment<3>(static_cast<Eigen::Index>(3 * v)) = quadratic.gradient[v];
    }
  }

  Vector solve(const Progress& progress) {
    const auto count = static_cast<Eigen::Index>(constraints_.size());
    Vector x = Vector::Zero(size_);
    Vector bound(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      bound[k] = constraints_[k].bound;
    }
    // Slacks as they are, but well off the boundary, and multipliers rather too large than too
    // small: from near the boundary steps are short, and too small a multiplier grows slowly.
    const double typical = std::max(1e-12, bound.cwiseAbs().sum() / static_cast<double>(count + 1));
    Vector s = (-bound).cwiseMax(typical / 2);
    Vector z = Vector::Constant(count, 10 * typical_multiplier(bound));
    for (int iteration = 0; iteration < most_iterations && !progress.cancelled(); ++iteration) {
      const Vector hx = times_hessian(x);
      const Vector dual = hx + gradient_ - transposed(z);
      const Vector primal = times(x) - bound + slack_ * z - s;
      const double gap = s.dot(z);
      const double mu = count > 0 ? gap / static_cast<double>(count) : 0;
      const double value = std::abs(gradient_.dot(x)) + x.dot(hx) + slack_ * z.squaredNorm();
      const bool is_feasible =
          count == 0 || primal.cwiseAbs().maxCoeff() <= accuracy_ / 2 * typical;
      if (iteration > 0 && is_feasible && dual.cwiseAbs().dot(x.cwiseAbs()) <= accuracy_ * value &&
          gap <= accuracy_ * value) {
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
      const double sigma = mu > 0 ? maths::cube(after / mu) : 0;
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

  // Of what pulls at x, and of what it takes to push x as far as the worst constraint asks.
  [[nodiscard]] double typical_multiplier(const Vector& bound) const {
    constexpr double least = 0.01;
    const double pull = gradient_.size() > 0 ? gradient_.cwiseAbs().mean() : 0;
    const double push =
        bound.size() > 0 ? std::max(0.0, bound.maxCoeff()) * hessian_.diagonal().mean() : 0;
    return std::max({least, pull, push});
  }

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

  // Consecutive constraints over the same vertices in the same direction: they see the vertices'
  // heights in that direction only, and are worked through with numbers instead of vectors.
  struct Group {
    std::size_t first = 0;
    std::size_t end = 0;
    int corners = 0; // up to the last that has a weight
  };

  void find_groups() {
    for (std::size_t k = 0; k < constraints_.size(); ++k) {
      const BlockConstraint& c = constraints_[k];
      const bool same = k > 0 && c.vertex == constraints_[k - 1].vertex &&
                        c.direction == constraints_[k - 1].direction &&
                        c.fourth_vertex == constraints_[k - 1].fourth_vertex;
      if (!same) {
        groups_.push_back({k, k, 0});
      }
      Group& group = groups_.back();
      group.end = k + 1;
      for (int i = group.corners; i < c.size(); ++i) {
        group.corners = c.weight_of(i) != 0 ? i + 1 : group.corners;
      }
    }
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
    std::vector<Index> term_block;
    for (const BlockQuadratic::Term& t : quadratic_.terms) {
      term_block.push_back(at(std::max(t.row, t.column), std::min(t.row, t.column)));
    }
    for (const Group& group : groups_) {
      for_pairs(group, [&](int i, int j) {
        const BlockConstraint& c = constraints_[group.first];
        pair_block_.push_back(at(c.vertex_of(i), c.vertex_of(j)));
      });
    }
    terms_.resize(all.size(), Mat3::Zero());
    for (std::size_t k = 0; k < term_block.size(); ++k) {
      const BlockQuadratic::Term& t = quadratic_.terms[k];
      if (t.row >= t.column) {
        terms_[term_block[k]] += t.block;
      } else {
        terms_[term_block[k]] += t.block.transpose();
      }
    }
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

  // Calls with the pairs (i, j) of a group's corners that make blocks on or below the diagonal.
  template <class Visit> void for_pairs(const Group& group, const Visit& visit) const {
    const BlockConstraint& c = constraints_[group.first];
    for (int i = 0; i < group.corners; ++i) {
      for (int j = 0; j < group.corners; ++j) {
        if (c.vertex_of(i) >= c.vertex_of(j)) {
          visit(i, j);
        }
      }
    }
  }

  // Lower triangle of the Hessian plus the constraints' outer products, weighted.
  const Sparse& assemble(const Vector& weights) {
    blocks_ = terms_;
    auto block = pair_block_.begin();
    for (const Group& group :
         weights.size() > 0 ? std::span<const Group>(groups_) : std::span<const Group>()) {
      double products[4][4] = {};
      for (std::size_t k = group.first; k < group.end; ++k) {
        const BlockConstraint& c = constraints_[k];
        for (int i = 0; i < group.corners; ++i) {
          const double weighted = weights[static_cast<Eigen::Index>(k)] * c.weight_of(i);
          for (int j = 0; j < group.corners; ++j) {
            products[i][j] += weighted * c.weight_of(j);
          }
        }
      }
      const Vec3& direction = constraints_[group.first].direction;
      const Mat3 outer = direction * direction.transpose();
      for_pairs(group, [&](int i, int j) { blocks_[*block++] += products[i][j] * outer; });
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
    for (const Group& group : groups_) {
      const BlockConstraint& first = constraints_[group.first];
      double height[4] = {};
      for (int i = 0; i < group.corners; ++i) {
        height[i] =
            first.direction.dot(x.segment<3>(static_cast<Eigen::Index>(3) * first.vertex_of(i)));
      }
      for (std::size_t k = group.first; k < group.end; ++k) {
        double sum = 0;
        for (int i = 0; i < group.corners; ++i) {
          sum += constraints_[k].weight_of(i) * height[i];
        }
        result[static_cast<Eigen::Index>(k)] = sum;
      }
    }
    return result;
  }

  [[nodiscard]] Vector transposed(const Vector& z) const {
    Vector result = Vector::Zero(size_);
    for (const Group& group : groups_) {
      double sum[4] = {};
      for (std::size_t k = group.first; k < group.end; ++k) {
        for (int i = 0; i < group.corners; ++i) {
          sum[i] += z[static_cast<Eigen::Index>(k)] * constraints_[k].weight_of(i);
        }
      }
      const BlockConstraint& first = constraints_[group.first];
      for (int i = 0; i < group.corners; ++i) {
        result.segment<3>(static_cast<Eigen::Index>(3) * first.vertex_of(i)) +=
            sum[i] * first.direction;
      }
    }
    return result;
  }

  const BlockQuadratic& quadratic_;
  std::span<const BlockConstraint> constraints_;
  double slack_;
  double accuracy_;
  Eigen::Index size_;
  Sparse hessian_;
  Sparse matrix_; // of the Newton steps, made anew for each
  std::vector<Group> groups_;
  std::vector<Mat3> terms_;  // of the quadratic, by block
  std::vector<Mat3> blocks_; // the same and the constraints
  std::vector<bool> is_diagonal_;
  std::vector<double*> slot_;     // in matrix_, for the entries of the blocks in turn
  std::vector<Index> pair_block_; // of the groups' pairs in turn
  Vector gradient_;
  Factor factor_;
};

} // namespace

std::vector<Vec3> minimize(const BlockQuadratic& quadratic,
                           std::span<const BlockConstraint> constraints,
                           const BlockProgramOptions& options, const Progress& progress) {
  const Vector x = InteriorPoint(quadratic, constraints, options).solve(progress);
  std::vector<Vec3> result(quadratic.gradient.size());
  for (std::size_t v = 0; v < result.size(); ++v) {
    result[v] = x.segment<3>(static_cast<Eigen::Index>(3 * v));
  }
  return result;
}

} // namespace cagewright
