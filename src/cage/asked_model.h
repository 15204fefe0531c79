/// \file
/// What a cage is asked to enclose, of a model. Internal to this module.
#pragma once

#include <cagewright/cage/generate_options.h>
#include <cagewright/cage/generated_cage.h>
#include <cagewright/cage/specks.h>
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <span>
#include <vector>

namespace cagewright {

/// A model as it is to be enclosed, and what is left to be done with it.
struct AskedModel {
  PolygonMesh mesh;
  std::vector<double> density; ///< as many as it has vertices, or none
  std::vector<Remark> remarks; ///< about what was done

  /// The options for a cage of it: they refer to it, and no longer ask for what was done.
  [[nodiscard]] GenerateOptions options(const GenerateOptions& asked) const;
};

/// Whether the cage is to be made for something else than the model itself.
bool is_model_changed(const GenerateOptions& options);

/// The model without what is to be ignored, and with its openings closed: see openings.h.
/// Errors: those of find_specks() and close_openings().
Result<AskedModel> asked_model(const PolygonMesh& model, const GenerateOptions& options,
                               const Progress& progress);

/// Adds what is to be told of the model to what is told of its cage, with places in words.
void append_remarks(GeneratedCage& cage, std::span<const Remark> remarks);

/// Says that there are specks.
Remark remark_of(const Specks& specks, bool are_ignored);

} // namespace cagewright
