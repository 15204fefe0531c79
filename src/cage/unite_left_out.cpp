// What stands for the union of boxes in a build without it (CAGEWRIGHT_WITH_BOXES=OFF).
#include "cage/unite.h"

namespace cagewright {

bool can_unite() {
  return false;
}

Result<TriangleMesh> unite(std::span<const Hexahedron>, const UniteOptions&, const Progress&) {
  return Error{ErrorCode::not_available,
               "this build has no union of boxes, which needs CGAL, GMP and MPFR and is under the "
               "GPL: make the cage from an envelope, or build with CAGEWRIGHT_WITH_BOXES=ON"};
}

} // namespace cagewright
