#include "cage/box_cage.h"

#include "cage/not_valid.h"
#include "cage/unite.h"
#include "quads/quads.h"
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/validate_cage.h>

#include <array>
#include <span>
#include <utility>

namespace cagewright {
namespace {

/// Boxes grow by distinct amounts up to these parts of a voxel before they are united, so that no
/// two of their faces coincide. The second and third, without joints between boxes, are for the
/// case that the union does not survive the rounding to the model's coordinates.
constexpr std::array<double, 3> separations = {0.2, 0.17, 0.13};

// Shares of the whole time, for the progress bar.
constexpr double decomposed = 0.35;
constexpr double registered = 0.4;
constexpr double first_union = 0.8; // of what is left: it hardly ever takes another

/// The leaves' boxes and voxels; the voxels stay in the tree.
std::vector<BoxContents> contents_of(const BoxTree& tree, const std::vector<int>& leaves) {
  std::vector<BoxContents> contents;
  contents.reserve(leaves.size());
  for (const int leaf : leaves) {
    const BoxNode& node = tree.nodes[static_cast<std::size_t>(leaf)];
    contents.push_back({node.box, node.voxels});
  }
  return contents;
}

TriangleMesh to_model(const BoxDecomposition& boxes, TriangleMesh cage) {
  for (Vec3& p : cage.positions) {
    p = boxes.to_model(p);
  }
  return cage;
}

/// The union of the solids in the model's coordinates, if it is a valid cage there.
Result<TriangleMesh> cage_of(const std::vector<Hexahedron>& solids, double separation,
                             const BoxDecomposition& boxes, TriangleView model, bool allow_pieces,
                             Stopwatch& watch, const Progress& progress) {
  Result<TriangleMesh> united_solids =
      unite(solids, {.separation = separation}, progress.part(0, 0.9));
  watch.lap("union");
  if (!united_solids) {
    return united_solids;
  }
  TriangleMesh cage = to_model(boxes, std::move(*united_solids));
  const Result<ValidityReport> report =
      validate_cage(TriangleView(cage), model, {.allow_pieces = allow_pieces, .max_listed = 1},
                    progress.part(0.9, 1));
  watch.lap("check");
  if (!report) {
    return report.error();
  }
  if (!report->valid()) {
    return not_valid(*report, "try another resolution or depth");
  }
  return cage;
}

/// Quads that would make the cage invalid along their other diagonal are left as triangles.
PolygonMesh with_quads(const TriangleMesh& cage, TriangleView model, bool allow_pieces,
                       const Progress& progress) {
  PolygonMesh faces = pair_coplanar(cage);
  constexpr int attempts = 8;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const Progress part =
        progress.part(static_cast<double>(attempt) / attempts, (attempt + 1.0) / attempts);
    const Result<ValidityReport> report = validate_cage(
        faces, model, {.allow_pieces = allow_pieces, .max_listed = faces.face_count()}, part);
    if (!report) {
      break;
    }
    if (report->valid()) {
      return faces;
    }
    std::vector<char> at_fault(faces.face_count(), 0);
    for (const Violation& violation : report->violations) {
      if (violation.kind == ViolationKind::face_contact) {
        at_fault[violation.elements[1]] = 1;
      } else if (violation.kind == ViolationKind::self_intersection) {
        at_fault[violation.elements[0]] = at_fault[violation.elements[1]] = 1;
      } else if (violation.kind == ViolationKind::degenerate_face ||
                 violation.kind == ViolationKind::folded_face) {
        at_fault[violation.elements[0]] = 1;
      }
    }
    PolygonMesh next;
    next.positions = faces.positions;
    for (std::size_t f = 0; f < faces.face_count(); ++f) {
      const std::span<const Index> face = faces.face(f);
      if (at_fault[f] != 0 && face.size() == 4) {
        next.add_face({face[0], face[1], face[2]});
        next.add_face({face[0], face[2], face[3]});
      } else {
        next.add_face(face);
      }
    }
    faces = std::move(next);
  }
  return PolygonMesh(cage);
}

} // namespace

Result<BoxCage> make_box_cage(TriangleView model, const GenerateOptions& options, double clearance,
                              const Progress& progress) {
  DecomposeOptions splitting = decompose_options(options);
  splitting.clearance = clearance;
  Result<BoxDecomposition> boxes = decompose(model, splitting, progress.part(0, decomposed));
  if (!boxes) {
    return boxes.error();
  }
  auto parts = std::make_shared<BoxesMade>();
  parts->boxes = std::move(*boxes);
  parts->leaves = parts->boxes.tree.cover();
  BoxCage made;
  made.times = parts->boxes.times;
  Stopwatch watch(made.times);

  const std::vector<BoxContents> contents = contents_of(parts->boxes.tree, parts->leaves);
  parts->registration = keep_apart(contents);
  if (options.registration) {
    Result<Registration> joined = register_boxes(in_grid_coordinates(parts->boxes.grid), contents,
                                                 {}, progress.part(decomposed, registered));
    if (!joined) {
      return joined.error();
    }
    parts->registration = std::move(*joined);
  }
  watch.lap("registration");

  const bool allow_pieces = options.pieces == Pieces::apart;
  Error why;
  double begin = registered;
  for (const double separation : separations) {
    const double end = begin + first_union * (1 - begin); // what is left is for another, if need be
    Result<TriangleMesh> cage = cage_of(parts->registration.solids, separation, parts->boxes, model,
                                        allow_pieces, watch, progress.part(begin, end));
    begin = end;
    if (cage) {
      made.cage = std::move(*cage);
      made.faces = options.quads ? with_quads(made.cage, model, allow_pieces, progress.part(end, 1))
                                 : PolygonMesh(made.cage);
      if (options.quads) {
        made.cage = to_triangle_mesh(made.faces);
        watch.lap("quads");
      }
      made.made = std::move(parts);
      return progress.cancelled() ? Result<BoxCage>(Error::cancelled()) : std::move(made);
    }
    why = cage.error();
    if (why.code != ErrorCode::no_valid_cage) {
      break;
    }
    parts->registration = keep_apart(contents); // the simpler the solids, the surer their union
  }
  return why;
}

} // namespace cagewright
