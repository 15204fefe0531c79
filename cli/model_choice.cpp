#include "model_choice.h"

#include "load.h"

#include <cagewright/cage/specks.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>

namespace cagewright::cli {
namespace {

constexpr std::size_t most_listed = 20; // names in a message

/// The groups that a name stands for.
std::vector<std::size_t> groups_named(const PolygonMesh& mesh, const std::string& name) {
  const std::vector<std::string>& names = mesh.group_names;
  std::vector<std::size_t> found;
  for (std::size_t g = 0; g < names.size(); ++g) {
    if (names[g] == name) {
      found.push_back(g);
    }
  }
  const std::size_t mark = name.rfind('#');
  if (!found.empty() || mark == std::string::npos) {
    return found;
  }
  std::size_t number = 0;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + mark + 1, end, number);
  if (read.ec != std::errc() || read.ptr != end) {
    return {};
  }
  const std::vector<std::size_t> alike = groups_named(mesh, name.substr(0, mark));
  return number >= 1 && number <= alike.size() ? std::vector{alike[number - 1]}
                                               : std::vector<std::size_t>();
}

/// The groups of an object, in OBJ.
std::vector<std::size_t> groups_of_object(const std::vector<std::string>& objects,
                                          const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t g = 0; g < objects.size(); ++g) {
    if (!name.empty() && objects[g] == name) {
      found.push_back(g);
    }
  }
  return found;
}

/// The names as they can be given: those that several groups have with their numbers, and then the
/// objects that have groups.
std::string list_of_names(const PolygonMesh& mesh, const std::vector<std::string>& objects) {
  std::map<std::string, std::size_t> counts;
  for (const std::string& name : mesh.group_names) {
    ++counts[name];
  }
  std::vector<std::string> names;
  std::map<std::string, std::size_t> met;
  for (const std::string& name : mesh.group_names) {
    names.push_back(counts[name] > 1 ? name + '#' + std::to_string(++met[name]) : name);
  }
  for (const std::string& object : objects) {
    if (!object.empty() && !counts.contains(object) &&
        std::ranges::find(names, object) == names.end()) {
      names.push_back(object);
    }
  }
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most_listed); ++i) {
    list += (i == 0 ? "" : ", ") + names[i];
  }
  const std::size_t more = names.size() - std::min(names.size(), most_listed);
  return more > 0 ? list + " and " + std::to_string(more) + " more" : list;
}

} // namespace

void add_pose_option(CLI::App& command, ModelChoice& choice) {
  command
      .add_option("--pose", choice.pose,
                  "Rigged models (glTF): shown, as the joints stand in the file, with the weights "
                  "of its shapes; or bind, as the model was bound to them")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, Pose>{{"shown", Pose::shown}, {"bind", Pose::bind}}))
      ->option_text("shown|bind=shown");
}

void add_only_option(CLI::App& command, ModelChoice& choice, const std::string& purpose) {
  command.add_option("--only", choice.only,
                     purpose + "; NAME#2 is the second of that name; repeatable");
}

void add_specks_option(CLI::App& command, ModelChoice& choice, const std::string& purpose) {
  command.add_flag("--ignore-specks", choice.ignore_specks,
                   purpose + " without tiny pieces far from the rest, and vertices that no face "
                             "uses: what 'generate --ignore-specks' makes a cage for");
}

void add_cage_object_option(CLI::App& command, ModelChoice& choice) {
  command.add_option("--cage-object", choice.cage_objects,
                     "The cage is this object of its file; where the model is in the same file, it "
                     "is the other objects, or those of --only; NAME#2 is the second of that name; "
                     "repeatable");
}

Result<std::vector<bool>> faces_named(const ModelFile& file, std::span<const std::string> names,
                                      const std::string& option) {
  const PolygonMesh& mesh = file.mesh();
  std::vector<std::string> objects; // looked up if a name is that of no group
  std::vector<bool> is_chosen(mesh.group_names.size(), false);
  for (const std::string& name : names) {
    std::vector<std::size_t> groups = groups_named(mesh, name);
    if (groups.empty() && !mesh.group_names.empty()) {
      Result<MeshAttributes> attributes = file.attributes();
      if (!attributes) {
        return attributes.error();
      }
      objects = std::move(attributes->group_objects);
      groups = groups_of_object(objects, name);
    }
    if (groups.empty()) {
      return Error{ErrorCode::invalid_option,
                   option + ": the model has no group '" + name + "'" +
                       (mesh.group_names.empty() ? ", nor any other"
                                                 : "; it has " + list_of_names(mesh, objects))};
    }
    for (const std::size_t group : groups) {
      is_chosen[group] = true;
    }
  }
  std::vector<bool> faces(mesh.face_count(), false);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    faces[f] = is_chosen[mesh.face_groups[f]];
  }
  return faces;
}

namespace {

Result<PolygonMesh> load_named(const std::string& path, const ModelChoice& choice) {
  Result<ModelFile> file = load_model(path, choice.pose);
  if (!file) {
    return file.error();
  }
  if (choice.only.empty()) {
    return std::move(*file).take_mesh();
  }
  const Result<std::vector<bool>> faces = faces_named(*file, choice.only, "--only");
  if (!faces) {
    return in_file(path, faces.error());
  }
  return part_of(file->mesh(), *faces).mesh;
}

Result<MeshPart> without_specks(const std::string& path, const PolygonMesh& mesh) {
  const Result<std::vector<bool>> faces = faces_in_no_speck(mesh);
  return faces ? part_of(mesh, *faces) : Result<MeshPart>(in_file(path, faces.error()));
}

/// What the cage is for, of a model and a cage.
Result<MeshPart> bound_part(const ModelFile& model, const std::string& path,
                            const ModelChoice& choice, bool is_beside_cage) {
  const PolygonMesh& whole = model.mesh();
  if (choice.only.empty() && !is_beside_cage) {
    MeshPart all{whole, std::vector<Index>(whole.positions.size())};
    std::iota(all.vertices.begin(), all.vertices.end(), Index(0));
    return all;
  }
  Result<std::vector<bool>> faces = choice.only.empty()
                                        ? faces_named(model, choice.cage_objects, "--cage-object")
                                        : faces_named(model, choice.only, "--only");
  if (!faces) {
    return in_file(path, faces.error());
  }
  if (choice.only.empty()) {
    faces->flip();
  }
  MeshPart part = part_of(whole, *faces);
  if (part.mesh.face_count() == 0) {
    return Error{ErrorCode::invalid_option,
                 path + ": --cage-object: all objects of the file are the cage; nothing is left "
                        "for the model"};
  }
  return part;
}

} // namespace

Result<PolygonMesh> load_chosen(const std::string& path, const ModelChoice& choice) {
  Result<PolygonMesh> mesh = load_named(path, choice);
  if (!mesh || !choice.ignore_specks) {
    return mesh;
  }
  Result<MeshPart> rest = without_specks(path, *mesh);
  return rest ? std::move(rest->mesh) : Result<PolygonMesh>(rest.error());
}

Result<PolygonMesh> load_chosen(const std::vector<std::string>& paths, const ModelChoice& choice) {
  PolygonMesh all;
  bool have_colors = true;
  for (const std::string& path : paths) {
    Result<PolygonMesh> mesh = load_chosen(path, choice);
    if (!mesh || paths.size() == 1) {
      return mesh;
    }
    const auto first = static_cast<Index>(all.positions.size());
    have_colors = have_colors && mesh->colors.size() == mesh->positions.size();
    all.positions.insert(all.positions.end(), mesh->positions.begin(), mesh->positions.end());
    all.colors.insert(all.colors.end(), mesh->colors.begin(), mesh->colors.end());
    std::vector<Index> corners;
    for (std::size_t f = 0; f < mesh->face_count(); ++f) {
      const auto face = mesh->face(f);
      corners.assign(face.begin(), face.end());
      for (Index& v : corners) {
        v += first;
      }
      all.add_face(corners);
    }
  }
  if (!have_colors) {
    all.colors.clear();
  }
  return all;
}

Result<PolygonMesh> load_cage(const std::string& path, const ModelChoice& choice) {
  Result<ModelFile> file = load_model(path, choice.pose);
  if (!file) {
    return file.error();
  }
  if (choice.cage_objects.empty()) {
    return std::move(*file).take_mesh();
  }
  const Result<std::vector<bool>> faces = faces_named(*file, choice.cage_objects, "--cage-object");
  if (!faces) {
    return in_file(path, faces.error());
  }
  return part_of(file->mesh(), *faces).mesh;
}

Result<ModelAndCage> load_model_and_cage(const std::string& model, const std::string& cage,
                                         const ModelChoice& choice) {
  Result<ModelFile> whole = load_model(model, choice.pose);
  if (!whole) {
    return whole.error();
  }
  Result<PolygonMesh> around = load_cage(cage, choice);
  if (!around) {
    return around.error();
  }
  ModelAndCage meshes{*std::move(whole), {}, *std::move(around)};
  std::error_code ignored;
  const bool is_beside_cage =
      !choice.cage_objects.empty() && std::filesystem::equivalent(model, cage, ignored);
  Result<MeshPart> part = bound_part(meshes.file, model, choice, is_beside_cage);
  if (!part) {
    return part.error();
  }
  meshes.bound = std::move(*part);
  if (choice.ignore_specks) {
    Result<MeshPart> rest = without_specks(model, meshes.bound.mesh);
    if (!rest) {
      return rest.error();
    }
    for (Index& v : rest->vertices) {
      v = meshes.bound.vertices[v];
    }
    meshes.bound = std::move(*rest);
  }
  return meshes;
}

} // namespace cagewright::cli
