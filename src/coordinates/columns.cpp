#include <cagewright/coordinates/columns.h>

#include <cassert>

namespace cagewright {
namespace {

class VertexColumns : public ColumnRule {
public:
  explicit VertexColumns(std::span<const Vec3> cage_at_rest) : ColumnRule(cage_at_rest) {}

  [[nodiscard]] std::vector<ColumnGroup> groups() const override {
    return {{"vertices", cage_at_rest().size()}};
  }

  void move(std::span<const Vec3> cage, std::span<Vec3> moves) const override {
    assert(cage.size() == cage_at_rest().size() && moves.size() == cage.size());
    for (std::size_t v = 0; v < cage.size(); ++v) {
      moves[v] = cage[v] - cage_at_rest()[v];
    }
  }

  [[nodiscard]] std::vector<Vec3> reproduced_from() const override {
    return {cage_at_rest().begin(), cage_at_rest().end()};
  }
};

} // namespace

std::size_t ColumnRule::columns() const {
  std::size_t count = 0;
  for (const ColumnGroup& group : groups()) {
    count += group.count;
  }
  return count;
}

std::shared_ptr<const ColumnRule> vertex_columns(std::span<const Vec3> cage_at_rest) {
  return std::make_shared<VertexColumns>(cage_at_rest);
}

} // namespace cagewright
