/// \file
/// A part of the model that the cage is for: the rest stays where it is.
#pragma once

#include "app/document/model.h"
#include <cagewright/core/progress.h>
#include <cagewright/core/result.h>

#include <QString>

#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace cagewright::app {

/// Never changed, shared by the document and the jobs.
struct Region {
  QString name;                ///< for people
  std::vector<Index> faces;    ///< of the whole model's mesh, ascending; at least one
  std::vector<Index> vertices; ///< R of the whole model's, ascending: those that the faces use
  std::shared_ptr<const Model> model; ///< these faces alone, of R vertices
};

/// What is known of the region's vertices, in the place of all of the model's.
template <class T>
std::vector<T> scattered(const Region& region, std::span<const T> of_region, std::vector<T> whole) {
  for (std::size_t i = 0; i < region.vertices.size() && i < of_region.size(); ++i) {
    whole[region.vertices[i]] = of_region[i];
  }
  return whole;
}

/// And what is known of all, for the region's.
template <class T> std::vector<T> gathered(const Region& region, std::span<const T> of_whole) {
  std::vector<T> found;
  found.reserve(region.vertices.size());
  for (const Index v : region.vertices) {
    found.push_back(of_whole[v]);
  }
  return found;
}

/// A model and what of it the cage is for.
struct CagedModel {
  std::shared_ptr<const Model> whole;
  std::shared_ptr<const Region> region = nullptr; ///< null: all of it

  /// What the cage is for.
  [[nodiscard]] const Model& model() const { return region ? *region->model : *whole; }
  /// Null where there is no model.
  [[nodiscard]] const std::shared_ptr<const Model>& shared_model() const {
    return region ? region->model : whole;
  }
  /// V of the whole model, where those of `model()` are so.
  [[nodiscard]] std::vector<Vec3> positions(std::vector<Vec3> of_model) const {
    return region ? scattered<Vec3>(*region, of_model, whole->mesh.positions) : std::move(of_model);
  }
};

/// Errors: invalid_option (no faces), unfit_model (no extent), cancelled.
/// \param faces  of the whole model's mesh, ascending
Result<std::shared_ptr<const Region>> make_region(const Model& whole, std::vector<Index> faces,
                                                  QString name, const Progress& progress = {});

/// Of what the cage is for, all but specks: tiny pieces far from the rest, and vertices that no
/// face uses. Null: there are none.
/// Errors: those of find_specks() and make_region().
Result<std::shared_ptr<const Region>> region_without_specks(const CagedModel& caged,
                                                            const Progress& progress = {});

/// A named part of the model: one of its files, or an object or group of one.
struct NamedPart {
  QString name;
  std::vector<Index> faces; ///< of the model's mesh, ascending
};

/// Whether all of a part's faces are among these, which are ascending.
bool has_part(const std::vector<Index>& faces, const NamedPart& part);

/// The files, if there are several, and the groups of files that have more than one. In the order
/// of their faces.
std::vector<NamedPart> named_parts(const Model& model);

/// Faces all of whose corners are chosen, ascending.
std::vector<Index> faces_within(const PolygonMesh& mesh, std::span<const char> vertex_is_chosen);

} // namespace cagewright::app
