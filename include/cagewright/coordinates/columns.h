/// \file
/// What the columns of a binding stand for, and how a deformed cage moves them.
#pragma once

#include <cagewright/core/geometry.h>
#include <cagewright/mesh/triangle_mesh.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace cagewright {

/// Columns that follow one another and mean the same.
struct ColumnGroup {
  std::string_view name; ///< "vertices", "normals"
  std::size_t count = 0;
};

/// Matrices by which points are divided, of rules in which the sum of the weights turns with the
/// cage: x' = center + (Id + A)^-1 (x - center + sum over k of W(x, k) moves_k), where
/// A = sum over k of W(x, k) A_k.
struct ColumnDivisor {
  Vec3 center = Vec3::Zero();
  std::array<std::vector<Vec3>, 3> moves; ///< K first columns of A_k, K second ones, K third ones
};

/// The rule of every kind of coordinates: a binding is a matrix W of P points by K columns, a
/// deformed cage turns into K vectors, and a point x goes to
///
///     x' = x + sum over k of W(x, k) (m'_k - m_k),
///
/// with m_k those of the cage at rest. So a cage at rest leaves the model exactly where it is, and
/// whatever moves, stores or streams weights need not know of which kind they are. Immutable.
class ColumnRule {
public:
  virtual ~ColumnRule() = default;
  ColumnRule(const ColumnRule&) = delete;
  ColumnRule& operator=(const ColumnRule&) = delete;

  /// C positions: the cage at rest.
  [[nodiscard]] std::span<const Vec3> cage_at_rest() const { return cage_at_rest_; }

  /// What the columns are, in order. Those of the cage's vertices, if there are any, come first.
  [[nodiscard]] virtual std::vector<ColumnGroup> groups() const = 0;

  /// K.
  [[nodiscard]] std::size_t columns() const;

  /// Writes m'_k - m_k of all K columns; exactly zero for the cage at rest.
  /// \param cage  C positions
  virtual void move(std::span<const Vec3> cage, std::span<Vec3> moves) const = 0;

  /// What points are divided by besides, of the few rules in which they are; none at rest.
  [[nodiscard]] virtual std::optional<ColumnDivisor> divisor(std::span<const Vec3> /*cage*/) const {
    return std::nullopt;
  }

  /// m_k, where the weights reproduce a point x from them: x = sum over k of W(x, k) m_k. Empty for
  /// kinds that do not.
  [[nodiscard]] virtual std::vector<Vec3> reproduced_from() const = 0;

  /// Adds to K factors those with which columns make up how far a point follows a vertex of the
  /// cage, to be shown to people.
  virtual void add_influence(Index vertex, std::span<double> factors) const {
    factors[vertex] += 1;
  }

protected:
  explicit ColumnRule(std::span<const Vec3> cage_at_rest)
      : cage_at_rest_(cage_at_rest.begin(), cage_at_rest.end()) {}

private:
  std::vector<Vec3> cage_at_rest_;
};

/// One column for each vertex of the cage, that moves as the vertex does.
std::shared_ptr<const ColumnRule> vertex_columns(std::span<const Vec3> cage_at_rest);

} // namespace cagewright
