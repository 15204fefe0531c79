#include "app/document/project_file.h"

#include "app/document/region.h"

#include "io/atomic_file.h"

#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QLocale>

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

/// Where a number may lie.
struct Range {
  double least = 0;
  double most = 0;
};

// Beyond these, squares of coordinates are no numbers any more.
constexpr Range coordinates = {-1e50, 1e50};
constexpr Range no_range = {};

/// Switches and numbers of a struct under their names, for writing and for reading alike; numbers
/// with their range.
template <class Visit> void visit(Layers& l, const Visit& field) {
  field("model", l.model, no_range);
  field("smooth_normals", l.smooth_normals, no_range);
  field("wireframe", l.wireframe, no_range);
  field("look", l.look, Range{0, static_cast<double>(SurfaceLook::own)});
  field("occlusion", l.occlusion, no_range);
  field("cage_edges", l.cage_edges, no_range);
  field("cage_faces", l.cage_faces, no_range);
  field("cage_vertices", l.cage_vertices, no_range);
  field("rest_cage", l.rest_cage, no_range);
  field("boxes", l.boxes, no_range);
  field("feature_voxels", l.feature_voxels, no_range);
  field("inner_voxels", l.inner_voxels, no_range);
  field("cuts", l.cuts, no_range);
  field("problems", l.problems, no_range);
  field("weights", l.weights, no_range);
  field("distance", l.distance, no_range);
  field("grid", l.grid, no_range);
  field("depth", l.depth, Range{-1, 1000});
}

template <class Visit> void visit(ToolSettings& t, const Visit& field) {
  field("tool", t.tool, Range{0, static_cast<double>(Tool::mix)});
  field("brush_radius", t.brush_radius, Range{1, 2000});
  field("brush_strength", t.brush_strength, Range{0.01, 1});
  field("axes", t.axes, Range{0, static_cast<double>(AxesKind::view)});
  field("pivot", t.pivot, Range{0, static_cast<double>(Pivot::individual)});
  field("see_through", t.see_through, no_range);
  field("snap", t.snap, no_range);
  field("snap_step", t.snap_step, Range{1e-6, 10});
  field("snap_angle_degrees", t.snap_angle_degrees, Range{1e-3, 360});
  field("snap_scale", t.snap_scale, Range{1e-6, 100});
  field("proportional", t.proportional, no_range);
  field("proportional_radius", t.proportional_radius, Range{1e-3, 10});
  field("falloff", t.falloff, Range{0, static_cast<double>(Falloff::sharp)});
  field("connected_only", t.connected_only, no_range);
  field("symmetric", t.symmetric, no_range);
  field("symmetry_axis", t.symmetry_axis, Range{0, 2});
  field("stop_at_contact", t.stop_at_contact, no_range);
}

template <class T> QJsonObject fields_to_json(T values) {
  QJsonObject json;
  visit(values, [&](const char* name, const auto& value, const Range&) {
    using V = std::decay_t<decltype(value)>;
    if constexpr (std::is_enum_v<V>) {
      json[QLatin1String(name)] = static_cast<int>(value);
    } else {
      json[QLatin1String(name)] = value;
    }
  });
  return json;
}

Error malformed(const fs::path& path, const std::string& what) {
  return {ErrorCode::malformed, path.string() + ": " + what};
}

/// Shortest digits that read back as the same number.
std::string to_text(double number) {
  return QString::number(number, 'g', QLocale::FloatingPointShortest).toStdString();
}

/// What is wrong with a number, if anything is.
std::optional<std::string> fault_of(const QJsonValue& json, const std::string& name,
                                    const Range& range, bool whole) {
  const double number = json.toDouble(std::numeric_limits<double>::quiet_NaN());
  if (number >= range.least && number <= range.most && (!whole || number == std::floor(number))) {
    return std::nullopt;
  }
  return name + " is " + (json.isDouble() ? to_text(number) : std::string("not a number")) +
         "; it has to be " + (whole ? "a whole number " : "") + "from " + to_text(range.least) +
         " to " + to_text(range.most);
}

/// How things are shown is not worth losing work over: what is out of range keeps its default, and
/// is noted.
template <class T>
T fields_from_json(const QJsonObject& json, const std::string& where,
                   std::vector<std::string>& notes) {
  T values;
  visit(values, [&](const char* name, auto& value, const Range& range) {
    using V = std::decay_t<decltype(value)>;
    const QJsonValue stored = json[QLatin1String(name)];
    if (stored.isUndefined()) {
      return;
    }
    if constexpr (std::is_same_v<V, bool>) {
      value = stored.toBool(value);
    } else if (const auto fault =
                   fault_of(stored, where + name, range, !std::is_same_v<V, double>)) {
      notes.push_back(*fault);
    } else {
      value = static_cast<V>(stored.toDouble());
    }
  });
  return values;
}

/// A camera, if its numbers are those of one.
QJsonObject camera_from(const QJsonObject& json, std::vector<std::string>& notes) {
  const std::pair<const char*, Range> numbers[] = {
      {"distance", {1e-50, 1e50}}, {"yaw_degrees", {-360, 360}}, {"pitch_degrees", {-90, 90}}};
  std::optional<std::string> fault;
  for (const auto& [name, range] : numbers) {
    const QJsonValue stored = json[QLatin1String(name)];
    if (!fault && !stored.isUndefined()) {
      fault = fault_of(stored, std::string("view.camera.") + name, range, false);
    }
  }
  for (const QJsonValue& part : json["target"].toArray()) {
    if (!fault) {
      fault = fault_of(part, "view.camera.target", coordinates, false);
    }
  }
  if (fault) {
    notes.push_back(*fault);
    return {};
  }
  return json;
}

/// Positions, all within range; nothing where they are not.
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
    if (!(positions.back().cwiseAbs().maxCoeff() <= coordinates.most)) {
      return std::nullopt;
    }
  }
  return positions;
}

Status read_cage(const QJsonObject& json, const fs::path& path, State& state) {
  auto vertices = positions_from(json["vertices"]);
  if (!vertices) {
    return malformed(path, "the cage's vertices are not triples of numbers from -1e50 to 1e50");
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
    return malformed(path, "a pose does not have as many vertices as the cage, each three numbers "
                           "from -1e50 to 1e50");
  }
  return std::make_shared<const std::vector<Vec3>>(*std::move(positions));
}

/// How much of a pose there may be.
std::optional<std::string> share_fault(const QJsonValue& json) {
  return json.isUndefined() ? std::nullopt
                            : fault_of(json, "the share of a pose", {-1e6, 1e6}, false);
}

/// In steps of 1/100, which is finer than one can see, packed.
QString painted_to_text(const std::vector<float>& density) {
  QByteArray steps;
  for (const float d : density) {
    steps.append(static_cast<char>(std::lround(100 * std::clamp(d, -1.0F, 1.0F))));
  }
  return QString::fromLatin1(qCompress(steps).toBase64());
}

/// \param least  none is less; 1 is the most. Null: that is no such text.
std::shared_ptr<const std::vector<float>> painted_from_text(const QString& text, int least) {
  const QByteArray packed = QByteArray::fromBase64(text.toLatin1());
  // (The first four bytes say how large it gets: what is no such thing must not be believed.)
  constexpr qsizetype most_vertices = 200'000'000;
  if (packed.size() < 5 || static_cast<quint8>(packed[0]) > (most_vertices >> 24)) {
    return nullptr;
  }
  const QByteArray steps = qUncompress(packed);
  if (steps.isEmpty()) {
    return nullptr;
  }
  std::vector<float> painted;
  painted.reserve(static_cast<std::size_t>(steps.size()));
  for (const char step : steps) {
    const int hundredths = static_cast<signed char>(step);
    if (hundredths < 100 * least || hundredths > 100) {
      return nullptr;
    }
    painted.push_back(static_cast<float>(hundredths) / 100);
  }
  return std::make_shared<const std::vector<float>>(std::move(painted));
}

Status read_poses(const QJsonObject& json, const fs::path& path, State& state) {
  for (const QJsonValue& entry : json["poses"].toArray()) {
    const Result<SharedPositions> positions = read_pose(entry["positions"], state, path);
    if (!positions) {
      return positions.error();
    }
    if (const auto fault = share_fault(entry["share"])) {
      return malformed(path, *fault);
    }
    state.poses.push_back({entry["name"].toString(), *positions, entry["share"].toDouble(0)});
  }
  const QJsonObject line = json["time_line"].toObject();
  TimeLine& time_line = state.time_line;
  const auto read = [&](const char* name, auto& value, const Range& range) -> Status {
    const QJsonValue stored = line[QLatin1String(name)];
    if (stored.isUndefined()) {
      return success();
    }
    const bool whole = !std::is_same_v<std::decay_t<decltype(value)>, double>;
    if (const auto fault = fault_of(stored, std::string("time_line.") + name, range, whole)) {
      return malformed(path, *fault);
    }
    value = static_cast<std::decay_t<decltype(value)>>(stored.toDouble());
    return success();
  };
  const Range frames = {TimeLine::least_frame, TimeLine::most_frame};
  for (const Status& s :
       {read("first", time_line.first, frames), read("last", time_line.last, frames),
        read("frames_per_second", time_line.frames_per_second, {1, 240})}) {
    if (!s) {
      return s;
    }
  }
  if (time_line.last <= time_line.first) {
    return malformed(path, "time_line.last is not after time_line.first");
  }
  int last_frame = std::numeric_limits<int>::min();
  for (const QJsonValue& entry : line["keys"].toArray()) {
    const Result<SharedPositions> positions = read_pose(entry["positions"], state, path);
    if (!positions) {
      return positions.error();
    }
    if (const auto fault = fault_of(entry["frame"], "the frame of a keyframe", frames, true)) {
      return malformed(path, *fault);
    }
    const int frame = entry["frame"].toInt();
    if (frame <= last_frame) {
      return malformed(path, "the keyframes are not in order");
    }
    last_frame = frame;
    std::vector<double> of_poses;
    for (const QJsonValue& share : entry["shares"].toArray()) {
      if (const auto fault = share_fault(share)) {
        return malformed(path, *fault);
      }
      of_poses.push_back(share.toDouble());
    }
    state.time_line.keys.push_back({frame, *positions, of_poses});
  }
  return success();
}

/// Ascending numbers as first and last of each run: 3 3, 7 90.
QJsonArray runs_to_json(const std::vector<Index>& numbers) {
  QJsonArray runs;
  for (std::size_t begin = 0, end = 0; begin < numbers.size(); begin = end) {
    for (end = begin + 1; end < numbers.size() && numbers[end] == numbers[end - 1] + 1;) {
      ++end;
    }
    runs.append(static_cast<qint64>(numbers[begin]));
    runs.append(static_cast<qint64>(numbers[end - 1]));
  }
  return runs;
}

std::optional<std::vector<Index>> runs_from_json(const QJsonArray& runs) {
  constexpr double most = 1e9;
  constexpr std::size_t most_faces = 50'000'000; // what a few words in a file may ask for
  std::vector<Index> numbers;
  for (qsizetype i = 0; i + 1 < runs.size(); i += 2) {
    if (fault_of(runs[i], {}, {0, most}, true) || fault_of(runs[i + 1], {}, {0, most}, true)) {
      return std::nullopt;
    }
    const auto first = static_cast<Index>(runs[i].toInteger());
    const auto last = static_cast<Index>(runs[i + 1].toInteger());
    if (last < first || (!numbers.empty() && first <= numbers.back()) ||
        numbers.size() + (last - first) > most_faces) {
      return std::nullopt;
    }
    for (Index n = first; n <= last; ++n) {
      numbers.push_back(n);
    }
  }
  return runs.size() % 2 == 0 ? std::optional(numbers) : std::nullopt;
}

QJsonObject place_to_json(const fs::path& file, const fs::path& project) {
  std::error_code error;
  const fs::path relative = fs::relative(file, project.parent_path(), error);
  return {{"path", QString::fromStdString(file.string())},
          {"relative_path", error ? QString() : QString::fromStdString(relative.string())}};
}

/// Where the file is now: beside the project as before, if it is there, or else where it was. No
/// file has a zero in its name: none then.
fs::path place_from(const QJsonObject& json, const fs::path& project) {
  for (const char* name : {"relative_path", "path"}) {
    if (json[QLatin1String(name)].toString().contains(QChar(0))) {
      return {};
    }
  }
  const fs::path beside =
      (project.parent_path() / json["relative_path"].toString().toStdString()).lexically_normal();
  std::error_code error;
  if (!json["relative_path"].toString().isEmpty() && fs::exists(beside, error)) {
    return fs::absolute(beside, error);
  }
  return json["path"].toString().toStdString();
}

QJsonObject model_to_json(const Project& project, const fs::path& path) {
  QJsonObject json = place_to_json(project.model_path, path);
  json["checksum"] = QString::number(project.model_checksum, 16);
  QJsonArray more;
  for (const fs::path& part : project.more_models) {
    more.append(place_to_json(part, path));
  }
  if (!more.isEmpty()) {
    json["more"] = more;
  }
  return json;
}

} // namespace

QByteArray format_project(const Project& project, const fs::path& path) {
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
      poses.append(QJsonObject{
          {"name", pose.name}, {"positions", to_json(*pose.positions)}, {"share", pose.share}});
    }
    json["poses"] = poses;
    QJsonArray keys;
    for (const Keyframe& key : state.time_line.keys) {
      QJsonArray shares;
      for (const double share : key.shares) {
        shares.append(share);
      }
      keys.append(QJsonObject{
          {"frame", key.frame}, {"positions", to_json(*key.positions)}, {"shares", shares}});
    }
    json["time_line"] = QJsonObject{{"first", state.time_line.first},
                                    {"last", state.time_line.last},
                                    {"frames_per_second", state.time_line.frames_per_second},
                                    {"keys", keys}};
  }
  if (state.region) {
    json["region"] =
        QJsonObject{{"name", state.region->name}, {"faces", runs_to_json(state.region->faces)}};
  }
  if (state.density) {
    json["density"] = painted_to_text(*state.density);
  }
  if (state.mix) {
    json["mix"] = painted_to_text(*state.mix);
  }
  if (!project.saved_as.empty()) {
    json["saved_as"] = QString::fromStdString(project.saved_as.string());
  }
  json["generate"] = to_json(project.settings);
  QJsonObject view{{"camera", project.camera},
                   {"layers", fields_to_json(project.layers)},
                   {"tools", fields_to_json(project.tools)}};
  if (project.frame) {
    view["frame"] = *project.frame;
    view["shows_frame"] = project.shows_frame;
  }
  json["view"] = view;
  return QJsonDocument(json).toJson();
}

Status write_project(const Project& project, const fs::path& path) {
  const QByteArray bytes = format_project(project, path);
  return write_file_atomically(path, {bytes.constData(), static_cast<std::size_t>(bytes.size())});
}

Result<Project> read_project(const fs::path& path) {
  QFile file(QString::fromStdString(path.string()));
  if (!file.open(QIODevice::ReadOnly)) {
    return Error{ErrorCode::cannot_open, path.string() + ": " + file.errorString().toStdString()};
  }
  return parse_project(file.readAll(), path);
}

Result<Project> parse_project(const QByteArray& bytes, const fs::path& path) {
  QJsonParseError parse;
  const QJsonObject json = QJsonDocument::fromJson(bytes, &parse).object();
  if (parse.error != QJsonParseError::NoError) {
    return malformed(path, parse.errorString().toStdString() + " at byte " +
                               std::to_string(parse.offset));
  }
  if (json["format"].toString() != "cagewright-project") {
    return malformed(path, "this is not a Cagewright project");
  }
  if (const auto fault = fault_of(json["version"], "version", {1, 1e9}, true)) {
    return malformed(path, *fault);
  }
  if (json["version"].toInt() > version) {
    return Error{ErrorCode::unsupported,
                 path.string() + ": the project was saved by a newer Cagewright"};
  }
  Project project;
  if (const QJsonObject model = json["model"].toObject(); !model.isEmpty()) {
    project.model_path = place_from(model, path);
    project.model_checksum = model["checksum"].toString().toULongLong(nullptr, 16);
    for (const QJsonValue& part : model["more"].toArray()) {
      project.more_models.push_back(place_from(part.toObject(), path));
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
  if (const QJsonObject region = json["region"].toObject(); !region.isEmpty()) {
    project.region_name = region["name"].toString();
    const auto faces = runs_from_json(region["faces"].toArray());
    if (!faces) {
      return malformed(path, "region.faces are not runs of faces, ascending");
    }
    project.region_faces = *faces;
  }
  const auto painted = [&](const char* name, int least, const char* what) {
    const QString text = json[QLatin1String(name)].toString();
    auto read = painted_from_text(text, least);
    if (!text.isEmpty() && !read) {
      project.notes.push_back(std::string(what) + " cannot be read; it is left out");
    }
    return read;
  };
  project.state.density = painted("density", -1, "the painted density");
  project.state.mix = painted("mix", 0, "what is painted for another kind of coordinates");
  if (project.state.mix &&
      std::ranges::all_of(*project.state.mix, [](float s) { return s == 0; })) {
    project.state.mix.reset();
  }
  project.settings = generate_settings_from_json(json["generate"].toObject());
  const QJsonObject view = json["view"].toObject();
  project.camera = camera_from(view["camera"].toObject(), project.notes);
  project.layers =
      fields_from_json<Layers>(view["layers"].toObject(), "view.layers.", project.notes);
  project.tools =
      fields_from_json<ToolSettings>(view["tools"].toObject(), "view.tools.", project.notes);
  if (const QJsonValue frame = view["frame"]; !frame.isUndefined()) {
    const TimeLine& line = project.state.time_line;
    if (const auto fault =
            fault_of(frame, "view.frame",
                     {static_cast<double>(line.first), static_cast<double>(line.last)}, false)) {
      project.notes.push_back(*fault);
    } else {
      project.frame = frame.toDouble();
      project.shows_frame = view["shows_frame"].toBool();
    }
  }
  project.saved_as = json["saved_as"].toString().toStdString();
  return project;
}

} // namespace cagewright::app
