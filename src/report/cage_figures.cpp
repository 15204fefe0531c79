#include "report/cage_figures.h"

#include <fmt/format.h>

namespace cagewright {
namespace {

std::string volume_ratio_text(const CageMetrics& metrics) {
  if (!(metrics.model_volume > 0)) {
    return "; the model encloses no volume\n";
  }
  switch (metrics.model_volume_method) {
  case VolumeMethod::none:
  case VolumeMethod::exact:
    return fmt::format(", {:.3f} times the model's\n", metrics.volume_ratio);
  case VolumeMethod::sampled:
    return fmt::format(", {:.3f} times what the model encloses (it is open: sampled)\n",
                       metrics.volume_ratio);
  case VolumeMethod::enclosed:
    return fmt::format(", {:.3f} times what the model encloses (its parts overlap, double or "
                       "enclose others: sampled)\n",
                       metrics.volume_ratio);
  }
  return "\n"; // no default above: the compiler points here when a method is added
}

} // namespace

nlohmann::json figures_as_json(const CageMetrics& metrics) {
  return {{"vertices", metrics.vertices},
          {"faces", metrics.faces},
          {"volume", metrics.volume},
          {"model_volume", metrics.model_volume},
          {"model_volume_method", name_of(metrics.model_volume_method)},
          {"volume_ratio", metrics.volume_ratio},
          {"clearance", metrics.clearance},
          {"mean_distance", metrics.mean_distance},
          {"max_distance", metrics.max_distance},
          {"webbing", metrics.webbing},
          {"min_quality", metrics.min_quality},
          {"low_quality", metrics.low_quality},
          {"max_valence", metrics.max_valence},
          {"min_dihedral", metrics.min_dihedral}};
}

std::string figures_as_text(const CageMetrics& metrics) {
  std::string text = fmt::format("  {} vertices, {} triangles\n", metrics.vertices, metrics.faces);
  if (metrics.model_volume_method == VolumeMethod::none) {
    text += fmt::format("  volume {:.6g}; the model has no triangles\n", metrics.volume);
  } else {
    text += fmt::format("  volume {:.6g}", metrics.volume) + volume_ratio_text(metrics);
    text += fmt::format("  distance to the model, % of its diagonal: least {:.4f}, mean {:.3f}, "
                        "greatest {:.3f}\n",
                        100 * metrics.clearance, 100 * metrics.mean_distance,
                        100 * metrics.max_distance);
  }
  text +=
      fmt::format("  webbing: {:.1f} % of the free space between parts that are near each other\n",
                  100 * metrics.webbing);
  text += fmt::format("  triangle quality: least {:.3f}, 5th percentile {:.3f}; least dihedral "
                      "angle {:.1f} degrees; greatest valence {}\n",
                      metrics.min_quality, metrics.low_quality, metrics.min_dihedral,
                      metrics.max_valence);
  return text;
}

} // namespace cagewright
