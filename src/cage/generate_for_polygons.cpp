#include <cagewright/cage/generate_for_polygons.h>

#include "cage/asked_model.h"
#include <cagewright/cage/generate.h>
#include <cagewright/mesh/triangle_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/every_cutting.h>
#include <cagewright/validate/validate_cage.h>

#include <utility>

namespace cagewright {

Result<GeneratedCage> generate_for_polygons(const PolygonMesh& model,
                                            const GenerateOptions& options,
                                            const Progress& progress) {
  if (is_model_changed(options) &&
      (options.density.empty() || options.density.size() == model.positions.size())) {
    const Result<AskedModel> asked = asked_model(model, options, progress.quiet());
    if (!asked) {
      return asked.error();
    }
    Result<GeneratedCage> made =
        generate_for_polygons(asked->mesh, asked->options(options), progress);
    if (made) {
      append_remarks(*made, asked->remarks);
    }
    return made;
  }
  constexpr double usual = 0.95; // of the time
  constexpr double judged = 0.96;
  const TriangleMesh own = to_triangle_mesh(model);
  const Triangulation cuttings = every_cutting(model);
  if (cuttings.triangles.size() == own.triangles.size()) {
    return generate(own, options, progress);
  }
  Result<GeneratedCage> made = generate(own, options, progress.part(0, usual));
  if (!made) {
    return made;
  }
  const TriangleView all{model.positions, cuttings.triangles};
  const Result<ValidityReport> validity =
      validate_cage(made->faces, all, {.allow_pieces = made->pieces > 1, .first_only = true},
                    progress.part(usual, judged));
  if (!validity) {
    return validity.error();
  }
  if (validity->valid()) {
    return made;
  }
  made = generate(all, options, progress.part(judged, 1));
  if (made) { // triangles that cover one another would count their volume more than once
    made->figures = measure_cage(made->faces, own);
  }
  return made;
}

} // namespace cagewright
