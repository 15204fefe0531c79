#include "generate/report.h"

#include "cage_figures.h"
#include "json.h"
#include "plane_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace cagewright::cli {
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

nlohmann::json to_json(const BoxCage& made, const CageMetrics& metrics) {
  nlohmann::json j = to_json(made.boxes, made.leaves);
  j["registration"] = to_json(made.registration);
  j["cage"] = figures_as_json(metrics);
  j["cage"]["valid"] = true; // make_box_cage() returns no other
  if (made.faces.face_count() < made.cage.triangles.size()) {
    j["quads"] = to_json(report_of(made.faces));
  }
  j["times"] = to_json(made.times);
  return j;
}

namespace {

nlohmann::json symmetry_json(const BudgetCage& made) {
  nlohmann::json j = {{"mirrored", made.mirror.has_value()}, {"why_not", made.why_not_mirrored}};
  if (made.mirror) {
    const MirrorPairing& mirror = *made.mirror;
    j["plane"] = {{"normal", json_of(mirror.plane.normal)}, {"offset", mirror.plane.offset}};
    j["model_mean_error"] = mirror.plane.mean_error;
    j["model_high_error"] = mirror.plane.high_error;
    j["pairing_error"] = mirror.error;
    j["vertex_partners"] = mirror.vertex_partners;
    j["face_partners"] = mirror.face_partners;
  }
  return j;
}

std::string symmetry_line(const BudgetCage& made) {
  if (!made.mirror) {
    return made.why_not_mirrored.empty() ? "" : "  not mirrored: " + made.why_not_mirrored + "\n";
  }
  const MirrorPairing& mirror = *made.mirror;
  std::size_t on_plane = 0;
  for (std::size_t v = 0; v < mirror.vertex_partners.size(); ++v) {
    on_plane += mirror.vertex_partners[v] == v ? 1 : 0;
  }
  const std::size_t pairs = (mirror.vertex_partners.size() - on_plane) / 2;
  return fmt::format(
      "  mirrored in the plane {}: {} pairs of vertices, {} on it; {}\n", text_of(mirror.plane),
      pairs, on_plane,
      mirror.error == 0 ? "exact" : fmt::format("exact but for rounding, {:.2g}", mirror.error));
}

} // namespace

nlohmann::json to_json(const BudgetCage& made, const CageMetrics& metrics) {
  nlohmann::json j;
  if (made.boxes) {
    j = to_json(made.boxes->boxes, made.boxes->leaves);
    j["registration"] = to_json(made.boxes->registration);
  }
  j["format"] = "cagewright-generate";
  j["version"] = 1;
  j["start"] = {{"vertices", made.start_vertices},
                {"envelope_resolution", made.resolution},
                {"bridges", made.bridges}};
  j["budget"] = {{"reached", made.report.reached},
                 {"why_not", made.report.why_not},
                 {"clearance", made.clearance},
                 {"objective", made.report.objective},
                 {"clearance_asked", made.clearance_asked},
                 {"pieces", made.pieces},
                 {"joined", made.joined}};
  j["budget"]["gap"] = made.gap ? nlohmann::json(*made.gap) : nlohmann::json();
  j["cage"] = figures_as_json(metrics);
  j["cage"]["valid"] = true; // make_budget_cage() returns no other
  if (made.quads) {
    j["quads"] = to_json(*made.quads);
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

std::string summary(const BoxCage& made, const CageMetrics& metrics) {
  return "a valid cage\n" + boxes_line(made.boxes, made.leaves.size()) +
         fmt::format("  {} pairs of neighbouring boxes joined at a common quad\n",
                     made.registration.joints.size()) +
         (made.faces.face_count() < made.cage.triangles.size() ? quads_line(report_of(made.faces))
                                                               : std::string()) +
         figures_as_text(metrics) + times_line(made.times);
}

std::string summary(const BudgetCage& made, const CageMetrics& metrics) {
  std::string text = made.report.reached
                         ? "a valid cage\n"
                         : "a valid cage, but not as asked for: " + made.report.why_not + "\n";
  if (made.boxes) {
    text += fmt::format("  made from {} boxes, {} vertices\n", made.boxes->leaves.size(),
                        made.start_vertices);
  } else if (made.resolution > 0) {
    text += fmt::format("  made from an envelope of {} voxels along the diagonal, {} vertices\n",
                        made.resolution, made.start_vertices);
  }
  if (made.bridges > 0) {
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
  if (!made.why_not_boxes.empty()) {
    text += "  not made from boxes: " + made.why_not_boxes + "\n";
  }
  text += symmetry_line(made);
  text += made.quads ? quads_line(*made.quads) : std::string();
  if (!made.limb_rings.empty()) {
    text += fmt::format("  rings of edges round limbs: {}\n", made.limb_rings.size());
  }
  if (made.clearance < made.clearance_asked) {
    text += fmt::format("  the boxes came nearer than the clearance asked for: {:.4f} % of the "
                        "diagonal was kept, not {:.4f} %\n",
                        100 * made.clearance, 100 * made.clearance_asked);
  }
  if (made.gap) {
    text += fmt::format("  no point of the cage is farther than {:.4f} % of the diagonal from the "
                        "model (proved)\n",
                        100 * *made.gap);
  }
  return text + figures_as_text(metrics) + times_line(made.times);
}

} // namespace cagewright::cli
