#include "app/document/region.h"

#include <cagewright/cage/specks.h>

#include <QObject>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace cagewright::app {
namespace {

constexpr Index nowhere = std::numeric_limits<Index>::max();

/// The faces alone, and which vertices they use.
PolygonMesh mesh_of_faces(const PolygonMesh& whole, std::span<const Index> faces,
                          std::vector<Index>& vertices) {
  std::vector<Index> place(whole.positions.size(), nowhere);
  for (const Index f : faces) {
    for (const Index v : whole.face(f)) {
      place[v] = 0;
    }
  }
  PolygonMesh mesh;
  for (Index v = 0; v < place.size(); ++v) {
    if (place[v] != nowhere) {
      place[v] = static_cast<Index>(vertices.size());
      vertices.push_back(v);
      mesh.positions.push_back(whole.positions[v]);
      if (!whole.colors.empty()) {
        mesh.colors.push_back(whole.colors[v]);
      }
    }
  }
  std::vector<Index> corners;
  for (const Index f : faces) {
    const std::span<const Index> face = whole.face(f);
    corners.assign(face.begin(), face.end());
    for (Index& v : corners) {
      v = place[v];
    }
    mesh.add_face(corners);
  }
  return mesh;
}

/// Adds the groups of one file's mesh; none if it has no more than one.
void add_groups(const PolygonMesh& mesh, Index first_face, const QString& prefix,
                std::vector<NamedPart>& parts) {
  std::map<Index, std::vector<Index>> faces_of;
  std::vector<Index>* faces = nullptr; // of the group of the face before: most go on with it
  for (Index f = 0; f < mesh.face_groups.size(); ++f) {
    if (faces == nullptr || mesh.face_groups[f] != mesh.face_groups[f - 1]) {
      faces = &faces_of[mesh.face_groups[f]];
    }
    faces->push_back(first_face + f);
  }
  if (faces_of.size() < 2) {
    return;
  }
  for (auto& [group, of_group] : faces_of) {
    const QString name = group < mesh.group_names.size()
                             ? QString::fromStdString(mesh.group_names[group])
                             : QString();
    parts.push_back(
        {prefix + (name.isEmpty() ? QObject::tr("without a name") : name), std::move(of_group)});
  }
}

} // namespace

Result<std::shared_ptr<const Region>> make_region(const Model& whole, std::vector<Index> faces,
                                                  QString name, const Progress& progress) {
  if (faces.empty()) {
    return Error{ErrorCode::invalid_option,
                 "no face of the model is chosen: paint more of it, or choose an object"};
  }
  auto region = std::make_shared<Region>();
  region->name = std::move(name);
  PolygonMesh mesh = mesh_of_faces(whole.mesh, faces, region->vertices);
  Result<std::shared_ptr<const Model>> model = prepare_model(
      std::move(mesh), {.path = whole.path, .normals = {}, .notes = {}, .dress = {}}, progress);
  if (!model) {
    return model.error();
  }
  region->faces = std::move(faces);
  region->model = *std::move(model);
  return std::shared_ptr<const Region>(std::move(region));
}

Result<std::shared_ptr<const Region>> region_without_specks(const CagedModel& caged,
                                                            const Progress& progress) {
  const Model& model = caged.model();
  const Result<Specks> specks = find_specks(model.view(), progress.part(0, 0.5));
  if (!specks) {
    return specks.error();
  }
  if (specks->count == 0) {
    return std::shared_ptr<const Region>();
  }
  const std::vector<bool> stays = specks->faces_in_none(model.mesh);
  std::vector<Index> faces;
  for (Index f = 0; f < stays.size(); ++f) {
    if (stays[f]) {
      faces.push_back(caged.region ? caged.region->faces[f] : f);
    }
  }
  const QString name = caged.region ? QObject::tr("%1 but specks").arg(caged.region->name)
                                    : QObject::tr("all but specks");
  return make_region(*caged.whole, std::move(faces), name, progress.part(0.5, 1));
}

std::vector<NamedPart> named_parts(const Model& model) {
  std::vector<NamedPart> parts;
  Index first_face = 0;
  for (const ModelPart& part : model.parts) {
    const PolygonMesh& mesh = model.mesh_of(part);
    const auto count = static_cast<Index>(mesh.face_count());
    QString prefix;
    if (model.parts.size() > 1) {
      NamedPart file{QString::fromStdString(part.origin.path.filename().string()), {}};
      for (Index f = 0; f < count; ++f) {
        file.faces.push_back(first_face + f);
      }
      prefix = file.name + ": ";
      parts.push_back(std::move(file));
    }
    add_groups(mesh, first_face, prefix, parts);
    first_face += count;
  }
  return parts;
}

bool has_part(const std::vector<Index>& faces, const NamedPart& part) {
  if (part.faces.empty() || faces.size() < part.faces.size()) {
    return part.faces.empty();
  }
  // Of many parts each is looked for where it may be, not from the first face on.
  const auto first = std::ranges::lower_bound(faces, part.faces.front());
  return std::includes(first, faces.end(), part.faces.begin(), part.faces.end());
}

std::vector<Index> faces_within(const PolygonMesh& mesh, std::span<const char> vertex_is_chosen) {
  std::vector<Index> faces;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (std::ranges::all_of(mesh.face(f), [&](Index v) { return vertex_is_chosen[v] != 0; })) {
      faces.push_back(f);
    }
  }
  return faces;
}

} // namespace cagewright::app
