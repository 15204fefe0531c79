#include "report/cage_report.h"

#include "report/cage_figures.h"
#include "report/json.h"
#include "report/plane_text.h"

#include "cage/box_cage.h"
#include <cagewright/cage/option_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace cagewright {
namespace {

/// Lengths and areas of a box's cross-sections, from voxels to the model's unit.
nlohmann::json to_json(const CrossSection& section, double voxel) {
  const auto areas = [&](const std::vector<double>& f) {
    std::vector<double> scaled(f);
    for (double& area : scaled) {
      area *= voxel * voxel;
    }
    return scaled;
  };
  return {{"axis", section.axis},
          {"first", section.first * voxel},
          {"step", section.step * voxel},
          {"f", areas(section.area)},
          {"f_smooth", areas(section.smooth)}};
}

nlohmann::json to_json(const Cut& cut, const BoxDecomposition& boxes) {
  return {{"axis", cut.plane.axis},
          {"offset", cut.plane.offset * boxes.voxel_size()},
          {"point", json_of(boxes.to_model(cut.point))},
          {"normal", json_of(Vec3(boxes.grid.axes * cut.normal))},
          {"jump", cut.jump},
          {"gain", cut.gain},
          {"middle", cut.middle}};
}

nlohmann::json to_json(const BoxNode& node, int index, const BoxDecomposition& boxes) {
  nlohmann::json j = json_of(boxes.to_model(node.box));
  j["node"] = index;
  j["parent"] = node.parent;
  j["depth"] = node.depth;
  j["children"] = node.children;
  j["voxels"] = node.voxels.size();
  j["stop"] = name_of(node.stop);
  j["T1"] = node.prismatic_ratio;
  j["T2"] = node.cube_ratio;
  j["cross_sections"] = nlohmann::json::array();
  for (const CrossSection& section : node.sections) {
    j["cross_sections"].push_back(to_json(section, boxes.voxel_size()));
  }
  j["cut"] = node.cut ? to_json(*node.cut, boxes) : nlohmann::json();
  return j;
}

nlohmann::json to_json(const std::vector<StageTime>& times) {
  nlohmann::json j = nlohmann::json::array();
  for (const StageTime& time : times) {
    j.push_back({{"stage", time.stage}, {"seconds", time.seconds}});
  }
  return j;
}

nlohmann::json to_json(const Registration& registration) {
  nlohmann::json j;
  j["joints"] = registration.joints.size();
  for (int verdict = 0; verdict < joint_verdicts; ++verdict) {
    j["pairs_of_faces"][std::string(name_of(static_cast<JointVerdict>(verdict)))] =
        registration.verdicts[static_cast<std::size_t>(verdict)];
  }
  return j;
}

int cuts_in(const BoxTree& tree) {
  return static_cast<int>(std::count_if(tree.nodes.begin(), tree.nodes.end(),
                                        [](const BoxNode& node) { return node.cut.has_value(); }));
}

std::string times_line(const std::vector<StageTime>& times) {
  std::string line = "  time: ";
  double total = 0;
  for (const StageTime& time : times) {
    line += fmt::format("{} {:.2f} s, ", time.stage, time.seconds);
    total += time.seconds;
  }
  return line + fmt::format("together {:.2f} s\n", total);
}

std::string boxes_line(const BoxDecomposition& boxes, std::size_t count) {
  return fmt::format("  {} boxes by {} cuts{}\n", count, cuts_in(boxes.tree),
                     boxes.bridges > 0
                         ? fmt::format("; bridges between pieces of the model: {}", boxes.bridges)
                         : "");
}

nlohmann::json to_json(const QuadReport& quads) {
  return {{"quads", quads.quads},
          {"triangles", quads.triangles},
          {"share", quads.share},
          {"max_bend_degrees", quads.max_bend_degrees},
          {"min_angle_degrees", quads.min_angle_degrees},
          {"max_angle_degrees", quads.max_angle_degrees},
          {"rings", quads.rings},
          {"loops", quads.loops}};
}

std::string quads_line(const QuadReport& quads) {
  return fmt::format("  {} quads and {} triangles: {:.0f} % quads, bent by up to {:.0f} degrees; "
                     "closed strips of quads: {}, closed loops of edges: {}\n",
                     quads.quads, quads.triangles, 100 * quads.share, quads.max_bend_degrees,
                     quads.rings, quads.loops);
}

} // namespace

nlohmann::json to_json(const BoxDecomposition& boxes, const std::vector<int>& cover) {
  nlohmann::json j;
  j["format"] = "cagewright-generate";
  j["version"] = 1;
  j["diagonal"] = boxes.frame.diagonal;
  j["voxels"] = {{"size", boxes.voxel_size()},
                 {"dims", boxes.grid.dims},
                 {"feature", boxes.grid.count(VoxelKind::feature)},
                 {"inner", boxes.grid.count(VoxelKind::inner)},
                 {"bridges", boxes.bridges}};
  j["tree"] = nlohmann::json::array();
  for (std::size_t at = 0; at < boxes.tree.nodes.size(); ++at) {
    j["tree"].push_back(to_json(boxes.tree.nodes[at], static_cast<int>(at), boxes));
  }
  j["boxes"] = cover;
  j["times"] = to_json(boxes.times);
  return j;
}

namespace {

std::string message_of(const GeneratedCage& made, Reason reason) {
  const Remark* const found = made.find(reason);
  return found == nullptr ? "" : found->message;
}

nlohmann::json symmetry_json(const GeneratedCage& made) {
  nlohmann::json j = {{"mirrored", made.mirror.has_value()},
                      {"why_not", message_of(made, Reason::not_mirrored)}};
  if (made.mirror) {
    const MirrorPairing& mirror = *made.mirror;
    j["in_plane"] = mirror.in_plane;
    j["plane"] = {{"normal", json_of(mirror.plane.normal)}, {"offset", mirror.plane.offset}};
    if (mirror.in_plane) {
      j["model_mean_error"] = mirror.plane.mean_error;
      j["model_high_error"] = mirror.plane.high_error;
    }
    j["pairing_error"] = mirror.error;
    j["vertex_partners"] = mirror.vertex_partners;
    j["face_partners"] = mirror.face_partners;
  }
  return j;
}

std::string symmetry_line(const GeneratedCage& made) {
  if (!made.mirror) {
    const std::string why_not = message_of(made, Reason::not_mirrored);
    return why_not.empty() ? "" : "  not mirrored: " + why_not + "\n";
  }
  const MirrorPairing& mirror = *made.mirror;
  std::size_t on_plane = 0;
  for (std::size_t v = 0; v < mirror.vertex_partners.size(); ++v) {
    on_plane += mirror.vertex_partners[v] == v ? 1 : 0;
  }
  const std::size_t pairs = (mirror.vertex_partners.size() - on_plane) / 2;
  if (!mirror.in_plane) {
    return fmt::format("  paired left to right, in the model's pose: {} pairs of vertices, {} in "
                       "the middle\n",
                       pairs, on_plane);
  }
  return fmt::format(
      "  mirrored in the plane {}: {} pairs of vertices, {} on it; {}\n", text_of(mirror.plane),
      pairs, on_plane,
      mirror.error == 0 ? "exact" : fmt::format("exact but for rounding, {:.2g}", mirror.error));
}

nlohmann::json to_json(const GenerateOptions& options) {
  nlohmann::json j;
  for (const CageOption& option : cage_options()) {
    nlohmann::json& value = j[std::string(option.name)];
    if (const auto* integer = std::get_if<IntegerOption>(&option.kind)) {
      value = integer->get(options);
    } else if (const auto* number = std::get_if<NumberOption>(&option.kind)) {
      value = options.*number->member;
    } else {
      value = text_of(option, options);
    }
  }
  j["density"] = options.density.empty() ? "even" : "given";
  j["joints"] = options.joints.size();
  return j;
}

nlohmann::json to_json(const std::vector<Remark>& remarks) {
  nlohmann::json j = nlohmann::json::array();
  for (const Remark& remark : remarks) {
    j.push_back({{"reason", name_of(remark.reason)},
                 {"message", remark.message},
                 {"shortfall", remark.is_shortfall}});
  }
  return j;
}

std::string method_name(Method method) {
  GenerateOptions options;
  options.method = method;
  return text_of(*find_cage_option("method"), options);
}

} // namespace

nlohmann::json to_json(const GeneratedCage& made, const GenerateOptions& options) {
  nlohmann::json j;
  if (made.box_tree) {
    j = to_json(made.box_tree->boxes, made.box_tree->leaves);
    j["registration"] = to_json(made.box_tree->registration);
  }
  j["format"] = "cagewright-generate";
  j["version"] = 1;
  j["options"] = to_json(options);
  j["method"] = made.is_own ? "start" : method_name(made.method);
  j["start"] = {{"vertices", made.start_vertices},
                {"envelope_resolution", made.resolution},
                {"bridges", made.bridges}};
  j["budget"] = {{"reached", made.is_as_asked()},
                 {"why_not", made.is_as_asked() ? "" : made.remarks.front().message},
                 {"clearance", made.clearance},
                 {"objective", made.objective},
                 {"clearance_asked", options.method == Method::boxes ? 0 : options.clearance},
                 {"pieces", made.pieces},
                 {"joined", made.joined}};
  j["budget"]["gap"] = made.gap ? nlohmann::json(*made.gap) : nlohmann::json();
  j["remarks"] = to_json(made.remarks);
  j["cage"] = figures_as_json(made.figures);
  j["cage"]["valid"] = true; // generate() returns no other
  if (made.quads) {
    j["quads"] = to_json(*made.quads);
  }
  if (made.quads || !made.limb_rings.empty()) {
    j["limb_rings"] = made.limb_rings;
  }
  j["symmetry"] = symmetry_json(made);
  j["times"] = to_json(made.times);
  return j;
}

std::string summary(const BoxDecomposition& boxes, const std::vector<int>& cover) {
  return fmt::format("{} voxels ({} on the surface, {} inside)\n",
                     boxes.grid.count(VoxelKind::feature) + boxes.grid.count(VoxelKind::inner),
                     boxes.grid.count(VoxelKind::feature), boxes.grid.count(VoxelKind::inner)) +
         boxes_line(boxes, cover.size()) + times_line(boxes.times);
}

std::string summary(const GeneratedCage& made, const GenerateOptions& options) {
  std::string text =
      made.is_as_asked()
          ? "a valid cage\n"
          : "a valid cage, but not as asked for: " + made.remarks.front().message + "\n";
  if (made.method == Method::boxes) {
    text += boxes_line(made.box_tree->boxes, made.boxes.size());
    text += fmt::format("  {} pairs of neighbouring boxes joined at a common quad\n",
                        made.box_tree->registration.joints.size());
  } else if (made.box_tree) {
    text +=
        fmt::format("  made from {} boxes, {} vertices\n", made.boxes.size(), made.start_vertices);
  } else if (made.resolution > 0) {
    text += fmt::format("  made from an envelope of {} voxels along the diagonal, {} vertices\n",
                        made.resolution, made.start_vertices);
  }
  if (made.is_own) {
    text += fmt::format("  made from the cage given, of {} vertices\n", made.start_vertices);
  }
  if (made.bridges > 0 && made.method != Method::boxes) {
    text += fmt::format("  bridges between pieces of the model: {}\n", made.bridges);
  }
  if (made.pieces > 1 || made.joined > 0) {
    text += fmt::format("  {} closed pieces\n", made.pieces);
  }
  if (made.joined > 0) {
    text += fmt::format("  groups of pieces that share a cage with others: {} (their own would "
                        "meet, lie within another, or be too small for the budget)\n",
                        made.joined);
  }
  if (const std::string why_not = message_of(made, Reason::boxes_not_possible); !why_not.empty()) {
    text += "  not made from boxes: " + why_not + "\n";
  }
  text += symmetry_line(made);
  text += made.quads ? quads_line(*made.quads) : std::string();
  if (!made.limb_rings.empty()) {
    text += fmt::format("  rings of edges round limbs: {}\n", made.limb_rings.size());
  }
  for (const Reason reason : {Reason::specks_ignored, Reason::openings_closed}) {
    const std::string done = message_of(made, reason);
    text += done.empty() ? "" : "  " + done + "\n";
  }
  if (const std::string changed = message_of(made, Reason::start_changed); !changed.empty()) {
    text += "  " + changed + "\n";
  }
  if (!made.is_own && !message_of(made, Reason::clearance_not_kept).empty()) {
    text += fmt::format("  the boxes came nearer than the clearance asked for: {:.4f} % of the "
                        "diagonal was kept, not {:.4f} %\n",
                        100 * made.clearance, 100 * options.clearance);
  }
  if (made.gap) {
    text += fmt::format("  no point of the cage is farther than {:.4f} % of the diagonal from the "
                        "model (proved)\n",
                        100 * *made.gap);
  }
  return text + figures_as_text(made.figures) + times_line(made.times);
}

} // namespace cagewright
