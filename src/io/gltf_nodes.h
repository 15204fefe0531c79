/// \file
/// The nodes of a glTF file: which are shown, and where.
#pragma once

#include "io/gltf_document.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

/// The hierarchy of nodes.
class GltfNodes {
public:
  using Transform = Eigen::Affine3d;

  explicit GltfNodes(const GltfDocument& document);

  /// A node of the scene.
  struct Shown {
    std::size_t node = 0;
    Transform transform; ///< to the scene
  };

  /// The nodes of the default scene; of the first where none is the default; all where there is no
  /// scene. Depth first, children in their order. Errors: malformed.
  Result<std::vector<Shown>> shown();

  /// From a node's frame to the scene's. The node need not be in the scene: joints are where their
  /// ancestors put them. Errors: malformed.
  Result<Transform> world(std::size_t node);

  [[nodiscard]] std::size_t count() const { return parents_.size(); }
  [[nodiscard]] const Json& node(std::size_t index) const { return element(nodes_, index); }
  [[nodiscard]] std::optional<std::size_t> parent(std::size_t node) const { return parents_[node]; }

private:
  Result<std::vector<std::size_t>> roots();
  Result<std::vector<std::size_t>> list(const Json& nodes, const std::string& where) const;
  Result<std::vector<std::size_t>> children(std::size_t node) const;
  Result<Transform> local(std::size_t node) const;

  const Json& document_;
  const Source& source_;
  const Json& nodes_;
  std::vector<std::optional<std::size_t>> parents_;
  std::vector<std::optional<Transform>> world_; // as far as known
};

/// A list of `count` numbers, or none where the member is missing; false for anything else.
bool read_numbers(const Json& list, std::size_t count, std::vector<double>& numbers);

} // namespace cagewright
