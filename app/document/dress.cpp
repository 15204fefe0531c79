#include "app/document/dress.h"

#include <QByteArray>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QPainter>
#include <QTextStream>
#include <QUrl>
#include <QtEndian>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace cagewright::app {
namespace {

// Of all textures together; what any graphics card takes.
constexpr int atlas_side = 4096;
constexpr int greatest_texture = 2048;

QString text(const std::string& s) {
  return QString::fromStdString(s);
}

QImage texture_in(const QDir& folder, const QString& name) {
  QString path = name;
  path.replace('\\', '/'); // as programs on Windows write it
  return QImage(folder.filePath(path));
}

// ---------------------------------------------------------------- OBJ

/// The materials of a library, by their names.
void read_mtl(const QString& path, std::map<QString, Material>& found) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly | QIODevice::Text)) {
    return;
  }
  const QDir folder = QFileInfo(path).dir();
  Material* material = nullptr;
  QTextStream stream(&file);
  for (QString line; stream.readLineInto(&line);) {
    line = line.trimmed();
    const QString key = line.section(' ', 0, 0, QString::SectionSkipEmpty).toLower();
    const QString rest = line.section(' ', 1, -1, QString::SectionSkipEmpty).trimmed();
    if (key == "newmtl") {
      material = &found[rest];
    } else if (material != nullptr && key == "kd") {
      const QStringList numbers = rest.split(' ', Qt::SkipEmptyParts);
      for (qsizetype i = 0; i < 3 && i < numbers.size(); ++i) {
        material->color[static_cast<std::size_t>(i)] = std::clamp(numbers[i].toFloat(), 0.0F, 1.0F);
      }
    } else if (material != nullptr && key == "map_kd") {
      // Options come before the name, which may have blanks: the longest end that is a file.
      for (int word = 0; material->texture.isNull() && word <= rest.count(' '); ++word) {
        material->texture =
            texture_in(folder, rest.section(' ', word, -1, QString::SectionSkipEmpty));
      }
    }
  }
  for (auto& [name, m] : found) {
    if (!m.texture.isNull() && m.color == std::array<float, 3>{0, 0, 0}) {
      m.color = {1, 1, 1}; // written so by programs that mean the texture alone
    }
  }
}

std::vector<Material> obj_materials(const QDir& folder, const MeshAttributes& attributes) {
  std::map<QString, Material> found;
  for (const std::string& library : attributes.material_files) {
    read_mtl(folder.filePath(text(library)), found);
  }
  std::vector<Material> materials;
  for (const std::string& name : attributes.material_names) {
    const auto at = found.find(text(name));
    materials.push_back(at == found.end() ? Material() : at->second);
  }
  return materials;
}

// ---------------------------------------------------------------- glTF

QByteArray bytes_at(const QString& uri, const QDir& folder) {
  if (uri.startsWith("data:")) {
    const qsizetype comma = uri.indexOf(',');
    return QByteArray::fromBase64(uri.mid(comma + 1).toLatin1());
  }
  QFile file(folder.filePath(QUrl::fromPercentEncoding(uri.toUtf8())));
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}

class GltfMaterials {
public:
  explicit GltfMaterials(const QString& path) : folder_(QFileInfo(path).dir()) {
    QFile file(path);
    if (!file.open(QIODevice::ReadOnly)) {
      return;
    }
    const QByteArray bytes = file.readAll();
    QByteArray json = bytes;
    if (bytes.startsWith("glTF")) {
      json.clear();
      for (qsizetype at = 12; at + 8 <= bytes.size();) {
        const auto size = static_cast<qsizetype>(qFromLittleEndian<quint32>(bytes.data() + at));
        const QByteArray kind = bytes.mid(at + 4, 4);
        if (kind == "JSON") {
          json = bytes.mid(at + 8, size);
        } else if (kind == QByteArray("BIN\0", 4)) {
          binary_ = bytes.mid(at + 8, size);
        }
        at += 8 + size;
      }
    }
    root_ = QJsonDocument::fromJson(json).object();
  }

  [[nodiscard]] Material named(const QString& name) const {
    const QJsonArray all = root_["materials"].toArray();
    for (qsizetype i = 0; i < all.size(); ++i) {
      const QString own = all[i].toObject()["name"].toString();
      if (own == name || (own.isEmpty() && name == QString("material %1").arg(i))) {
        return material(all[i].toObject()["pbrMetallicRoughness"].toObject());
      }
    }
    return {};
  }

private:
  [[nodiscard]] Material material(const QJsonObject& surface) const {
    Material found;
    const QJsonArray factor = surface["baseColorFactor"].toArray();
    for (qsizetype i = 0; i < 3 && i < factor.size(); ++i) {
      // Factors are linear.
      found.color[static_cast<std::size_t>(i)] =
          static_cast<float>(std::pow(std::clamp(factor[i].toDouble(1), 0.0, 1.0), 1 / 2.2));
    }
    const QJsonObject texture =
        element("textures", surface["baseColorTexture"].toObject()["index"].toInt(-1));
    const QJsonObject image = element("images", texture["source"].toInt(-1));
    if (!image.isEmpty()) {
      found.texture =
          QImage::fromData(image.contains("uri") ? bytes_at(image["uri"].toString(), folder_)
                                                 : view(image["bufferView"].toInt(-1)));
    }
    return found;
  }
  [[nodiscard]] QJsonObject element(const char* list, int number) const {
    return root_[list].toArray().at(number).toObject();
  }
  [[nodiscard]] QByteArray view(int number) const {
    const QJsonObject slice = element("bufferViews", number);
    const QJsonObject buffer = element("buffers", slice["buffer"].toInt(-1));
    const QByteArray bytes =
        buffer.contains("uri") ? bytes_at(buffer["uri"].toString(), folder_) : binary_;
    return bytes.mid(slice["byteOffset"].toInt(0), slice["byteLength"].toInt(0));
  }

  QDir folder_;
  QByteArray binary_;
  QJsonObject root_;
};

// ---------------------------------------------------------------- the atlas

struct Atlas {
  QImage image;
  std::vector<std::array<float, 4>> places; // of the materials
};

/// All textures in a grid, made smaller where they would be too large together.
Atlas make_atlas(std::span<const Material> materials) {
  Atlas atlas;
  atlas.places.resize(materials.size(), {0, 0, 0, 0});
  std::vector<std::size_t> textured;
  int greatest = 0;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    if (const QImage& texture = materials[m].texture; !texture.isNull()) {
      textured.push_back(m);
      greatest = std::max({greatest, texture.width(), texture.height()});
    }
  }
  if (textured.empty()) {
    return atlas;
  }
  const int columns = static_cast<int>(std::ceil(std::sqrt(textured.size())));
  const int rows = (static_cast<int>(textured.size()) + columns - 1) / columns;
  const int cell = std::min({greatest, greatest_texture, std::max(1, atlas_side / columns)});
  atlas.image = QImage(columns * cell, rows * cell, QImage::Format_RGBA8888);
  atlas.image.fill(Qt::white);
  QPainter painter(&atlas.image);
  painter.setCompositionMode(QPainter::CompositionMode_Source);
  for (std::size_t i = 0; i < textured.size(); ++i) {
    QImage texture = materials[textured[i]].texture.mirrored(); // its first row below
    if (texture.width() > cell || texture.height() > cell) {
      texture = texture.scaled(cell, cell, Qt::KeepAspectRatio, Qt::SmoothTransformation);
    }
    const int x = static_cast<int>(i) % columns * cell;
    const int y = static_cast<int>(i) / columns * cell;
    painter.drawImage(x, y, texture);
    const auto width = static_cast<float>(atlas.image.width());
    const auto height = static_cast<float>(atlas.image.height());
    atlas.places[textured[i]] = {static_cast<float>(x) / width, static_cast<float>(y) / height,
                                 static_cast<float>(texture.width()) / width,
                                 static_cast<float>(texture.height()) / height};
  }
  return atlas;
}

std::uint8_t byte_of(float c) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(c, 0.0F, 1.0F)));
}

/// What makes a drawn vertex: vertex of the model, texture point, material, color.
using DrawnVertex = std::tuple<Index, Index, Index, std::uint32_t>;

struct HashOfDrawn {
  std::size_t operator()(const DrawnVertex& v) const {
    std::size_t hash = 0;
    const auto add = [&](std::size_t n) {
      hash ^= n + 0x9e3779b97f4a7c15ULL + (hash << 6U) + (hash >> 2U);
    };
    add(std::get<0>(v));
    add(std::get<1>(v));
    add(std::get<2>(v));
    add(std::get<3>(v));
    return hash;
  }
};

} // namespace

std::optional<FileDress> read_dress(const std::filesystem::path& path, MeshAttributes attributes) {
  const QString file = text(path.string());
  const QDir folder = QFileInfo(file).dir();
  const QString suffix = QFileInfo(file).suffix().toLower();
  FileDress dress;
  if (suffix == "gltf" || suffix == "glb") {
    const GltfMaterials materials(file);
    for (const std::string& name : attributes.material_names) {
      dress.materials.push_back(materials.named(text(name)));
    }
  } else {
    dress.materials = obj_materials(folder, attributes);
  }
  Material rest;
  for (const std::string& comment : attributes.comments) {
    const QString line = text(comment).trimmed();
    if (line.startsWith("TextureFile ") && rest.texture.isNull()) { // as MeshLab writes it
      rest.texture = texture_in(folder, line.mid(12).trimmed());
    }
  }
  dress.materials.push_back(std::move(rest));
  const bool says_something =
      !attributes.face_colors.empty() ||
      std::ranges::any_of(dress.materials, [](const Material& m) {
        return !m.texture.isNull() || m.color != std::array<float, 3>{1, 1, 1};
      });
  if (!says_something) {
    return std::nullopt;
  }
  dress.attributes = std::move(attributes);
  return dress;
}

std::shared_ptr<const Dress> make_dress(std::span<const DressedPart> parts,
                                        const Triangulation& cut,
                                        std::span<const std::array<float, 4>> colors,
                                        std::span<const Triangle> coarse,
                                        std::span<const std::array<Index, 2>> edges) {
  std::vector<Material> materials;
  std::vector<Index> first_material;
  for (const DressedPart& part : parts) {
    first_material.push_back(static_cast<Index>(materials.size()));
    if (part.dress != nullptr) {
      materials.insert(materials.end(), part.dress->materials.begin(), part.dress->materials.end());
    } else {
      materials.emplace_back();
    }
  }
  const Atlas atlas = make_atlas(materials);
  auto dress = std::make_shared<Dress>();
  dress->atlas = atlas.image;
  dress->triangles.reserve(cut.triangles.size());
  std::unordered_map<DrawnVertex, Index, HashOfDrawn> drawn;
  std::size_t triangle = 0;
  std::size_t first_face = 0;
  static const MeshAttributes bare;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PolygonMesh& mesh = *parts[p].mesh;
    const MeshAttributes& attributes = parts[p].dress ? parts[p].dress->attributes : bare;
    const std::size_t own_materials = parts[p].dress ? parts[p].dress->materials.size() : 1;
    const std::size_t end = first_face + mesh.face_count();
    std::size_t corner = 0; // of the face, in the part
    std::size_t face = first_face;
    for (; triangle < cut.triangles.size() && cut.face_of[triangle] < end; ++triangle) {
      for (; face < cut.face_of[triangle]; ++face) {
        corner += mesh.face(face - first_face).size();
      }
      const std::size_t f = face - first_face;
      std::size_t own = own_materials - 1;
      if (f < attributes.face_materials.size() &&
          attributes.face_materials[f] + 1 < own_materials) {
        own = attributes.face_materials[f];
      }
      const Index material = first_material[p] + static_cast<Index>(own);
      std::array<float, 4> of_face = {1, 1, 1, 1};
      if (f < attributes.face_colors.size()) {
        of_face = attributes.face_colors[f];
      }
      Triangle made;
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = cut.triangles[triangle][k];
        const std::span<const Index> ring = mesh.face(f);
        const auto at = static_cast<std::size_t>(
            std::ranges::find(ring, v - parts[p].first_vertex) - ring.begin());
        Index point = MeshAttributes::none;
        if (corner + at < attributes.texture_of_corner.size()) {
          point = attributes.texture_of_corner[corner + at];
        }
        std::array<std::uint8_t, 4> color = {0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c) {
          const float of_vertex = v < colors.size() ? colors[v][c] : 1;
          color[c] = byte_of(materials[material].color[c] * of_face[c] * of_vertex);
        }
        const std::uint32_t packed =
            color[0] | std::uint32_t{color[1]} << 8U | std::uint32_t{color[2]} << 16U;
        const auto [known, is_new] = drawn.try_emplace(DrawnVertex{v, point, material, packed},
                                                       static_cast<Index>(dress->vertex_of.size()));
        if (is_new) {
          const bool has_point = point < attributes.texture_points.size();
          dress->vertex_of.push_back(v);
          dress->colors.push_back(color);
          dress->texture_points.push_back(
              has_point
                  ? std::array<float, 2>{static_cast<float>(attributes.texture_points[point][0]),
                                         static_cast<float>(attributes.texture_points[point][1])}
                  : std::array<float, 2>{0, 0});
          dress->places.push_back(has_point ? atlas.places[material]
                                            : std::array<float, 4>{0, 0, 0, 0});
        }
        made[k] = known->second;
      }
      dress->triangles.push_back(made);
    }
    first_face = end;
  }
  // From afar one of a vertex's places in the texture is as good as another.
  Index end = 0; // of the vertices that triangles use
  for (const Index v : dress->vertex_of) {
    end = std::max(end, v + 1);
  }
  std::vector<Index> any(end, 0);
  for (auto d = static_cast<Index>(dress->vertex_of.size()); d-- > 0;) {
    any[dress->vertex_of[d]] = d;
  }
  const auto is_drawn = [&](Index v) { return v < end && dress->vertex_of[any[v]] == v; };
  for (const Triangle& t : coarse) {
    if (is_drawn(t[0]) && is_drawn(t[1]) && is_drawn(t[2])) {
      dress->coarse.push_back({any[t[0]], any[t[1]], any[t[2]]});
    }
  }
  for (const auto& [a, b] : edges) {
    if (is_drawn(a) && is_drawn(b)) {
      dress->edges.push_back({any[a], any[b]});
    }
  }
  return dress;
}

} // namespace cagewright::app
