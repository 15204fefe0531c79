#include "app/document/project_file.h"

#include "io/atomic_file.h"

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace cagewright::app {
namespace {

namespace fs = std::filesystem;

constexpr int version = 1;

QJsonArray to_json(std::span<const Vec3> positions) {
  QJsonArray json;
  for (const Vec3& p : positions) {
    json.append(QJsonArray{p.x(), p.y(), p.z()});
  }
  return json;
}

QJsonArray faces_to_json(const PolygonMesh& mesh) {
  QJsonArray json;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    QJsonArray corners;
    for (const Index v : mesh.face(f)) {
      corners.append(static_cast<qint64>(v));
    }
    json.append(corners);
  }
  return json;
}

/// Switches and numbers of a struct under their names, for writing and for reading alike.
template <class Visit> void visit(Layers& l, const Visit& field) {
  field("model", l.model);
  field("smooth_normals", l.smooth_normals);
  field("wireframe", l.wireframe);
  field("cage_edges", l.cage_edges);
  field("cage_faces", l.cage_faces);
  field("cage_vertices", l.cage_vertices);
  field("rest_cage", l.rest_cage);
  field("boxes", l.boxes);
  field("feature_voxels", l.feature_voxels);
  field("inner_voxels", l.inner_voxels);
  field("cuts", l.cuts);
  field("problems", l.problems);
  field("weights", l.weights);
  field("distance", l.distance);
  field("grid", l.grid);
  field("depth", l.depth);
}

template <class Visit> void visit(ToolSettings& t, const Visit& field) {
  field("tool", t.tool);
  field("axes", t.axes);
  field("pivot", t.pivot);
  field("see_through", t.see_through);
  field("snap", t.snap);
  field("snap_step", t.snap_step);
  field("snap_angle_degrees", t.snap_angle_degrees);
  field("snap_scale", t.snap_scale);
  field("proportional", t.proportional);
  field("proportional_radius", t.proportional_radius);
  field("falloff", t.falloff);
  field("connected_only", t.connected_only);
  field("symmetric", t.symmetric);
  field("symmetry_axis", t.symmetry_axis);
  field("stop_at_contact", t.stop_at_contact);
}

template <class T> constexpr int last_of = 0;
template <> constexpr int last_of<Tool> = static_cast<int>(Tool::scale);
template <> constexpr int last_of<AxesKind> = static_cast<int>(AxesKind::view);
template <> constexpr int last_of<Pivot> = static_cast<int>(Pivot::individual);
template <> constexpr int last_of<Falloff> = static_cast<int>(Falloff::sharp);

template <class T> QJsonObject fields_to_json(T values) {
  QJsonObject json;
  visit(values, [&](const char* name, const auto& value) {
    using V = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<V>) {
      json[QLatin1String(name)] = static_cast<int>(value);
    } else {
      json[QLatin1String(name)] = value;
    }
  });
  return json;
}

template <class T> T fields_from_json(const QJsonObject& json) {
  T values;
  visit(values, [&](const char* name, auto& value) {
    using V = std::decay_t<decltype(value)>;
    const QJsonValue stored = json[QLatin1String(name)];
    if constexpr (std::is_enum_v<V>) {
      const int number = stored.toInt(static_cast<int>(value));
      if (number >= 0 && number <= last_of<V>) {
        value = static_cast<V>(number);
      }
    } else if constexpr (std::is_same_v<V, bool>) {
      value = stored.toBool(value);
    } else if constexpr (std::is_same_v<V, int>) {
      value = stored.toInt(value);
    } else {
      value = stored.toDouble(value);
    }
  });
  return values;
}

Error malformed(const fs::path& path, const std::string& what) {
  return {ErrorCode::malformed, path.string() + ": " + what};
}

/// Positions, all finite; nothing where they are not.
std::optional<std::vector<Vec3>> positions_from(const QJsonValue& json) {
  std::vector<Vec3> positions;
  if (!json.isArray()) {
    return std::nullopt;
  }
  for (const QJsonValue& entry : json.toArray()) {
    const QJsonArray xyz = entry.toArray();
    if (xyz.size() != 3 || !xyz[0].isDouble() || !xyz[1].isDouble() || !xyz[2].isDouble()) {
      return std::nullopt;
    }
    positions.emplace_back(xyz[0].toDouble(), xyz[1].toDouble(), xyz[2].toDouble());
    if (!positions.back().allFinite()) {
      return std::nullopt;
    }
  }
  return positions;
}

Status read_cage(const QJsonObject& json, const fs::path& path, State& state) {
  auto vertices = positions_from(json["vertices"]);
  if (!vertices) {
    return malformed(path, "the cage's vertices are not triples of numbers");
  }
  PolygonMesh mesh;
  mesh.positions = *std::move(vertices);
  for (const QJsonValue& face : json["faces"].toArray()) {
    std::vector<Index> corners;
    for (const QJsonValue& corner : face.toArray()) {
      const double number = corner.toDouble(-1);
      if (!(number >= 0) || number >= static_cast<double>(mesh.positions.size()) ||
          number != std::floor(number)) {
        return malformed(path, "a face of the cage refers to a vertex that is not there");
      }
      corners.push_back(static_cast<Index>(number));
    }
    if (corners.size() < 3) {
      return malformed(path, "a face of the cage has fewer than three corners");
    }
    mesh.add_face(corners);
  }
  if (mesh.face_count() == 0) {
    return malformed(path, "the cage has no faces");
  }
  state.rest = std::make_shared<const PolygonMesh>(std::move(mesh));
  return success();
}

/// Positions of the whole cage.
Result<SharedPositions> read_pose(const QJsonValue& json, const State& state,
                                  const fs::path& path) {
  auto positions = positions_from(json);
  if (!positions || !state.rest || positions->size() != state.rest->positions.size()) {
    return malformed(path, "a pose does not have as many vertices as the cage");
  }
  return std::make_shared<const std::vector<Vec3>>(*std::move(positions));
}

Status read_poses(const QJsonObject& json, const fs::path& path, State& state) {
  for (const QJsonValue& entry : json["poses"].toArray()) {
    const Result<SharedPositions> positions = read_pose(entry["positions"], state, path);
    if (!positions) {
      return positions.error();
    }
    state.poses.push_back({entry["name"].toString(), *positions});
  }
  const QJsonObject line = json["time_line"].toObject();
  state.time_line.first = line["first"].toInt(state.time_line.first);
  state.time_line.last =
      std::max(line["last"].toInt(state.time_line.last), state.time_line.first + 1);
  const double rate = line["frames_per_second"].toDouble(state.time_line.frames_per_second);
  state.time_line.frames_per_second = std::clamp(rate, 1.0, 240.0);
  int last_frame = std::numeric_limits<int>::min();
  for (const QJsonValue& entry : line["keys"].toArray()) {
    const Result<SharedPositions> positions = read_pose(entry["positions"], state, path);
    if (!positions) {
      return positions.error();
    }
    const int frame = entry["frame"].toInt();
    if (frame <= last_frame) {
      return malformed(path, "the keyframes are not in order");
    }
    last_frame = frame;
    state.time_line.keys.push_back({frame, *positions});
  }
  return success();
}

QJsonObject model_to_json(const Project& project, const fs::path& path) {
  std::error_code error;
  const fs::path relative = fs::relative(project.model_path, path.parent_path(), error);
  return {{"path", QString::fromStdString(project.model_path.string())},
          {"relative_path", error ? QString() : QString::fromStdString(relative.string())},
          {"checksum", QString::number(project.model_checksum, 16)}};
}

} // namespace

Status write_project(const Project& project, const fs::path& path) {
  QJsonObject json{{"format", "cagewright-project"}, {"version", version}};
  if (!project.model_path.empty()) {
    json["model"] = model_to_json(project, path);
  }
  const State& state = project.state;
  if (state.rest) {
    json["cage"] = QJsonObject{{"vertices", to_json(state.rest->positions)},
                               {"faces", faces_to_json(*state.rest)}};
    json["pose"] = to_json(*state.cage);
    json["bound"] = project.bound;
    QJsonArray poses;
    for (const Pose& pose : state.poses) {
      poses.append(QJsonObject{{"name", pose.name}, {"positions", to_json(*pose.positions)}});
    }
    json["poses"] = poses;
    QJsonArray keys;
    for (const Keyframe& key : state.time_line.keys) {
      keys.append(QJsonObject{{"frame", key.frame}, {"positions", to_json(*key.positions)}});
    }
    json["time_line"] = QJsonObject{{"first", state.time_line.first},
                                    {"last", state.time_line.last},
                                    {"frames_per_second", state.time_line.frames_per_second},
                                    {"keys", keys}};
  }
  json["generate"] = to_json(project.settings);
  json["view"] = QJsonObject{{"camera", project.camera},
                             {"layers", fields_to_json(project.layers)},
                             {"tools", fields_to_json(project.tools)}};
  const QByteArray bytes = QJsonDocument(json).toJson();
  return write_file_atomically(path, {bytes.constData(), static_cast<std::size_t>(bytes.size())});
}

Result<Project> read_project(const fs::path& path) {
  QFile file(QString::fromStdString(path.string()));
  if (!file.open(QIODevice::ReadOnly)) {
    return Error{ErrorCode::cannot_open, path.string() + ": " + file.errorString().toStdString()};
  }
  QJsonParseError parse;
  const QJsonObject json = QJsonDocument::fromJson(file.readAll(), &parse).object();
  if (parse.error != QJsonParseError::NoError) {
    return malformed(path, parse.errorString().toStdString() + " at byte " +
                               std::to_string(parse.offset));
  }
  if (json["format"].toString() != "cagewright-project") {
    return malformed(path, "this is not a Cagewright project");
  }
  if (json["version"].toInt() > version) {
    return Error{ErrorCode::unsupported,
                 path.string() + ": the project was saved by a newer Cagewright"};
  }
  Project project;
  if (const QJsonObject model = json["model"].toObject(); !model.isEmpty()) {
    project.model_path = model["path"].toString().toStdString();
    project.model_checksum = model["checksum"].toString().toULongLong(nullptr, 16);
    const fs::path beside =
        (path.parent_path() / model["relative_path"].toString().toStdString()).lexically_normal();
    std::error_code error;
    if (!model["relative_path"].toString().isEmpty() && fs::exists(beside, error)) {
      project.model_path = fs::absolute(beside, error);
    }
  }
  if (json["cage"].isObject()) {
    if (Status s = read_cage(json["cage"].toObject(), path, project.state); !s) {
      return s.error();
    }
    Result<SharedPositions> pose = read_pose(json["pose"], project.state, path);
    if (!pose) {
      return pose.error();
    }
    project.state.cage = *pose;
    if (Status s = read_poses(json, path, project.state); !s) {
      return s.error();
    }
    project.bound = json["bound"].toBool();
  }
  project.settings = generate_settings_from_json(json["generate"].toObject());
  const QJsonObject view = json["view"].toObject();
  project.camera = view["camera"].toObject();
  project.layers = fields_from_json<Layers>(view["layers"].toObject());
  project.tools = fields_from_json<ToolSettings>(view["tools"].toObject());
  return project;
}

} // namespace cagewright::app
