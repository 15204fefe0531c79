#include "cage/own_cage.h"

#include "cage/budget.h"
#include "cage/enclose.h"
#include "cage/stage_time.h"
#include "cage/unit_frame.h"
#include "mesh/topology.h"
#include "quads/quad_weights.h"
#include "quads/quads.h"
#include "quads/relax_quads.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/validate_cage.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

// Shares of the time.
constexpr double enclosed = 0.6;
constexpr double tightened = 0.95;

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// The cage as its faces say it, and what was done to make it so.
struct Prepared {
  PolygonMesh cage;
  std::string changes; ///< empty: nothing
};

PolygonMesh without_loose_vertices(const PolygonMesh& mesh) {
  std::vector<std::uint8_t> is_used(mesh.positions.size(), 0);
  for (const Index v : mesh.corners()) {
    is_used[v] = 1;
  }
  PolygonMesh result;
  std::vector<Index> number(mesh.positions.size(), 0);
  for (std::size_t v = 0; v < number.size(); ++v) {
    number[v] = static_cast<Index>(result.positions.size());
    if (is_used[v] != 0) {
      result.positions.push_back(mesh.positions[v]);
    }
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> corners;
    for (const Index v : mesh.face(f)) {
      corners.push_back(number[v]);
    }
    result.add_face(corners);
  }
  return result;
}

PolygonMesh turned(const PolygonMesh& mesh) {
  PolygonMesh result;
  result.positions = mesh.positions;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    std::vector<Index> corners(face.begin(), face.end());
    std::reverse(corners.begin() + 1, corners.end()); // the first corner stays the first
    result.add_face(corners);
  }
  return result;
}

/// What keeps a cage from being one however its vertices are moved; empty: nothing.
std::string flaw_of(const TopologyReport& report) {
  const auto flaw = [](std::size_t count, const char* one, const char* many) {
    return "it has " + counted(count, one, many);
  };
  if (report.edges == 0) {
    return "it has no faces";
  }
  if (!report.repeated_corner_faces.empty()) {
    return flaw(report.repeated_corner_faces.size(), "face that names a vertex twice",
                "faces that name a vertex twice");
  }
  if (!report.boundary_edges.empty()) {
    return "it is open: " + counted(report.boundary_edges.size(), "edge has", "edges have") +
           " one face only";
  }
  if (!report.nonmanifold_edges.empty()) {
    return flaw(report.nonmanifold_edges.size(), "edge of three or more faces",
                "edges of three or more faces");
  }
  if (!report.nonmanifold_vertices.empty()) {
    return flaw(report.nonmanifold_vertices.size(), "vertex where parts of it touch in a point",
                "vertices where parts of it touch in a point");
  }
  if (!report.inconsistent_edges.empty()) {
    return flaw(report.inconsistent_edges.size(), "edge whose two faces face opposite ways",
                "edges whose two faces face opposite ways");
  }
  if (report.components > 1) {
    return "it consists of " + std::to_string(report.components) + " pieces";
  }
  return "";
}

Result<Prepared> prepare(const PolygonMesh& start) {
  Prepared result;
  for (const Vec3& p : start.positions) {
    if (!p.allFinite()) {
      return Error{ErrorCode::invalid_cage,
                   "the cage to start from has a vertex that is not finite"};
    }
  }
  const auto note = [&](const std::string& change) {
    result.changes += (result.changes.empty() ? "" : ", ") + change;
  };
  PolygonMesh welded = weld(start);
  const std::size_t merged = start.positions.size() - welded.positions.size();
  if (merged > 0) {
    note(counted(merged, "vertex", "vertices") + " at the same positions as others merged");
  }
  result.cage = without_loose_vertices(welded);
  const std::size_t loose = welded.positions.size() - result.cage.positions.size();
  if (loose > 0) {
    note(counted(loose, "vertex", "vertices") + " that no face uses left out");
  }
  if (const std::string flaw = flaw_of(topology(result.cage)); !flaw.empty()) {
    return Error{ErrorCode::invalid_cage,
                 "the cage to start from cannot become valid by moving its vertices: " + flaw};
  }
  if (signed_volume(to_triangle_mesh(result.cage)) < 0) {
    result.cage = turned(result.cage);
    note("its faces turned to face outward");
  }
  return result;
}

/// Triangles and quads as they are, larger faces cut: what the steps are made on. The vertices keep
/// their numbers.
PolygonMesh cut_to_quads(const PolygonMesh& cage) {
  PolygonMesh result;
  PolygonMesh large;
  result.positions = large.positions = cage.positions;
  for (std::size_t f = 0; f < cage.face_count(); ++f) {
    (cage.face(f).size() <= 4 ? result : large).add_face(cage.face(f));
  }
  for (const Triangle& t : to_triangle_mesh(large).triangles) {
    result.add_face(t);
  }
  return result;
}

/// As near to the model as the faces allow.
void tighten(QuadCage& cage, const QuadGuard& guard, const TriangleMesh& model,
             const GenerateOptions& options, const Progress& progress) {
  QuadOptions quads;
  quads.clearance = options.clearance;
  quads.density = options.density;
  const TriangleMesh triangles = to_triangle_mesh(cage.to_polygons());
  const double face_area =
      surface_area(triangles) / static_cast<double>(triangles.triangles.size());
  const Objective objective(guard.model(), weights_for(model, quads, face_area));
  constexpr int passes = 6;
  constexpr double worth_another = 0.995;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < passes && !progress.cancelled(); ++k) {
    const double now =
        relax_quads(cage, guard, objective, {.keep = options.clearance},
                    progress.part(static_cast<double>(k) / passes, (k + 1.0) / passes));
    if (now > worth_another * before) {
      break;
    }
    before = now;
  }
}

Error not_enclosed(const EncloseReport& report) {
  return {ErrorCode::no_valid_cage,
          "the faces of the cage to start from could not be laid round the model: " +
              counted(report.outside, "place", "places") +
              " stayed outside or too near; its faces may cross there, or be too few: mend the "
              "cage by hand, or let a new one be made"};
}

} // namespace

Result<GeneratedCage> own_cage(TriangleView model, const GenerateOptions& options,
                               const Progress& progress) {
  const Result<UnitFrame> frame = unit_frame(model);
  if (!frame) {
    return frame.error();
  }
  Result<Prepared> prepared = prepare(*options.start);
  if (!prepared) {
    return prepared.error();
  }
  GeneratedCage made;
  Stopwatch watch(made.times);
  const auto in_unit = [&](TriangleView mesh) {
    TriangleMesh result;
    result.positions = to_unit(*frame, mesh.positions);
    result.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
    return result;
  };
  const ModelSurface surface(in_unit(model));
  const TriangleMesh& all = surface.mesh;
  PolygonMesh work = cut_to_quads(prepared->cage);
  work.positions = to_unit(*frame, work.positions);
  QuadCage cage(work);
  const QuadGuard guard(surface, options.clearance * surface.diagonal, {});

  const EncloseReport report = enclose(cage, guard, all, progress.part(0, enclosed));
  if (progress.cancelled()) {
    return Error::cancelled();
  }
  watch.lap("enclose");
  PolygonMesh& faces = prepared->cage;
  const auto check = [&](double from, double to) -> Result<ValidityReport> {
    for (std::size_t v = 0; v < faces.positions.size(); ++v) {
      faces.positions[v] = frame->from_unit(cage.positions()[v]);
    }
    return validate_cage(faces, model, {.first_only = true}, progress.part(from, to));
  };
  const std::vector<Vec3> fitted = cage.positions();
  if (report.encloses) {
    tighten(cage, guard, all, options, progress.part(enclosed, tightened));
    watch.lap("improve");
  }
  Result<ValidityReport> validity = check(tightened, 1);
  if (validity && !validity->valid()) {
    cage.set_positions(fitted);
    validity = check(tightened, 1);
  }
  if (!validity) {
    return validity.error();
  }
  if (!validity->valid()) {
    return report.encloses
               ? Error{ErrorCode::no_valid_cage,
                       "the cage to start from stayed invalid (" +
                           std::string(name_of(validity->violations.front().kind)) +
                           "): moving its vertices did not mend it; mend it by hand, or let a new "
                           "one be made"}
               : not_enclosed(report);
  }
  watch.lap("check");
  made.is_own = true;
  made.start_vertices = faces.positions.size();
  made.triangles = to_triangle_mesh(faces);
  made.clearance = report.encloses ? options.clearance : 0;
  if (!report.encloses) {
    add(made,
        {Reason::clearance_not_kept,
         "the cage encloses the model, but comes nearer to it than the clearance asked for", true,
         report.farthest ? std::optional(frame->from_unit(*report.farthest)) : std::nullopt});
  }
  if (!prepared->changes.empty()) {
    add(made, {Reason::start_changed, "of the cage given: " + prepared->changes, false, {}});
  }
  if (QuadReport quads = report_of(faces); quads.quads > 0) {
    made.quads = quads;
  }
  made.faces = std::move(faces);
  return made;
}

} // namespace cagewright
