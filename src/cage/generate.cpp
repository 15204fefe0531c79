#include "cage/generate.h"

#include "cage/unite.h"
#include "validate/validate_cage.h"

#include <array>
#include <optional>
#include <string>
#include <utility>

namespace cagewright {
namespace {

/// Boxes grow by distinct amounts up to these parts of a voxel before they are united, so that no
/// two of their faces coincide. The second and third are for the case that the union, moved to the
/// model's coordinates, does not survive the rounding.
constexpr std::array<double, 3> separations = {0.2, 0.17, 0.13};

// Shares of the whole time, for the progress bar.
constexpr double decomposed = 0.35;
constexpr double registered = 0.4;
constexpr double united = 0.9;

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

/// The error that tells a caller why the result of the pipeline cannot be trusted.
Error not_valid(const ValidityReport& report) {
  const Violation& first = report.violations.front();
  return {ErrorCode::no_valid_cage, "the cage that was made did not pass the check (" +
                                        std::string(name_of(first.kind)) +
                                        "); try another resolution or depth"};
}

Result<Registration> joined_or_not(const std::vector<BoxContents>& contents,
                                   const BoxDecomposition& boxes, const GenerateOptions& options,
                                   const Progress& progress) {
  if (!options.registration) {
    return keep_apart(contents);
  }
  return register_boxes(in_grid_coordinates(boxes.grid), contents, {}, progress);
}

} // namespace

Result<GeneratedCage> generate_cage(TriangleView model, const GenerateOptions& options,
                                    const Progress& progress) {
  Result<BoxDecomposition> boxes = decompose(model, options.boxes, progress.part(0, decomposed));
  if (!boxes) {
    return boxes.error();
  }
  GeneratedCage made;
  made.boxes = std::move(*boxes);
  made.leaves = made.boxes.tree.cover();
  made.times = made.boxes.times;
  Stopwatch watch(made.times);

  Result<Registration> registration =
      joined_or_not(contents_of(made.boxes.tree, made.leaves), made.boxes, options,
                    progress.part(decomposed, registered));
  if (!registration) {
    return registration.error();
  }
  made.registration = std::move(*registration);
  watch.lap("registration");

  std::optional<Error> why;
  for (const double separation : separations) {
    Result<TriangleMesh> cage = unite(made.registration.solids, {.separation = separation},
                                      progress.part(registered, united));
    if (!cage) {
      return cage.error();
    }
    made.cage = to_model(made.boxes, std::move(*cage));
    watch.lap("union");

    const Result<ValidityReport> report =
        validate_cage(TriangleView(made.cage), model,
                      {.allow_pieces = options.boxes.pieces == Pieces::apart, .max_listed = 1},
                      progress.part(united, 1));
    if (!report) {
      return report.error();
    }
    watch.lap("check");
    if (report->valid()) {
      return made;
    }
    why = not_valid(*report);
  }
  return *why;
}

} // namespace cagewright
