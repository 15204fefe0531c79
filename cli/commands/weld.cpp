#include "session.h"

#include "load.h"

#include "io/source.h"
#include <cagewright/io/write_mesh.h>
#include <cagewright/mesh/triangulate.h>
#include <cagewright/mesh/weld.h>
#include <cagewright/validate/fit.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright::cli {
namespace {

struct Options {
  std::string input;
  std::string output;
  bool triangulate = false;
  std::string fit; // the model; empty: not asked for
};

/// The cage changed as a whole so that it encloses the model of --fit.
Result<PolygonMesh> fitted(PolygonMesh cage, const Options& options, const Session& session) {
  const Result<PolygonMesh> model = load_mesh(options.fit);
  if (!model) {
    return model.error();
  }
  const std::optional<CageFit> fit = fit_cage(cage, to_triangle_mesh(*model));
  if (!fit) {
    warn(one_line(options.input) +
         ": no scale, turn or shift would make this cage fit better; it is left as it is");
    return cage;
  }
  session.say(fmt::format("{}: {}; {:.0f} % of the model's vertices are inside now\n",
                          options.input, fit->description, 100 * fit->inside));
  return (*fit)(std::move(cage));
}

/// Faces without the corners that merging has made one, as far as they keep three, and vertices
/// that faces use. Groups and colours stay.
PolygonMesh merge(const PolygonMesh& mesh, bool cut_faces) {
  const WeldedPoints points = weld_points(mesh.positions);
  constexpr Index unused = std::numeric_limits<Index>::max();
  std::vector<Index> place(points.positions.size(), unused);
  std::vector<char> used(points.positions.size(), 0);
  for (const Index v : mesh.corners()) {
    used[points.point_of[v]] = 1;
  }
  PolygonMesh result;
  result.group_names = mesh.group_names;
  for (Index p = 0; p < place.size(); ++p) {
    if (used[p] != 0) {
      place[p] = static_cast<Index>(result.positions.size());
      result.positions.push_back(points.positions[p]);
      if (!mesh.colors.empty()) {
        result.colors.push_back(mesh.colors[points.first_with[p]]);
      }
    }
  }
  const auto add = [&](std::vector<Index> face, std::size_t from) {
    for (Index& v : face) {
      v = place[points.point_of[v]];
    }
    face.erase(std::unique(face.begin(), face.end()), face.end());
    while (face.size() > 1 && face.front() == face.back()) {
      face.pop_back();
    }
    if (face.size() >= 3) {
      result.add_face(face);
      if (!mesh.face_groups.empty()) {
        result.face_groups.push_back(mesh.face_groups[from]);
      }
    }
  };
  if (cut_faces) {
    const Triangulation triangles = cagewright::triangulate(mesh);
    for (std::size_t t = 0; t < triangles.triangles.size(); ++t) {
      const Triangle& corners = triangles.triangles[t];
      add({corners.begin(), corners.end()}, triangles.face_of[t]);
    }
  } else {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
      add({mesh.face(f).begin(), mesh.face(f).end()}, f);
    }
  }
  return result;
}

int run(const Options& options, const Session& session) {
  if (const Status writable = can_write_cage(options.output, {options.input, options.fit});
      !writable) {
    return fail(writable.error());
  }
  const Result<PolygonMesh> mesh = load_mesh(options.input);
  if (!mesh) {
    return fail(mesh.error());
  }
  PolygonMesh welded = merge(*mesh, options.triangulate);
  if (!options.fit.empty()) {
    Result<PolygonMesh> moved = fitted(std::move(welded), options, session);
    if (!moved) {
      return fail(moved.error());
    }
    welded = *std::move(moved);
  }
  if (const Status written = write_mesh(welded, options.output); !written) {
    return fail(written.error());
  }
  session.say(fmt::format("{}: {} vertices of {} left, {} faces of {}\n", options.output,
                          welded.positions.size(), mesh->positions.size(), welded.face_count(),
                          mesh->face_count()));
  return done;
}

} // namespace

void add_weld(CLI::App& app, Session& session) {
  CLI::App* command =
      app.add_subcommand("weld", "Merge the vertices of a mesh that have exactly the same "
                                 "position, and leave out those that no face uses");
  auto options = std::make_shared<Options>();
  command->add_option("input", options->input, "The mesh, such as a cage from another program")
      ->required();
  command->add_option("output", options->output, "OBJ, PLY or OFF file to write")->required();
  command->add_flag("--triangulate", options->triangulate,
                    "Cut all faces into triangles, concave ones along diagonals inside them");
  command->add_option("--fit", options->fit,
                      "A model: scale, turn or shift the cage as a whole so that it encloses it, "
                      "where it is in another unit, has another up axis, or is elsewhere");
  command->callback([&session, options] {
    session.run = [&session, options] { return run(*options, session); };
  });
}

} // namespace cagewright::cli
