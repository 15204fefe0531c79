#include "report/cage_words.h"

#include "io/source.h"
#include <cagewright/validate/fit.h>

#include <fmt/format.h>

#include <optional>
#include <string_view>

namespace cagewright {
namespace {

/// What the elements of a violation are, in words.
struct Wording {
  const char* one;    // after a count of 1
  const char* many;   // after other counts
  const char* first;  // before the first element
  const char* second; // before the second, if there is one
  const char* remedy; // {0}: the cage, {1}: the model
};

constexpr const char* mend_by_hand = "mend the cage there in a modelling program";
constexpr const char* cut_faces =
    "cut it into triangles: cagewright weld {0} triangles.obj --triangulate";

Wording wording_of(ViolationKind kind) {
  switch (kind) {
  case ViolationKind::no_faces:
    return {"reason: the cage has no usable face", "reasons: the cage has no usable face", "", "",
            "export the cage as a mesh with faces"};
  case ViolationKind::bad_corner:
    return {"face with fewer than three corners, or corners that are no vertices",
            "faces with fewer than three corners, or corners that are no vertices", "face", "",
            "export the cage again"};
  case ViolationKind::not_finite:
    return {"cage vertex whose position is not a number",
            "cage vertices whose position is not a number", "vertex", "", "export the cage again"};
  case ViolationKind::unused_vertex:
    return {"cage vertex that no face uses", "cage vertices that no face uses", "vertex", "",
            "leave them out: cagewright weld {0} welded.obj"};
  case ViolationKind::coincident_vertices:
    return {"cage vertex on top of another", "cage vertices on top of another", "vertices", "and",
            "merge them: cagewright weld {0} welded.obj"};
  case ViolationKind::degenerate_face:
    return {"degenerate cage face", "degenerate cage faces", "face", "",
            "move a corner off the line of the others, or leave out faces that name a vertex "
            "twice: cagewright weld {0} welded.obj"};
  case ViolationKind::folded_face:
    return {"cage face that is concave or crosses itself: cut along its other diagonal it folds "
            "over",
            "cage faces that are concave or cross themselves: cut along their other diagonal they "
            "fold over",
            "face", "", cut_faces};
  case ViolationKind::duplicate_face:
    return {"cage face that repeats an earlier one", "cage faces that repeat an earlier one",
            "face", "", "delete one of the two in a modelling program"};
  case ViolationKind::open_edge:
    return {"open edge", "open edges", "edge", "-", "fill the holes in a modelling program"};
  case ViolationKind::t_junction:
    return {"vertex on an edge of a face that does not have it (T-junction)",
            "vertices on edges of faces that do not have them (T-junctions)", "vertex",
            "on an edge of face",
            "give the face a corner there (knife or connect in a modelling program), or dissolve "
            "the vertex"};
  case ViolationKind::nonmanifold_edge:
    return {"edge of more than two faces", "edges of more than two faces", "edge", "-",
            "delete the inner faces in a modelling program"};
  case ViolationKind::flipped_edge:
    return {"edge between faces of opposite orientation",
            "edges between faces of opposite orientation", "edge", "-",
            "make the normals consistent in a modelling program"};
  case ViolationKind::nonmanifold_vertex:
    return {"vertex where the cage touches itself in a point",
            "vertices where the cage touches itself in a point", "vertex", "",
            "split the vertex and move the two apart"};
  case ViolationKind::self_intersection:
    return {"pair of cage faces that cross or touch", "pairs of cage faces that cross or touch",
            "faces", "and", "move the faces apart in a modelling program"};
  case ViolationKind::inverted_piece:
    return {"closed piece oriented the wrong way", "closed pieces oriented the wrong way",
            "piece with face", "",
            "flip the normals of the piece in a modelling program (inner shells look inward, all "
            "others outward)"};
  case ViolationKind::several_pieces:
    return {"piece too many", "pieces too many", "piece with face", "",
            "join the pieces, or accept them: cagewright check {1} {0} --allow-pieces"};
  case ViolationKind::nested_piece:
    return {"inner shell: a closed piece within another",
            "inner shells: closed pieces within another", "piece with face", "",
            "delete the inner pieces, or accept them where they are oriented inward: cagewright "
            "check {1} {0} --allow-inner-shells"};
  case ViolationKind::vertex_outside:
    return {"model vertex outside the cage", "model vertices outside the cage", "model vertex", "",
            "move the cage outward there, or make one: cagewright generate {1} -o new_cage.obj "
            "--vertices 100"};
  case ViolationKind::vertex_on_cage:
    return {"model vertex on the cage", "model vertices on the cage", "model vertex",
            "on cage face", "move the cage outward there; write it with more decimals"};
  case ViolationKind::face_contact:
    return {"contact of model faces and cage faces", "contacts of model faces and cage faces",
            "model face", "and cage face",
            "move the cage outward there; write it with more decimals"};
  }
  return {"", "", "", "", mend_by_hand}; // no default: the compiler points here
}

/// A file's name as a shell takes it.
std::string quoted(const std::string& path) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                     "0123456789._-/+,=@%";
  if (!path.empty() && path.find_first_not_of(plain) == std::string::npos && path[0] != '-') {
    return path;
  }
  std::string text = path.starts_with('-') ? "'./" : "'";
  for (const char c : path) {
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return text + "'";
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::optional<FileNote> size_hint(const ValidityReport& report, const PolygonMesh& cage,
                                  TriangleView model, const JudgedFiles& files) {
  const double size = relative_size(cage, model);
  // A valid cage may be wide on purpose; of this size hardly.
  constexpr double suspicious = 8;
  const bool is_beside = report.count(ViolationKind::vertex_outside) > 0;
  if (!is_beside && size < suspicious) {
    return std::nullopt;
  }
  const std::string name = one_line(files.cage);
  if (const std::optional<CageFit> fit = fit_cage(cage, model)) {
    return FileNote{"cage_elsewhere",
                    fmt::format("{}: this cage would fit the model if it were {}; do that with: "
                                "cagewright weld {} fitted.obj --fit {}",
                                name, fit->description, quoted(files.cage), quoted(files.model))};
  }
  if (!is_beside) {
    return FileNote{"cage_far_too_large",
                    fmt::format("{}: the cage is {:.3g} times as large as the model; is it in "
                                "another unit?",
                                name, size)};
  }
  return std::nullopt;
}

} // namespace

std::string headline(ViolationKind kind, std::size_t count) {
  const Wording wording = wording_of(kind);
  return counted(count, wording.one, wording.many);
}

std::string describe(const Violation& violation) {
  const Wording wording = wording_of(violation.kind);
  std::string text;
  if (violation.elements[0] != Violation::none) {
    text += fmt::format("{} {}", wording.first, violation.elements[0]);
  }
  if (violation.elements[1] != Violation::none) {
    text += fmt::format(" {} {}", wording.second, violation.elements[1]);
  }
  if (!text.empty() && violation.kind != ViolationKind::bad_corner) {
    text += fmt::format("  at ({}, {}, {})", violation.place.x(), violation.place.y(),
                        violation.place.z());
  }
  return text;
}

std::string remedy(ViolationKind kind, const JudgedFiles& files) {
  return fmt::format(fmt::runtime(wording_of(kind).remedy), quoted(files.cage),
                     quoted(files.model));
}

const std::string& file_of(ViolationKind kind, const JudgedFiles& files) {
  switch (kind) {
  case ViolationKind::vertex_outside:
  case ViolationKind::vertex_on_cage:
  case ViolationKind::face_contact:
    return files.model;
  default:
    return files.cage;
  }
}

std::string not_valid_in_words(const ValidityReport& report, const JudgedFiles& files) {
  std::string list;
  for (std::size_t k = 0; k < violation_kinds; ++k) {
    if (report.counts[k] > 0) {
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", report.counts[k],
                          name_of(static_cast<ViolationKind>(k)));
    }
  }
  return fmt::format("{}: not a valid cage of this model: {} ('cagewright check' says where)",
                     files.cage, list);
}

std::vector<FileNote> hints(const ValidityReport& report, const PolygonMesh& cage,
                            TriangleView model, const JudgedFiles& files) {
  std::vector<FileNote> notes;
  const std::string name = one_line(files.cage);
  if (report.merged_vertices > 0) {
    notes.push_back(
        {"split_vertices",
         fmt::format("{}: {} at the position of another {} judged merged with it, as exporters "
                     "split vertices; merge them for good with: cagewright weld {} welded.obj",
                     name, counted(report.merged_vertices, "vertex", "vertices"),
                     report.merged_vertices == 1 ? "is" : "are", quoted(files.cage))});
  }
  if (report.loose_vertices > 0) {
    notes.push_back({"loose_cage_vertices",
                     fmt::format("{}: {} that no face uses {} left out; remove them for good with: "
                                 "cagewright weld {} welded.obj",
                                 name, counted(report.loose_vertices, "vertex", "vertices"),
                                 report.loose_vertices == 1 ? "is" : "are", quoted(files.cage))});
  }
  if (report.loose_model_vertices > 0) {
    notes.push_back(
        {"loose_model_vertices",
         fmt::format("{}: {} that no face uses {} not judged; leave them out with: "
                     "cagewright weld {} welded.obj",
                     one_line(files.model),
                     counted(report.loose_model_vertices, "vertex", "vertices"),
                     report.loose_model_vertices == 1 ? "is" : "are", quoted(files.model))});
  }
  if (const std::optional<FileNote> size = size_hint(report, cage, model, files)) {
    notes.push_back(*size);
  }
  return notes;
}

} // namespace cagewright
