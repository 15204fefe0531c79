#include <cagewright/io/model_file.h>

#include "io/read_file.h"
#include "io/readers.h"
#include "io/utf16.h"
#include <cagewright/io/write_mesh.h>

#include <mutex>
#include <optional>

namespace cagewright {
namespace {

std::optional<std::filesystem::path> folder_of(const std::filesystem::path& path, bool on_disk) {
  return on_disk ? std::optional(path.parent_path()) : std::nullopt;
}

} // namespace

struct ModelFile::Lazy {
  std::once_flag normals_read;
  std::optional<Result<FileNormals>> normals;
  std::once_flag attributes_read;
  std::optional<Result<MeshAttributes>> attributes;
};

ModelFile::ModelFile() : lazy_(std::make_shared<Lazy>()) {}

Result<ModelFile> ModelFile::open(const std::filesystem::path& path, Pose pose) {
  Result<FileBytes> bytes = read_file(path);
  if (!bytes) {
    return bytes.error();
  }
  ModelFile file;
  file.path_ = path;
  file.pose_ = pose;
  file.name_ = path.string();
  file.on_disk_ = true;
  file.hold(std::move(*bytes));
  const Source source{file.name_, file.bytes_->view()};
  std::optional<MeshFormat> format = format_of_content(source.bytes);
  if (!format) {
    if (const std::optional<Error> error = foreign_file(source)) {
      return *error;
    }
    format = format_of_name(path);
  }
  if (!format && !source.bytes.empty()) {
    return unknown_format(source);
  }
  file.format_ = format.value_or(MeshFormat::obj);
  return read(std::move(file));
}

Result<ModelFile> ModelFile::parse(std::string bytes, MeshFormat format, std::string_view name,
                                   Pose pose) {
  ModelFile file;
  file.path_ = name;
  file.pose_ = pose;
  file.name_ = name;
  file.format_ = format;
  file.hold(FileBytes(bytes));
  return read(std::move(file));
}

void ModelFile::hold(FileBytes bytes) {
  // The free text at the head of a binary STL file may begin like UTF-16.
  const bool is_binary = format_of_content(bytes.view()) == MeshFormat::stl;
  if (const auto text = is_binary ? std::nullopt : text_from_utf16(bytes.view())) {
    bytes = FileBytes(*text);
    notes_.push_back({"utf16", one_line(name_) + ": is text in UTF-16; read as such"});
  }
  bytes_ = std::make_shared<const FileBytes>(std::move(bytes));
}

Result<ModelFile> ModelFile::read(ModelFile file) {
  Reading reading;
  reading.pose = file.pose_;
  Result<PolygonMesh> mesh = read_as(file.format_, Source{file.name_, file.bytes_->view()},
                                     folder_of(file.path_, file.on_disk_), reading);
  if (!mesh) {
    return mesh.error();
  }
  file.mesh_ = std::move(*mesh);
  for (FileNote& note : reading.notes.take()) {
    file.notes_.push_back(std::move(note));
  }
  return file;
}

Result<FileNormals> ModelFile::normals() const {
  std::call_once(lazy_->normals_read, [&] {
    lazy_->normals =
        normals_in({name_, bytes_->view()}, format_, folder_of(path_, on_disk_), pose_);
  });
  return *lazy_->normals;
}

Result<MeshAttributes> ModelFile::attributes() const {
  std::call_once(lazy_->attributes_read, [&] { lazy_->attributes = read_attributes(); });
  return *lazy_->attributes;
}

Result<MeshAttributes> ModelFile::read_attributes() const {
  MeshAttributes attributes;
  Reading reading;
  reading.pose = pose_;
  reading.attributes = &attributes;
  const Result<PolygonMesh> mesh =
      read_as(format_, {name_, bytes_->view()}, folder_of(path_, on_disk_), reading);
  if (!mesh) {
    return mesh.error();
  }
  return attributes;
}

Status ModelFile::rewrite(std::span<const Vec3> positions, std::span<const Vec3> normals,
                          const std::filesystem::path& out) const {
  if (normals.empty()) {
    return rewrite_as(format_, {name_, bytes_->view()}, mesh_, path_.parent_path(), pose_,
                      positions, {}, normals, out);
  }
  const Result<FileNormals> stored = this->normals();
  return stored ? rewrite_as(format_, {name_, bytes_->view()}, mesh_, path_.parent_path(), pose_,
                             positions, *stored, normals, out)
                : stored.error();
}

bool ModelFile::keeps_format(const std::filesystem::path& out) const {
  const std::optional<MeshFormat> named = format_of_name(out);
  return named ? *named == format_ : out.extension() == path_.extension();
}

Result<std::vector<FileNote>> ModelFile::write_moved(std::span<const Vec3> positions,
                                                     std::span<const Vec3> normals,
                                                     const std::filesystem::path& out) const {
  if (keeps_format(out)) {
    const Status written = rewrite(positions, normals, out);
    return written ? Result<std::vector<FileNote>>(std::vector<FileNote>()) : written.error();
  }
  Result<MeshAttributes> dress = attributes();
  if (!dress) {
    return dress.error();
  }
  if (!normals.empty()) {
    const Result<FileNormals> stored = this->normals();
    if (!stored) {
      return stored.error();
    }
    dress->normals.assign(normals.begin(), normals.end());
    dress->normal_of_corner = stored->of_corner;
    for (Index& normal : dress->normal_of_corner) {
      const bool is_one = normal < normals.size() && !normals[normal].isZero(0);
      normal = is_one ? normal : MeshAttributes::none;
    }
  }
  PolygonMesh moved = mesh_;
  moved.positions.assign(positions.begin(), positions.end());
  return write_mesh(moved, *dress, out);
}

} // namespace cagewright
