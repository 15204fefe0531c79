#include "arrays.h"
#include "calls.h"
#include "deform_file.h"
#include "handles.h"

#include "report/coordinate_kinds.h"
#include <cagewright/coordinates/kinds.h>
#include <cagewright/deform/deformer.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace cagewright;
using namespace cagewright::c;

struct cw_deformer {
  Deformer deformer;
};

struct cw_sparse {
  std::size_t column_count = 0;
  std::vector<double> values;
  std::vector<std::uint32_t> columns;
  std::vector<std::uint64_t> offsets = {0};

  void add_row(const Weights& weights, std::size_t p) {
    for (std::size_t k = 0; k < column_count; ++k) {
      if (const double weight = weights.at(p, k); weight != 0) {
        values.push_back(weight);
        columns.push_back(static_cast<std::uint32_t>(k));
      }
    }
    offsets.push_back(values.size());
  }
};

namespace {

/// A kind of coordinates by name, and its settings: "quads=diagonal outside=rest".
Result<CoordinateSettings> coordinates_named(const char* kind, const char* settings) {
  return CoordinateSettings::parse(kind != nullptr ? kind : CoordinateSettings().kind().name,
                                   settings != nullptr ? settings : "");
}

/// Is shown the weights of some points, of which the first has this number.
using WeightsSeen = std::function<void(const Weights& weights, std::size_t first)>;

/// Some at a time: all weights stand in memory once, in whatever the caller makes of them.
Status solve(const Coordinates& coordinates, std::span<const Vec3> points, const WeightsSeen& seen,
             const Progress& progress) {
  constexpr std::size_t some = 16 * Weights::tile_points;
  const auto count = static_cast<double>(points.size());
  for (std::size_t first = 0; first < points.size(); first += some) {
    const std::size_t now = std::min(some, points.size() - first);
    const auto solved = solve_all<double>(coordinates, points.subspan(first, now),
                                          progress.part(static_cast<double>(first) / count,
                                                        static_cast<double>(first + now) / count));
    if (!solved) {
      return solved.error();
    }
    seen(solved->weights, first);
  }
  return success();
}

/// What both forms of weights are made of.
struct AskedCoordinates {
  Points points;
  std::shared_ptr<const Coordinates> coordinates;

  static Result<AskedCoordinates> of(const char* kind, const char* settings, const cw_array* points,
                                     const cw_mesh_view* cage, const Progress& progress) {
    const Result<CoordinateSettings> options = coordinates_named(kind, settings);
    if (!options) {
      return options.error();
    }
    if (const Status there = all_given({{points, "the array of points"}}); !there) {
      return there.error();
    }
    Result<Points> given = Points::of(*points, "the points");
    if (!given) {
      return given.error();
    }
    const Result<MeshArgument> mesh = MeshArgument::of(cage, "the cage");
    if (!mesh) {
      return mesh.error();
    }
    auto prepared = prepare_coordinates(mesh->polygons(), *options, progress);
    if (!prepared) {
      return prepared.error();
    }
    return AskedCoordinates{std::move(*given), std::move(*prepared)};
  }
};

Result<WeightStorage> storage_of(cw_storage storage) {
  switch (storage) {
  case CW_STORAGE_SINGLE:
    return WeightStorage::single;
  case CW_STORAGE_FULL:
    return WeightStorage::full;
  case CW_STORAGE_COMPACT:
    return WeightStorage::compact;
  }
  return Error{ErrorCode::invalid_option, "there is no such storage of weights"};
}

Status bind(const MeshArgument& model, const MeshArgument& cage, const cw_deformer_options& given,
            const Progress& progress, cw_deformer** out) {
  Result<CoordinateSettings> coordinates = coordinates_named(given.coordinates, given.settings);
  if (!coordinates) {
    return coordinates.error();
  }
  coordinates->allow_open = given.allow_open != 0;
  const Result<WeightStorage> storage = storage_of(given.storage);
  if (!storage) {
    return storage.error();
  }
  const DeformerOptions options{
      .coordinates = *coordinates, .storage = *storage, .normals = given.no_normals == 0};
  Result<Deformer> bound = Deformer::bind(model.polygons(), cage.polygons(), options, {}, progress);
  if (!bound) {
    return bound.error();
  }
  *out = new cw_deformer{std::move(*bound)};
  return success();
}

Status take_paths(const char* const* paths, std::size_t count, const char* what,
                  std::vector<std::filesystem::path>& into) {
  for (std::size_t i = 0; i < count; ++i) {
    if (Status there = all_given({{paths, what}}); !there) {
      return there;
    }
    if (Status there = all_given({{paths[i], what}}); !there) {
      return there;
    }
    into.emplace_back(paths[i]);
  }
  return success();
}

/// The poses of a cage, from files or from the caller's memory.
Status take_poses(const char* const* posed, const cw_array* positions, std::size_t count,
                  DeformedFiles& files) {
  if (posed != nullptr || positions == nullptr) {
    return take_paths(posed, count, "the path of the cage moved", files.posed);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Result<Points> given =
        Points::of(positions[i], "the positions of pose " + std::to_string(i));
    if (!given) {
      return given.error();
    }
    files.positions.emplace_back(given->view().begin(), given->view().end());
  }
  return success();
}

Status take_options(const cw_sequence_options* options, DeformedFiles& files) {
  const cw_sequence_options given = known_part(options);
  const Result<CoordinateSettings> coordinates =
      coordinates_named(given.coordinates, given.settings);
  if (!coordinates) {
    return coordinates.error();
  }
  files.coordinates = *coordinates;
  if (options != nullptr) {
    files.times.first_frame = given.first_frame;
  }
  if (given.frames_per_second != 0) {
    files.times.frames_per_second = given.frames_per_second;
  }
  return success();
}

const double* numbers_in(std::span<const Vec3> points) {
  return points.empty() ? nullptr : reinterpret_cast<const double*>(points.data());
}

Error other_count(const std::string& what, std::size_t count, std::size_t wanted) {
  return {ErrorCode::mismatch,
          what + " are " + std::to_string(count) + ", not " + std::to_string(wanted)};
}

} // namespace

cw_code cw_coordinates(const char* kind, const char* settings, const cw_array* points,
                       const cw_mesh_view* cage, const cw_control* control, double* weights,
                       size_t row, cw_error** error) {
  return call(error, control, [&](const Progress& progress) -> Status {
    const auto asked = AskedCoordinates::of(kind, settings, points, cage, progress.part(0, 0.2));
    if (!asked) {
      return asked.error();
    }
    const std::size_t columns = asked->coordinates->columns();
    if (row != 0 && row < columns) {
      return Error{ErrorCode::invalid_option, "a row has " + std::to_string(columns) +
                                                  " weights, and does not fit into " +
                                                  std::to_string(row)};
    }
    if (!asked->points.view().empty()) {
      if (Status there = all_given({{weights, "the place for the weights"}}); !there) {
        return there;
      }
    }
    const std::size_t step = row != 0 ? row : columns;
    const auto store = [&](const Weights& some, std::size_t first) {
      for (std::size_t p = 0; p < some.points(); ++p) {
        for (std::size_t k = 0; k < columns; ++k) {
          weights[(first + p) * step + k] = some.at(p, k);
        }
      }
    };
    return solve(*asked->coordinates, asked->points.view(), store, progress.part(0.2, 1));
  });
}

cw_code cw_coordinates_sparse(const char* kind, const char* settings, const cw_array* points,
                              const cw_mesh_view* cage, const cw_control* control, cw_sparse** out,
                              cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) -> Status {
    const auto asked = AskedCoordinates::of(kind, settings, points, cage, progress.part(0, 0.2));
    if (!asked) {
      return asked.error();
    }
    auto matrix = std::make_unique<cw_sparse>();
    matrix->column_count = asked->coordinates->columns();
    const auto keep = [&](const Weights& some, std::size_t) {
      for (std::size_t p = 0; p < some.points(); ++p) {
        matrix->add_row(some, p);
      }
    };
    if (Status solved =
            solve(*asked->coordinates, asked->points.view(), keep, progress.part(0.2, 1));
        !solved) {
      return solved;
    }
    *out = matrix.release();
    return success();
  });
}

void cw_sparse_free(cw_sparse* matrix) {
  delete matrix;
}

size_t cw_sparse_row_count(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->offsets.size() - 1 : 0;
}

size_t cw_sparse_column_count(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->column_count : 0;
}

size_t cw_sparse_value_count(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->values.size() : 0;
}

const double* cw_sparse_values(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->values.data() : nullptr;
}

const uint32_t* cw_sparse_columns(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->columns.data() : nullptr;
}

const uint64_t* cw_sparse_offsets(const cw_sparse* matrix) {
  return matrix != nullptr ? matrix->offsets.data() : nullptr;
}

cw_code cw_coordinate_columns(const char* kind, const char* settings, const cw_mesh_view* cage,
                              size_t* columns, cw_error** error) {
  return call_for(columns, error, [&]() -> Status {
    const Result<CoordinateSettings> options = coordinates_named(kind, settings);
    if (!options) {
      return options.error();
    }
    const Result<MeshArgument> mesh = MeshArgument::of(cage, "the cage");
    if (!mesh) {
      return mesh.error();
    }
    const auto rule = coordinate_rule(mesh->polygons(), *options);
    if (!rule) {
      return rule.error();
    }
    *columns = (*rule)->columns();
    return success();
  });
}

cw_code cw_coordinates_describe(char** out, cw_error** error) {
  return call_for(out, error, [&]() -> Status {
    *out = handed_out(coordinate_kinds_as_json().dump());
    return success();
  });
}

cw_code cw_deformer_bind(const cw_mesh_view* model, const cw_mesh_view* cage,
                         const cw_deformer_options* options, const cw_control* control,
                         cw_deformer** out, cw_error** error) {
  return call_for(out, error, control, [&](const Progress& progress) -> Status {
    const Result<ModelAndCage> meshes = ModelAndCage::of(model, cage);
    if (!meshes) {
      return meshes.error();
    }
    return bind(meshes->model, meshes->cage, known_part(options), progress, out);
  });
}

void cw_deformer_free(cw_deformer* deformer) {
  delete deformer;
}

cw_code cw_deformer_set_cage(cw_deformer* deformer, const cw_array* positions,
                             const cw_control* control, cw_error** error) {
  return call(error, control, [&](const Progress&) -> Status {
    if (Status there =
            all_given({{deformer, "the deformer"}, {positions, "the array of positions"}});
        !there) {
      return there;
    }
    const Result<Points> given = Points::of(*positions, "the cage's positions");
    if (!given) {
      return given.error();
    }
    Deformer& d = deformer->deformer;
    if (given->view().size() != d.cage_positions().size()) {
      return other_count("the cage's positions", given->view().size(), d.cage_positions().size());
    }
    d.set_cage(given->view());
    d.update();
    return success();
  });
}

cw_code cw_deformer_move(cw_deformer* deformer, const cw_array* vertices, const cw_array* positions,
                         const cw_control* control, cw_error** error) {
  return call(error, control, [&](const Progress&) -> Status {
    if (Status there = all_given({{deformer, "the deformer"},
                                  {vertices, "the array of vertices"},
                                  {positions, "the array of positions"}});
        !there) {
      return there;
    }
    Deformer& d = deformer->deformer;
    const Result<std::vector<Index>> which =
        indices_of(*vertices, d.cage_positions().size(), "the move");
    if (!which) {
      return which.error();
    }
    const Result<Points> to = Points::of(*positions, "the positions");
    if (!to) {
      return to.error();
    }
    if (to->view().size() != which->size()) {
      return other_count("the positions", to->view().size(), which->size());
    }
    for (std::size_t i = 0; i < which->size(); ++i) {
      d.move_cage_vertex((*which)[i], to->view()[i]);
    }
    d.update();
    return success();
  });
}

size_t cw_deformer_vertex_count(const cw_deformer* deformer) {
  return deformer != nullptr ? deformer->deformer.positions().size() : 0;
}

size_t cw_deformer_cage_vertex_count(const cw_deformer* deformer) {
  return deformer != nullptr ? deformer->deformer.cage_positions().size() : 0;
}

const double* cw_deformer_positions(const cw_deformer* deformer) {
  return deformer != nullptr ? numbers_in(deformer->deformer.positions()) : nullptr;
}

const double* cw_deformer_normals(const cw_deformer* deformer) {
  return deformer != nullptr ? numbers_in(deformer->deformer.normals()) : nullptr;
}

const double* cw_deformer_cage_positions(const cw_deformer* deformer) {
  return deformer != nullptr ? numbers_in(deformer->deformer.cage_positions()) : nullptr;
}

size_t cw_deformer_unbound_count(const cw_deformer* deformer) {
  return deformer != nullptr ? deformer->deformer.unbound() : 0;
}

size_t cw_deformer_weight_bytes(const cw_deformer* deformer) {
  return deformer != nullptr ? deformer->deformer.weight_bytes() : 0;
}

cw_code cw_deform_file(const char* model, const char* cage, const char* posed, const char* out,
                       const cw_control* control, char** notes, cw_error** error) {
  return cw_deform_sequence(model, cage, &posed, nullptr, 1, &out, 1, nullptr, control, notes,
                            error);
}

cw_code cw_deform_sequence(const char* model, const char* cage, const char* const* posed,
                           const cw_array* positions, size_t count, const char* const* outs,
                           size_t out_count, const cw_sequence_options* options,
                           const cw_control* control, char** notes, cw_error** error) {
  if (notes != nullptr) {
    *notes = nullptr;
  }
  return call(error, control, [&](const Progress& progress) -> Status {
    const Status there =
        all_given({{model, "the path of the model"}, {cage, "the path of the cage"}});
    if (!there) {
      return there;
    }
    DeformedFiles files;
    files.model = model;
    files.cage = cage;
    if (Status taken = take_poses(posed, positions, count, files); !taken) {
      return taken;
    }
    if (Status taken = take_paths(outs, out_count, "the path to write", files.outs); !taken) {
      return taken;
    }
    if (Status taken = take_options(options, files); !taken) {
      return taken;
    }
    const Result<std::vector<FileNote>> noted = deform_files(files, progress);
    if (!noted) {
      return noted.error();
    }
    if (notes != nullptr) {
      *notes = handed_out(notes_as_json(*noted));
    }
    return success();
  });
}
