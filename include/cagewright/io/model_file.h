/// \file
/// A model file read once: its mesh, what was noted while reading, its attributes, and the same
/// file again with other positions.
#pragma once

#include <cagewright/core/result.h>
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/pose.h>
#include <cagewright/io/rewrite_positions.h>
#include <cagewright/mesh/polygon_mesh.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cagewright {

class FileBytes;

/// Something that a reader has taken otherwise than it stands in the file, or that a writer has
/// left out. Each kind is told once for a file, with the first place and how many there are.
struct FileNote {
  std::string code;    ///< for programs: lower case with underscores, never changed later
  std::string message; ///< for people: one line with the file, the place, and what was done
};

/// A model in a file. Copies share the bytes. Several threads may use one.
class ModelFile {
public:
  /// Reads the file. Errors: those of read_mesh().
  static Result<ModelFile> open(const std::filesystem::path& path, Pose pose = Pose::shown);

  /// The same for a file in memory; `name` stands for it in messages. A glTF file cannot refer to
  /// others here: unsupported.
  static Result<ModelFile> parse(std::string bytes, MeshFormat format, std::string_view name,
                                 Pose pose = Pose::shown);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] MeshFormat format() const { return format_; }
  [[nodiscard]] Pose pose() const { return pose_; }
  [[nodiscard]] const PolygonMesh& mesh() const { return mesh_; }
  [[nodiscard]] PolygonMesh take_mesh() && { return std::move(mesh_); }
  [[nodiscard]] std::span<const FileNote> notes() const { return notes_; }

  /// See read_normals(). The first call costs one more pass over the bytes.
  [[nodiscard]] Result<FileNormals> normals() const;

  /// Texture points, normals, materials and the like. The first call costs one more pass over the
  /// bytes.
  [[nodiscard]] Result<MeshAttributes> attributes() const;

  /// See rewrite_positions().
  Status rewrite(std::span<const Vec3> positions, std::span<const Vec3> normals,
                 const std::filesystem::path& out) const;

  /// Whether write_moved() writes the same file again: `out` is named for the format that the
  /// file has, or named as the file is with an extension that no format has.
  [[nodiscard]] bool keeps_format(const std::filesystem::path& out) const;

  /// Writes the model with other positions. Where keeps_format(out) it is the same file again: see
  /// rewrite_positions(). Else it is written by write_mesh() with the attributes that the other
  /// format holds; the normals follow the given ones. For many poses: the file is not read again.
  ///
  /// \param positions  V, in the order of mesh()
  /// \param normals    as many as normals() gives, or none: then those of the file stay
  /// \returns notes about what the other format cannot hold
  /// Errors: those of rewrite_positions() and write_mesh().
  Result<std::vector<FileNote>> write_moved(std::span<const Vec3> positions,
                                            std::span<const Vec3> normals,
                                            const std::filesystem::path& out) const;

private:
  struct Lazy; // what is read when it is first asked for

  ModelFile();
  void hold(FileBytes bytes);
  static Result<ModelFile> read(ModelFile file);
  [[nodiscard]] Result<MeshAttributes> read_attributes() const;

  std::filesystem::path path_;
  std::string name_;     // in messages
  bool on_disk_ = false; // and so may refer to files beside it
  MeshFormat format_ = MeshFormat::obj;
  Pose pose_ = Pose::shown;
  std::shared_ptr<const FileBytes> bytes_; // text in UTF-16 stands here as UTF-8
  PolygonMesh mesh_;
  std::vector<FileNote> notes_;
  std::shared_ptr<Lazy> lazy_;
};

} // namespace cagewright
