#include "app/document/generate_settings.h"

#include <QObject>

#include <algorithm>

namespace cagewright::app {
namespace {

using Group = GenerateOption::Group;

bool always(const GenerateSettings& /*s*/) {
  return true;
}
bool with_budget(const GenerateSettings& s) {
  return s.method != CageMethod::union_of_boxes;
}
bool with_boxes(const GenerateSettings& s) {
  return s.method != CageMethod::envelope;
}
bool with_envelope(const GenerateSettings& s) {
  return s.method == CageMethod::envelope;
}
bool with_density_file(const GenerateSettings& s) {
  return with_budget(s) && s.density == DensitySource::file;
}

SlicingOptions& slicing(GenerateSettings& s) {
  return s.options.boxes.boxes.slicing;
}
const SlicingOptions& slicing(const GenerateSettings& s) {
  return s.options.boxes.boxes.slicing;
}

bool by_volume(const GenerateSettings& s) {
  return slicing(s).rule == SlicingRule::volume;
}
bool by_jumps(const GenerateSettings& s) {
  return slicing(s).rule == SlicingRule::published;
}

QString text(const char* english) {
  return QObject::tr(english);
}

std::vector<GenerateOption> basic_options() {
  return {
      {"method", text("Method"),
       text("What the cage is made from. Envelope: a tight skin of voxels, for any shape; the best "
            "choice for editing. Boxes: oriented boxes along the limbs, improved within the "
            "budget. Union of boxes: these boxes as they are, to study the method."),
       Group::basic,
       GenerateOption::Choice{{"envelope", "obb", "boxes"},
                              {text("Envelope"), text("Boxes, improved"), text("Union of boxes")},
                              [](const GenerateSettings& s) { return static_cast<int>(s.method); },
                              [](GenerateSettings& s, int i) {
                                s.method = static_cast<CageMethod>(i);
                                s.options.start = s.method == CageMethod::envelope
                                                      ? CageStart::envelope
                                                      : CageStart::obb;
                              }},
       always},
      {"vertices", text("Vertices"),
       text("The cage gets at most so many vertices. 50 to 150 are easy to edit by hand; more "
            "follow the model more closely."),
       Group::basic,
       GenerateOption::Integer{
           0, 100000, [](GenerateSettings& s) -> int& { return s.options.improve.vertices; },
           text("no limit")},
       with_budget},
      {"quads", text("Faces"),
       text("Quads are easier to select in loops and rings; triangles fit more closely. The cage "
            "is valid along both diagonals of each quad."),
       Group::basic,
       GenerateOption::Choice{
           {"off", "on"},
           {text("Triangles"), text("Quads where they can be")},
           [](const GenerateSettings& s) { return s.options.quads ? 1 : 0; },
           [](GenerateSettings& s, int i) { s.options.quads = s.options.boxes.quads = i == 1; }},
       always},
      {"depth", text("Depth"),
       text("How often a part of the model may be cut in two: more cuts, more and smaller boxes. "
            "Also how deep the splitting is shown."),
       Group::basic,
       GenerateOption::Integer{
           0, 12, [](GenerateSettings& s) -> int& { return slicing(s).depth; }, {}},
       always},
      {"symmetry", text("Symmetry"),
       text("Whether the cage is its own mirror image. Automatic: if the model is, in any plane."),
       Group::basic,
       GenerateOption::Choice{
           {"off", "auto", "x", "y", "z"},
           {text("Off"), text("Automatic"), text("Across X"), text("Across Y"), text("Across Z")},
           [](const GenerateSettings& s) { return static_cast<int>(s.options.symmetry); },
           [](GenerateSettings& s, int i) {
             s.options.symmetry = static_cast<cagewright::Symmetry>(i);
           }},
       with_budget},
  };
}

std::vector<GenerateOption> budget_options() {
  return {
      {"clearance", text("Clearance"),
       text("Least distance between cage and model, as a fraction of the model's diagonal."),
       Group::budget,
       GenerateOption::Number{
           1e-6, 0.5, 0.001, 5,
           [](GenerateSettings& s) -> double& { return s.options.improve.clearance; }},
       with_budget},
      {"faces", text("Most triangles"), text("The cage gets at most so many triangles, too."),
       Group::budget,
       GenerateOption::Integer{0, 200000,
                               [](GenerateSettings& s) -> int& { return s.options.improve.faces; },
                               text("no limit")},
       with_budget},
      {"max-gap", text("Greatest gap"),
       text("The coarsest cage no point of which is farther from the model than this fraction of "
            "its diagonal, proved. Vertices and triangles are then limits only."),
       Group::budget,
       GenerateOption::Number{0, 0.5, 0.005, 4,
                              [](GenerateSettings& s) -> double& { return s.options.max_gap; },
                              text("as the vertices allow")},
       with_budget},
      {"density", text("Finer where"),
       text("Where the cage gets more vertices. Painted: where vertex colors are red, and fewer "
            "where they are blue. File: one number for each vertex of the model; four times as "
            "much makes edges half as long."),
       Group::budget,
       GenerateOption::Choice{
           {"even", "colors", "file"},
           {text("Even"), text("Painted red"), text("A file says")},
           [](const GenerateSettings& s) { return static_cast<int>(s.density); },
           [](GenerateSettings& s, int i) { s.density = static_cast<DensitySource>(i); }},
       with_budget},
      {"density-file", text("Density file"),
       text("Text with one number to a line, or a NumPy array, in the order of the vertices."),
       Group::budget,
       GenerateOption::File{text("Numbers (*.txt *.csv *.dat *.npy);;All files (*)"),
                            [](GenerateSettings& s) -> QString& { return s.density_file; }},
       with_density_file},
      {"pieces", text("Separate pieces"),
       text("A model in several pieces gets one cage with thin bridges, or a closed piece of cage "
            "for each."),
       Group::budget,
       GenerateOption::Choice{
           {"together", "apart"},
           {text("One cage"), text("A cage each")},
           [](const GenerateSettings& s) { return static_cast<int>(s.options.boxes.boxes.pieces); },
           [](GenerateSettings& s, int i) {
             s.options.boxes.boxes.pieces = static_cast<Pieces>(i);
           }},
       always},
  };
}

std::vector<GenerateOption> envelope_options() {
  return {
      {"closing", text("Closing"),
       text("Holes and gaps narrower than twice this fraction of the diagonal are filled before "
            "the envelope is made."),
       Group::envelope,
       GenerateOption::Number{0, 0.5, 0.005, 4,
                              [](GenerateSettings& s) -> double& { return s.options.closing; }},
       with_envelope},
      {"envelope-resolution", text("Envelope resolution"),
       text("Voxels along the model's diagonal; finer envelopes follow narrow gaps and take "
            "longer."),
       Group::envelope,
       GenerateOption::Integer{0, 512,
                               [](GenerateSettings& s) -> int& { return s.options.resolution; },
                               text("automatic")},
       with_envelope},
  };
}

std::vector<GenerateOption> box_options() {
  return {
      {"slicing", text("Slicing rule"),
       text("Where a box is cut. Volume: where the boxes of the parts get smallest. Published: at "
            "the greatest jump of the cross-section (Xian, Lin and Gao 2012)."),
       Group::boxes,
       GenerateOption::Choice{
           {"volume", "published"},
           {text("Volume"), text("Published")},
           [](const GenerateSettings& s) { return static_cast<int>(slicing(s).rule); },
           [](GenerateSettings& s, int i) { slicing(s).rule = static_cast<SlicingRule>(i); }},
       always},
      {"resolution", text("Resolution"),
       text("Voxels along the longest axis of the model's box, from which the boxes are made."),
       Group::boxes,
       GenerateOption::Integer{
           8,
           512,
           [](GenerateSettings& s) -> int& { return s.options.boxes.boxes.resolution; },
           {}},
       always},
      {"boxes", text("Most boxes"),
       text("Stop at so many boxes, cutting first where it pays most."), Group::boxes,
       GenerateOption::Integer{0, 100000,
                               [](GenerateSettings& s) -> int& { return slicing(s).max_boxes; },
                               text("no limit")},
       always},
      {"eta", text("Eta (T1)"),
       text("A box is left whole when its least cross-section divided by its greatest is above "
            "this, and zeta holds too. Above 1: never."),
       Group::boxes,
       GenerateOption::Number{0.01, 2, 0.05, 3,
                              [](GenerateSettings& s) -> double& { return slicing(s).eta; }},
       always},
      {"zeta", text("Zeta (T2)"),
       text("A box is left whole when its shortest edge divided by its longest is above this, and "
            "eta holds too. Above 1: never."),
       Group::boxes,
       GenerateOption::Number{0.01, 2, 0.05, 3,
                              [](GenerateSettings& s) -> double& { return slicing(s).zeta; }},
       always},
      {"min-gain", text("Least gain"),
       text("Volume rule: a cut must save this fraction of the box's volume."), Group::boxes,
       GenerateOption::Number{0, 1, 0.005, 4,
                              [](GenerateSettings& s) -> double& { return slicing(s).min_gain; }},
       by_volume},
      {"min-jump", text("Least jump"),
       text("Published rule: a jump lower than this fraction of the greatest cross-section is not "
            "clear."),
       Group::boxes,
       GenerateOption::Number{0, 1, 0.05, 3,
                              [](GenerateSettings& s) -> double& { return slicing(s).min_jump; }},
       by_jumps},
      {"no-jump", text("Without a jump"),
       text("Published rule: what becomes of a box in which no axis has a clear jump."),
       Group::boxes,
       GenerateOption::Choice{
           {"skip", "middle"},
           {text("Leave it whole"), text("Cut in the middle")},
           [](const GenerateSettings& s) { return static_cast<int>(slicing(s).no_jump); },
           [](GenerateSettings& s, int i) { slicing(s).no_jump = static_cast<NoJump>(i); }},
       by_jumps},
      {"split", text("Split"),
       text("Whether each connected part of a half gets a box of its own, or each half one."),
       Group::boxes,
       GenerateOption::Choice{
           {"parts", "binary"},
           {text("Connected parts"), text("Halves")},
           [](const GenerateSettings& s) { return slicing(s).split_parts ? 0 : 1; },
           [](GenerateSettings& s, int i) { slicing(s).split_parts = i == 0; }},
       always},
      {"registration", text("Join faces"),
       text("Faces of neighboring boxes are joined where they fit, so that the union has fewer "
            "slivers."),
       Group::boxes,
       GenerateOption::Choice{
           {"off", "on"},
           {text("No"), text("Yes")},
           [](const GenerateSettings& s) { return s.options.boxes.registration ? 1 : 0; },
           [](GenerateSettings& s, int i) { s.options.boxes.registration = i == 1; }},
       with_boxes},
  };
}

} // namespace

const std::vector<GenerateOption>& generate_options() {
  static const std::vector<GenerateOption> options = [] {
    std::vector<GenerateOption> all = basic_options();
    for (const auto& part : {budget_options(), envelope_options(), box_options()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
    return all;
  }();
  return options;
}

QJsonObject to_json(const GenerateSettings& settings) {
  GenerateSettings copy = settings; // the accessors give references that may be written to
  QJsonObject json;
  for (const GenerateOption& option : generate_options()) {
    if (const auto* integer = std::get_if<GenerateOption::Integer>(&option.kind)) {
      json[option.key] = integer->value(copy);
    } else if (const auto* number = std::get_if<GenerateOption::Number>(&option.kind)) {
      json[option.key] = number->value(copy);
    } else if (const auto* file = std::get_if<GenerateOption::File>(&option.kind)) {
      json[option.key] = file->value(copy);
    } else {
      const auto& choice = std::get<GenerateOption::Choice>(option.kind);
      json[option.key] = choice.keys[choice.get(copy)];
    }
  }
  return json;
}

GenerateSettings generate_settings_from_json(const QJsonObject& json) {
  GenerateSettings settings;
  for (const GenerateOption& option : generate_options()) {
    const QJsonValue value = json[option.key];
    if (const auto* integer = std::get_if<GenerateOption::Integer>(&option.kind)) {
      int& kept = integer->value(settings);
      kept = std::clamp(value.toInt(kept), integer->least, integer->most);
    } else if (const auto* number = std::get_if<GenerateOption::Number>(&option.kind)) {
      double& kept = number->value(settings);
      kept = std::clamp(value.toDouble(kept), number->least, number->most);
    } else if (const auto* file = std::get_if<GenerateOption::File>(&option.kind)) {
      file->value(settings) = value.toString();
    } else {
      const auto& choice = std::get<GenerateOption::Choice>(option.kind);
      if (const auto at = choice.keys.indexOf(value.toString()); at >= 0) {
        choice.set(settings, static_cast<int>(at));
      }
    }
  }
  return settings;
}

} // namespace cagewright::app
