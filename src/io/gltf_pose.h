/// \file
/// What moves the vertices of a glTF mesh besides its node: joints and morph targets.
#pragma once

#include "io/gltf_document.h"
#include "io/gltf_nodes.h"
#include <cagewright/core/geometry.h>
#include <cagewright/core/result.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cagewright {

/// The skins of a file, each with the matrices of its joints as the nodes stand.
class GltfSkins {
public:
  GltfSkins(GltfDocument& document, GltfNodes& nodes) : document_(document), nodes_(nodes) {}

  /// The nodes that are the joints of a skin. Errors: malformed.
  Result<std::vector<std::size_t>> joints(std::size_t skin) const;

  /// From the frame of each joint to that of the mesh when it was bound; the inverses of what the
  /// file stores. Errors: malformed.
  Result<std::vector<Eigen::Affine3d>> inverse_bind_matrices(std::size_t skin);

  /// For each of `count` vertices the mean of its joints' matrices by its weights, which need not
  /// sum to 1; a vertex without weights follows the first joint it names. None where the primitive
  /// names no joints. (glTF 2.0, 3.7.3.3)
  ///
  /// Errors: malformed.
  Result<std::vector<Eigen::Affine3d>> blend(std::size_t skin, const Json& attributes,
                                             std::size_t count);

private:
  Result<const std::vector<Eigen::Affine3d>*> matrices(std::size_t skin);

  GltfDocument& document_;
  GltfNodes& nodes_;
  std::map<std::size_t, std::vector<Eigen::Affine3d>> matrices_; // joint to scene, times the bind's
};

/// The weights of a mesh's morph targets: the node's, else the mesh's. Errors: malformed.
Result<std::vector<double>> morph_weights(const Source& source, const Json& node, const Json& mesh,
                                          const std::string& where);

/// The accessors of the morph targets of a primitive that weigh, for one attribute.
struct GltfMorph {
  std::vector<std::size_t> accessors;
  std::vector<double> weights;
};
GltfMorph morph_of(const Json& primitive, const char* attribute,
                   const std::vector<double>& weights);

/// The weighted sum of the targets for each of `count` vertices; none where none weighs. Errors:
/// those of GltfDocument::read_vectors(); malformed (another count).
Result<std::vector<Vec3>> morph_shifts(GltfDocument& document, const GltfMorph& morph,
                                       std::size_t count);

} // namespace cagewright
