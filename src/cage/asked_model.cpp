#include "cage/asked_model.h"

#include "cage/openings.h"
#include "mesh/mesh_part.h"
#include <cagewright/mesh/measures.h>
#include <cagewright/mesh/triangulate.h>

#include <array>
#include <cstdio>
#include <string>
#include <utility>

namespace cagewright {
namespace {

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), value < 100 ? "%.3g" : "%.0f", value);
  return text.data();
}

/// Of the faces that are in no speck.
Result<AskedModel> without_specks(const PolygonMesh& model, std::span<const double> density,
                                  const Progress& progress) {
  const Result<Specks> specks = find_specks(to_triangle_mesh(model), progress);
  if (!specks) {
    return specks.error();
  }
  MeshPart rest = part_of(model, specks->faces_in_none(model));
  AskedModel asked;
  asked.mesh = std::move(rest.mesh);
  if (!density.empty()) {
    for (const Index v : rest.vertices) {
      asked.density.push_back(density[v]);
    }
  }
  if (specks->count > 0) {
    asked.remarks.push_back(remark_of(*specks, true));
  }
  return asked;
}

std::string counted(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

Remark remark_of(const Closures& closures) {
  std::string text = closures.closed > 0
                         ? counted(closures.closed, "opening is", "openings are") + " closed"
                         : "no opening was closed";
  if (closures.too_wide > 0) {
    text += "; " + counted(closures.too_wide, "is wider", "are wider") + " than asked for";
  }
  return {Reason::openings_closed, std::move(text), false, {}};
}

/// Adds what closes the openings.
Status close_openings(AskedModel& asked, double closing, const Progress& progress) {
  const TriangleMesh model = to_triangle_mesh(asked.mesh);
  const double widest = 2 * closing * bounding_box(TriangleView(model)).diagonal().norm();
  Result<Closures> closures = close_openings(model, widest, progress);
  if (!closures) {
    return closures.error();
  }
  const auto first = static_cast<Index>(asked.mesh.positions.size());
  for (const Vec3& p : closures->mesh.positions) {
    asked.mesh.positions.push_back(p);
  }
  for (const Triangle& t : closures->mesh.triangles) {
    asked.mesh.add_face({t[0] + first, t[1] + first, t[2] + first});
  }
  asked.mesh.colors.clear(); // none of these have as many any more
  asked.mesh.face_groups.clear();
  asked.mesh.group_names.clear();
  if (!asked.density.empty()) {
    asked.density.resize(asked.mesh.positions.size(), 1);
  }
  asked.remarks.push_back(remark_of(*closures));
  return success();
}

} // namespace

GenerateOptions AskedModel::options(const GenerateOptions& asked) const {
  GenerateOptions own = asked;
  own.ignore_specks = false;
  own.closing = own.solid ? 0 : own.closing; // of the openings
  own.solid = false;
  own.density = density;
  return own;
}

bool is_model_changed(const GenerateOptions& options) {
  return options.ignore_specks || options.solid;
}

Result<AskedModel> asked_model(const PolygonMesh& model, const GenerateOptions& options,
                               const Progress& progress) {
  AskedModel asked;
  if (options.ignore_specks) {
    Result<AskedModel> rest = without_specks(model, options.density, progress);
    if (!rest) {
      return rest;
    }
    asked = std::move(*rest);
  } else {
    asked.mesh = model;
    asked.density.assign(options.density.begin(), options.density.end());
  }
  if (options.solid) {
    if (const Status closed = close_openings(asked, options.closing, progress); !closed) {
      return closed.error();
    }
  }
  return asked;
}

Remark remark_of(const Specks& specks, bool are_ignored) {
  const bool is_one = specks.count == 1;
  std::string text = std::to_string(specks.count);
  text += is_one ? " tiny piece far from the rest " : " tiny pieces far from the rest ";
  if (are_ignored) {
    text += is_one ? "is ignored, and not enclosed" : "are ignored, and not enclosed";
  } else {
    text += is_one ? "is enclosed, too" : "are enclosed, too";
    text += ", which makes the model's box " + rounded(specks.enlargement) + " times as long";
  }
  return {are_ignored ? Reason::specks_ignored : Reason::specks_enclosed, std::move(text), false,
          specks.place};
}

} // namespace cagewright
