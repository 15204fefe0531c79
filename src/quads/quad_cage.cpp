#include "quads/quad_cage.h"

#include <algorithm>

namespace cagewright {

FaceParts::FaceParts(const CageFace& face, Of which) {
  if (face.is_quad()) {
    triangles = {Triangle{face[0], face[1], face[2]}, Triangle{face[2], face[3], face[0]},
                 Triangle{face[1], face[2], face[3]}, Triangle{face[3], face[0], face[1]}};
    count = face.tentative && which == Of::valid ? 2 : 4;
  } else {
    triangles[0] = {face[0], face[1], face[2]};
    count = 1;
  }
}

QuadCage::QuadCage(TriangleView mesh, std::span<const Index> parts, std::span<const SeamBand> bands)
    : positions_(mesh.positions.begin(), mesh.positions.end()), around_(mesh.positions.size()),
      on_border_(mesh.positions.size(), 0), bands_(bands.begin(), bands.end()) {
  std::vector<CageFace> faces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    faces.push_back(CageFace::triangle(t[0], t[1], t[2]).of_part(parts.empty() ? 0 : parts[i]));
  }
  replace({}, faces);
  find_border();
}

QuadCage::QuadCage(const PolygonMesh& mesh)
    : positions_(mesh.positions), around_(mesh.positions.size()),
      on_border_(mesh.positions.size(), 0) {
  std::vector<CageFace> faces;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> v = mesh.face(f);
    faces.push_back(v.size() == 4 ? CageFace::quad(v[0], v[1], v[2], v[3])
                                  : CageFace::triangle(v[0], v[1], v[2]));
  }
  replace({}, faces);
  find_border();
}

void QuadCage::find_border() {
  for (const CageFace& face : faces_) {
    for (int i = 0; i < face.size; ++i) {
      if (face_left_of(face[i + 1], face[i]) == no_index) {
        on_border_[face[i]] = on_border_[face[i + 1]] = 1;
        has_border_ = true;
      }
    }
  }
}

Index QuadCage::face_left_of(Index a, Index b) const {
  for (const Index f : around_[a]) {
    const CageFace& face = faces_[f];
    for (int i = 0; i < face.size; ++i) {
      if (face[i] == a && face[i + 1] == b) {
        return f;
      }
    }
  }
  return no_index;
}

const SeamBand* QuadCage::band_of(Index v) const {
  Index least = no_index;
  Index most = 0;
  for (const Index f : around_[v]) {
    least = std::min(least, faces_[f].part);
    most = std::max(most, faces_[f].part);
  }
  return !bands_.empty() && least < most ? &bands_[most] : nullptr;
}

void QuadCage::replace(std::span<const Index> removed, std::span<const CageFace> added) {
  for (const Index f : removed) {
    for (const Index v : faces_[f].span()) {
      std::erase(around_[v], f);
    }
    faces_[f].size = 0;
  }
  for (const CageFace& face : added) {
    for (const Index v : face.span()) {
      around_[v].push_back(face_end());
    }
    faces_.push_back(face);
  }
}

void QuadCage::renumber_faces() {
  std::erase_if(faces_, [](const CageFace& face) { return face.size == 0; });
  for (std::vector<Index>& faces : around_) {
    faces.clear();
  }
  for (Index f = 0; f < face_end(); ++f) {
    for (const Index v : faces_[f].span()) {
      around_[v].push_back(f);
    }
  }
}

PolygonMesh QuadCage::to_polygons() const {
  PolygonMesh mesh;
  std::vector<Index> number(positions_.size(), no_index);
  for (Index v = 0; v < vertex_end(); ++v) {
    if (!around_[v].empty()) {
      number[v] = static_cast<Index>(mesh.positions.size());
      mesh.positions.push_back(positions_[v]);
    }
  }
  for (const CageFace& face : faces_) {
    if (face.size != 0) {
      std::array<Index, 4> corners{};
      for (int i = 0; i < face.size; ++i) {
        corners[i] = number[face[i]];
      }
      mesh.add_face({corners.data(), static_cast<std::size_t>(face.size)});
    }
  }
  return mesh;
}

std::vector<Index> QuadCage::parts() const {
  std::vector<Index> parts;
  for (const CageFace& face : faces_) {
    if (face.size != 0) {
      parts.push_back(face.part);
    }
  }
  return parts;
}

} // namespace cagewright
