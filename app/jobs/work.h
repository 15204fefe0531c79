/// \file
/// The work of the application's jobs: from values to values, on any thread.
#pragma once

#include "app/document/binding.h"
#include "app/document/generate_settings.h"
#include "app/document/model.h"
#include "app/document/region.h"
#include "app/document/state.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>
#include <cagewright/validate/cage_metrics.h>
#include <cagewright/validate/validate_cage.h>

#include <QString>

#include <filesystem>
#include <memory>
#include <vector>

namespace cagewright::app {

struct MadeCage {
  std::shared_ptr<const PolygonMesh> cage;
  std::shared_ptr<const BoxDecomposition> stages; ///< how the model was split; null for an envelope
  QString remark; ///< what is not as asked for, and shares of quads; or empty
};

/// Makes a cage as the settings say.
/// \param painted  what was painted in the window, for DensitySource::painted: of the whole model
/// Errors: those of generate(), painted_density() and read_vertex_weights(); invalid_option
/// (nothing was painted).
Result<MadeCage> make_cage(const CagedModel& caged, const GenerateSettings& settings,
                           const SharedDensity& painted = nullptr, const Progress& progress = {});

/// Splits the model into boxes only, to look at. Errors: those of decompose().
Result<std::shared_ptr<const BoxDecomposition>>
make_stages(const Model& model, const GenerateSettings& settings, const Progress& progress = {});

/// Reads a cage from a file. Vertices that an STL file or a program has repeated are merged.
/// Errors: those of read_mesh().
Result<std::shared_ptr<const PolygonMesh>> read_cage(const std::filesystem::path& path);

/// Binds what the cage is for. Weights that would take more than 1.5 GB are kept in 16 bits.
/// \param prepared  of the same cage, by the same kinds; what is not there is made
/// Errors: those of Deformer::bind(), prepare_coordinates() and mixed_rule().
Result<std::shared_ptr<const Binding>> bind_model(const CagedModel& caged, const PolygonMesh& cage,
                                                  const CoordinateChoice& choice = {},
                                                  const Progress& progress = {},
                                                  PreparedKinds prepared = {});

struct JudgedCage {
  std::shared_ptr<const ValidityReport> report;
  std::vector<Index> offending_faces; ///< of the cage, ascending
};

/// Judges the cage against the model (which may be null: then alone). Errors: cancelled.
Result<JudgedCage> judge_cage(const PolygonMesh& cage, const Model* model,
                              const Progress& progress = {});

/// One model file to write.
struct ModelOutput {
  std::filesystem::path path;
  SharedPositions cage; ///< the pose
};

/// Where a part of the model is written: `path` itself, or, where there are several parts, beside
/// it with the part's name after its stem.
std::filesystem::path path_of_part(const Model& model, std::size_t part,
                                   const std::filesystem::path& path);

/// Writes the model in each of the poses, each of its parts to a file of its own: see
/// path_of_part(). A file of the same format as the part's keeps all else that is in it, with its
/// normals turned along; others get what they can hold. The files are read once more, for all
/// poses. \returns notes about what the first of them cannot hold Errors: cannot_open (a file of
/// the model is gone), mismatch (it is another now), cannot_write, unsupported, invalid_cage,
/// cancelled.
/// \param coordinates  by which what the cage is for is bound
Result<std::vector<FileNote>> export_models(const CagedModel& caged, const Coordinates& coordinates,
                                            const std::vector<ModelOutput>& outputs,
                                            const Progress& progress = {});

/// Writes the model as it moves along the time line: see write_animation(). Keyframes are what is
/// deformed, whatever the number of frames.
/// Errors: those of write_animation(), invalid_cage.
Status export_animation(const CagedModel& caged, const Coordinates& coordinates,
                        const TimeLine& time_line, const std::filesystem::path& path,
                        const Progress& progress = {});

/// Binds once more and writes the weights as NumPy's .npz. Errors: those of bind_model(),
/// cannot_write.
Status export_weights(const CagedModel& caged, const PolygonMesh& cage,
                      const CoordinateChoice& choice, const std::filesystem::path& path,
                      const Progress& progress = {});

/// Writes what is painted for another kind, a number for each vertex, each part of the model to a
/// file of its own: what `cagewright bind --mix-weights` takes. Errors: cannot_write.
Status export_mix(const Model& model, const SharedShares& mix, const std::filesystem::path& path);

} // namespace cagewright::app
