#include "deform/weights_text.h"

#include "core/memory.h"
#include "core/parse.h"
#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/source.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

constexpr std::string_view csv_mark = "# cagewright weights";
constexpr std::string_view csv_end = "# end"; // without it a file that was cut off looks whole
constexpr std::string_view json_mark = "cagewright-weights";
constexpr std::string_view groups_mark = "cagewright-vertex-groups";
constexpr std::string_view csv_options = "# options ";
constexpr std::string_view csv_columns = "# columns ";
constexpr int version = 1;

void append_place(std::string& text, const Vec3& p, std::string_view between) {
  append_number(text, p.x());
  text += between;
  append_number(text, p.y());
  text += between;
  append_number(text, p.z());
}

/// What all text files share: a file, and how wide a row is.
class TextSink : public RowSink {
public:
  TextSink(PartFile file, std::size_t width) : file_(std::move(file)), width_(width) {}

protected:
  Status write(std::string_view text) { return file_.append(text); }
  Status commit() { return file_.commit(); }
  [[nodiscard]] std::size_t width() const { return width_; }

private:
  PartFile file_;
  std::size_t width_;
};

/// Lines "model_vertex,column,weight" of all weights but zeros, after lines beginning with #
/// that say what they are for.
class CsvSink : public TextSink {
public:
  using TextSink::TextSink;

  Status begin(const WeightsIdentity& identity) {
    const PolygonMesh& cage = identity.cage;
    std::string text(csv_mark);
    text += ", version " + std::to_string(version) + ", " + identity.settings.name() + '\n';
    text += std::string(csv_options) + identity.settings.text() + '\n';
    text += std::string(csv_columns) + text_of(identity.rule.groups()) + '\n';
    text += "# model " + std::to_string(identity.points.size()) + ' ' +
            std::to_string(checksum(identity.points)) + '\n';
    for (const Vec3& p : cage.positions) {
      text += "# v ";
      append_place(text, p, " ");
      text += '\n';
    }
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      text += "# f";
      for (const Index v : cage.face(f)) {
        text += ' ' + std::to_string(v);
      }
      text += '\n';
    }
    return write(text + (identity.rule.columns() == cage.positions.size()
                             ? "model_vertex,cage_vertex,weight\n"
                             : "model_vertex,column,weight\n"));
  }

  Status rows(std::span<const float> block) override {
    std::string text;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block[i] != 0) {
        append_number(text, row_ + i / width());
        text += ',';
        append_number(text, i % width());
        text += ',';
        append_number(text, block[i]);
        text += '\n';
      }
    }
    row_ += block.size() / width();
    return write(text);
  }

  Status finish() override {
    Status status = write(std::string(csv_end) + '\n');
    return status ? commit() : status;
  }

private:
  std::size_t row_ = 0;
};

/// One object; "weights" has a list for each vertex of the model.
class JsonSink : public TextSink {
public:
  using TextSink::TextSink;

  Status begin(const WeightsIdentity& identity) {
    const PolygonMesh& cage = identity.cage;
    std::string text = "{\"format\": \"" + std::string(json_mark) +
                       "\", \"version\": " + std::to_string(version) + ", \"kind\": \"" +
                       identity.settings.name() + "\", \"options\": \"" + identity.settings.text() +
                       "\", \"columns\": \"" + text_of(identity.rule.groups()) +
                       "\",\n \"model_vertices\": " + std::to_string(identity.points.size()) +
                       ", \"model_checksum\": \"" + std::to_string(checksum(identity.points)) +
                       "\",\n \"cage_positions\": [";
    for (std::size_t v = 0; v < cage.positions.size(); ++v) {
      text += v == 0 ? "[" : ", [";
      append_place(text, cage.positions[v], ", ");
      text += ']';
    }
    text += "],\n \"cage_faces\": [";
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      text += f == 0 ? "[" : ", [";
      for (std::size_t k = 0; k < cage.face(f).size(); ++k) {
        text += (k == 0 ? "" : ", ") + std::to_string(cage.face(f)[k]);
      }
      text += ']';
    }
    return write(text + "],\n \"weights\": [");
  }

  Status rows(std::span<const float> block) override {
    std::string text;
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (i % width() == 0) {
        text += is_first_ ? "\n  [" : ",\n  [";
        is_first_ = false;
      } else {
        text += ", ";
      }
      append_number(text, block[i]);
      if (i % width() + 1 == width()) {
        text += ']';
      }
    }
    return write(text);
  }

  Status finish() override {
    Status status = write("]}\n");
    return status ? commit() : status;
  }

private:
  bool is_first_ = true;
};

/// Formats by columns: all rows are kept until the end.
class ColumnSink : public TextSink {
public:
  using TextSink::TextSink;

  Status rows(std::span<const float> block) override {
    all_.insert(all_.end(), block.begin(), block.end());
    return success();
  }

protected:
  [[nodiscard]] std::size_t height() const { return all_.size() / width(); }
  [[nodiscard]] float at(std::size_t row, std::size_t column) const {
    return all_[row * width() + column];
  }

private:
  std::vector<float> all_;
};

/// libigl's: "columns rows", then the numbers column by column.
class DmatSink : public ColumnSink {
public:
  using ColumnSink::ColumnSink;

  Status finish() override {
    Status status = write(std::to_string(width()) + ' ' + std::to_string(height()) + '\n');
    for (std::size_t column = 0; status && column < width(); ++column) {
      std::string text;
      for (std::size_t row = 0; row < height(); ++row) {
        append_number(text, at(row, column));
        text += '\n';
      }
      status = write(text);
    }
    return status ? commit() : status;
  }
};

/// A group of the model's vertices for each vertex of the cage.
class GroupsSink : public ColumnSink {
public:
  using ColumnSink::ColumnSink;

  Status finish() override {
    Status status = write("{\"format\": \"" + std::string(groups_mark) +
                          "\", \"version\": " + std::to_string(version) +
                          ", \"vertices\": " + std::to_string(height()) + ",\n \"groups\": [");
    for (std::size_t column = 0; status && column < width(); ++column) {
      std::string vertices;
      std::string weights;
      for (std::size_t row = 0; row < height(); ++row) {
        if (at(row, column) != 0) {
          vertices += (vertices.empty() ? "" : ", ") + std::to_string(row);
          weights += weights.empty() ? "" : ", ";
          append_number(weights, at(row, column));
        }
      }
      status = write(std::string(column == 0 ? "\n" : ",\n") + "  {\"name\": \"cage_" +
                     std::to_string(column) + "\", \"vertices\": [" + vertices +
                     "], \"weights\": [" + weights + "]}");
    }
    if (status) {
      status = write("]}\n");
    }
    return status ? commit() : status;
  }
};

template <class Sink>
Result<std::unique_ptr<RowSink>> begun(std::unique_ptr<Sink> sink,
                                       const WeightsIdentity& identity) {
  if (Status status = sink->begin(identity); !status) {
    return status.error();
  }
  return std::unique_ptr<RowSink>(std::move(sink));
}

/// The lines of a text, counted from 1.
class Lines {
public:
  explicit Lines(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    if (text_.empty()) {
      return false;
    }
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line = text_.substr(0, end);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++number_;
    return true;
  }
  [[nodiscard]] std::size_t number() const { return number_; }

private:
  std::string_view text_;
  std::size_t number_ = 0;
};

/// Takes numbers between blanks and commas; false at something else or at the end.
template <class Number> bool take(std::string_view& text, Number& value) {
  text.remove_prefix(std::min(text.find_first_not_of(" ,\t\r\n"), text.size()));
  return take_number(text, value);
}

/// A matrix that a file may ask for: its numbers take at least two bytes each.
bool is_plausible(std::size_t points, std::size_t width, std::size_t numbers) {
  return width > 0 && width <= std::numeric_limits<std::int32_t>::max() &&
         points <= std::numeric_limits<std::int32_t>::max() && points <= numbers / width;
}

class Reader {
public:
  Reader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<StoredWeights> csv() const {
    StoredWeights stored;
    Lines lines(bytes_);
    std::string_view line;
    std::string kind;
    std::string options;
    std::string columns_text;
    std::size_t points = 0;
    bool has_model = false;
    while (lines.next(line) && line.starts_with('#')) {
      if (line.starts_with("# model ")) {
        line.remove_prefix(8);
        has_model = take(line, points) && take(line, stored.model_checksum);
      } else if (line.starts_with("# v ")) {
        line.remove_prefix(4);
        Vec3 p;
        if (!take(line, p.x()) || !take(line, p.y()) || !take(line, p.z()) || !p.allFinite()) {
          return in_line(lines, "a vertex of the cage should have three numbers");
        }
        stored.cage.positions.push_back(p);
      } else if (line.starts_with("# f ")) {
        line.remove_prefix(4);
        std::vector<Index> face;
        for (Index v = 0; take(line, v);) {
          face.push_back(v);
        }
        stored.cage.add_face(face);
      } else if (line.starts_with(csv_options)) {
        options = line.substr(csv_options.size());
      } else if (line.starts_with(csv_columns)) {
        columns_text = line.substr(csv_columns.size());
      } else if (line.starts_with(csv_mark)) {
        const std::string expected =
            std::string(csv_mark) + ", version " + std::to_string(version) + ", ";
        if (!line.starts_with(expected)) {
          return Error{ErrorCode::unsupported,
                       name_ + ": weights of another version; bind the model again"};
        }
        kind = line.substr(expected.size());
      }
    }
    if (Status status = check_faces(stored.cage); !status) {
      return status.error();
    }
    const Result<std::size_t> columns = set_kind(stored, kind, options, columns_text);
    if (!columns) {
      return columns.error();
    }
    const std::size_t width = *columns;
    // Each row has a line at least, unless its vertex has no weights.
    if (!has_model || !is_plausible(points, width, memory_numbers())) {
      return damaged("it does not say what model and cage it is for");
    }
    stored.weights = FloatWeights(points, width);
    fill_zero(stored.weights);
    bool is_whole = false;
    while (lines.next(line)) {
      std::size_t row = 0;
      std::size_t column = 0;
      double weight = 0;
      if (line.empty() || line == csv_end) {
        is_whole = is_whole || !line.empty();
        continue;
      }
      if (!take(line, row) || !take(line, column) || !take(line, weight) || !line.empty() ||
          row >= points || column >= width || !std::isfinite(weight)) {
        return in_line(lines, "a line should have a vertex of the model, a column and a weight");
      }
      set(stored.weights, row, column, weight);
    }
    if (!is_whole) {
      return damaged("its last line, '# end', is missing");
    }
    return stored;
  }

  Result<StoredWeights> dmat() const {
    std::string_view text = bytes_;
    std::size_t width = 0;
    std::size_t points = 0;
    if (!take(text, width) || !take(text, points) || !is_plausible(points, width, text.size())) {
      return damaged("it should begin with the numbers of columns and rows");
    }
    StoredWeights stored;
    stored.has_identity = false;
    stored.weights = FloatWeights(points, width);
    fill_zero(stored.weights);
    for (std::size_t column = 0; column < width; ++column) {
      for (std::size_t row = 0; row < points; ++row) {
        double weight = 0;
        if (!take(text, weight) || !std::isfinite(weight)) {
          return damaged("number " + std::to_string(column * points + row) + " is missing or none");
        }
        set(stored.weights, row, column, weight);
      }
    }
    if (text.find_first_not_of(" \t\r\n") != text.npos) {
      return damaged("more numbers follow than it says there are");
    }
    return stored;
  }

  Result<StoredWeights> json() const {
    const nlohmann::json json = nlohmann::json::parse(bytes_, nullptr, false);
    if (json.is_discarded() || !json.is_object()) {
      return damaged("it is no JSON object");
    }
    if (json.value("format", nlohmann::json()) == groups_mark) {
      return Error{ErrorCode::unsupported,
                   name_ + ": groups of vertices do not say which cage they are of; bind the model "
                           "to a .npz, .csv or .json file as well"};
    }
    if (json.value("format", nlohmann::json()) != json_mark) {
      return damaged("its \"format\" is not \"" + std::string(json_mark) + '"');
    }
    if (json.value("version", nlohmann::json()) != version) {
      return Error{ErrorCode::unsupported,
                   name_ + ": weights of another version; bind the model again"};
    }
    try {
      return stored_of(json);
    } catch (const nlohmann::json::exception&) { // a value of another kind than it should be
      return damaged("a value is missing or of another kind");
    }
  }

private:
  [[nodiscard]] Error damaged(const std::string& how) const {
    return {ErrorCode::malformed, name_ + ": no weights file of cagewright bind, or damaged: " +
                                      how + "; bind the model again"};
  }
  [[nodiscard]] Error in_line(const Lines& lines, const char* what) const {
    return {ErrorCode::malformed,
            name_ + ':' + std::to_string(lines.number()) + ": " + what + "; bind the model again"};
  }
  static std::size_t memory_numbers() {
    constexpr double plenty = 1e15;
    return static_cast<std::size_t>(std::min(plenty, memory_allowed() / sizeof(float)));
  }

  static void fill_zero(FloatWeights& weights) {
    for (std::size_t t = 0; t < weights.tile_count(); ++t) {
      std::fill(weights.tile(t).begin(), weights.tile(t).end(), 0.0F);
    }
  }
  static void set(FloatWeights& weights, std::size_t row, std::size_t column, double weight) {
    constexpr std::size_t height = FloatWeights::tile_points;
    weights.tile(row / height)[column * height + row % height] = static_cast<float>(weight);
  }

  /// Takes the kind and its options. \returns the number of columns.
  [[nodiscard]] Result<std::size_t> set_kind(StoredWeights& stored, std::string_view kind,
                                             std::string_view options,
                                             std::string_view columns) const {
    Result<CoordinateSettings> settings = settings_of_file(kind, options, name_);
    if (!settings) {
      return settings.error();
    }
    stored.settings = *std::move(settings);
    return columns_of_file(stored, columns, name_);
  }

  [[nodiscard]] Status check_faces(const PolygonMesh& cage) const {
    for (std::size_t f = 0; f < cage.face_count(); ++f) {
      if (cage.face(f).size() < 3 ||
          std::any_of(cage.face(f).begin(), cage.face(f).end(),
                      [&](Index v) { return v >= cage.positions.size(); })) {
        return damaged("face " + std::to_string(f) + " of the cage has no three vertices");
      }
    }
    return success();
  }

  [[nodiscard]] Result<StoredWeights> stored_of(const nlohmann::json& json) const {
    StoredWeights stored;
    const auto sum = json.at("model_checksum").get<std::string>();
    std::string_view digits = sum;
    if (!take(digits, stored.model_checksum)) {
      return damaged("model_checksum is no number");
    }
    for (const nlohmann::json& p : json.at("cage_positions")) {
      stored.cage.positions.emplace_back(p.at(0).get<double>(), p.at(1).get<double>(),
                                         p.at(2).get<double>());
    }
    for (const nlohmann::json& face : json.at("cage_faces")) {
      stored.cage.add_face(face.get<std::vector<Index>>());
    }
    if (Status status = check_faces(stored.cage); !status) {
      return status.error();
    }
    const nlohmann::json& rows = json.at("weights");
    const Result<std::size_t> columns =
        set_kind(stored, json.at("kind").get<std::string>(), json.value("options", std::string()),
                 json.value("columns", std::string()));
    if (!columns) {
      return columns.error();
    }
    const std::size_t width = *columns;
    if (!rows.is_array() || width == 0) {
      return damaged("it has no weights or no cage");
    }
    stored.weights = FloatWeights(rows.size(), width);
    fill_zero(stored.weights);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      if (rows[row].size() != width) {
        return damaged("row " + std::to_string(row) + " of the weights has another length");
      }
      for (std::size_t column = 0; column < width; ++column) {
        const auto weight = rows[row][column].get<double>();
        if (!std::isfinite(weight)) {
          return damaged("row " + std::to_string(row) + " of the weights is not finite");
        }
        set(stored.weights, row, column, weight);
      }
    }
    return stored;
  }

  std::string_view bytes_;
  const std::string& name_;
};

} // namespace

Result<std::unique_ptr<RowSink>> text_sink(WeightsFormat format, const WeightsIdentity& identity,
                                           const std::filesystem::path& path) {
  const std::size_t width = identity.rule.columns();
  const std::vector<ColumnGroup> groups = identity.rule.groups();
  if (format == WeightsFormat::vertex_groups && width != identity.cage.positions.size()) {
    return Error{ErrorCode::unsupported,
                 one_line(path.string()) +
                     ": groups of vertices have one weight for each vertex of the cage, but " +
                     identity.settings.name() + " coordinates have " + text_of(groups) +
                     "; write .npz, or bind with coordinates of vertices alone"};
  }
  const bool by_columns = format == WeightsFormat::dmat || format == WeightsFormat::vertex_groups;
  const double bytes =
      sizeof(float) * static_cast<double>(identity.points.size()) * static_cast<double>(width);
  if (by_columns && 2 * bytes > memory_allowed()) { // twice: a vector that grows
    return Error{ErrorCode::too_large, one_line(path.string()) + ": the matrix needs " +
                                           std::to_string(std::llround(2 * bytes / 1e6)) +
                                           " MB of memory in this format; write .npz or .csv"};
  }
  Result<PartFile> file = PartFile::create(path);
  if (!file) {
    return file.error();
  }
  switch (format) {
  case WeightsFormat::csv:
    return begun(std::make_unique<CsvSink>(*std::move(file), width), identity);
  case WeightsFormat::json:
    return begun(std::make_unique<JsonSink>(*std::move(file), width), identity);
  case WeightsFormat::dmat:
    return std::unique_ptr<RowSink>(std::make_unique<DmatSink>(*std::move(file), width));
  case WeightsFormat::vertex_groups:
    return std::unique_ptr<RowSink>(std::make_unique<GroupsSink>(*std::move(file), width));
  case WeightsFormat::npz:
    break;
  }
  return Error{ErrorCode::unsupported, "no text"};
}

std::optional<WeightsFormat> text_weights_format(std::string_view bytes) {
  const std::string_view start =
      bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  if (start.starts_with(csv_mark)) {
    return WeightsFormat::csv;
  }
  if (start.starts_with('{')) {
    return WeightsFormat::json;
  }
  // Two whole numbers alone on the first line.
  std::string_view line = start.substr(0, std::min(start.find('\n'), start.size()));
  std::size_t number = 0;
  if (take(line, number) && take(line, number) && line.find_first_not_of(" \t\r") == line.npos) {
    return WeightsFormat::dmat;
  }
  return std::nullopt;
}

Result<StoredWeights> read_text_weights(std::string_view bytes, WeightsFormat format,
                                        const std::string& name) {
  const Reader reader(bytes, name);
  switch (format) {
  case WeightsFormat::csv:
    return reader.csv();
  case WeightsFormat::dmat:
    return reader.dmat();
  default:
    return reader.json();
  }
}

} // namespace cagewright
