#include "arrays.h"
#include "calls.h"
#include "handles.h"

#include "report/json.h"
#include <cagewright/io/mesh_format.h>
#include <cagewright/io/write_mesh.h>

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

using namespace cagewright;
using namespace cagewright::c;

namespace {

Result<Pose> pose_of(cw_pose pose) {
  switch (pose) {
  case CW_POSE_SHOWN:
    return Pose::shown;
  case CW_POSE_BIND:
    return Pose::bind;
  }
  return Error{ErrorCode::invalid_option, "there is no such pose of a model"};
}

Status hand_out(Result<ModelFile> file, cw_mesh** out) {
  if (!file) {
    return file.error();
  }
  const std::vector<FileNote> notes(file->notes().begin(), file->notes().end());
  *out = new cw_mesh(std::move(*file).take_mesh(), notes);
  return success();
}

Result<MeshFormat> format_of(std::string_view bytes, const char* format) {
  if (format == nullptr) {
    return format_of_content(bytes).value_or(MeshFormat::obj);
  }
  const std::optional<MeshFormat> named = format_of_name(std::string("x.") + format);
  return named ? Result<MeshFormat>(*named)
               : Error{ErrorCode::unsupported, std::string(format) +
                                                   " is no format of meshes; use obj, ply, stl, "
                                                   "off or gltf"};
}

} // namespace

cw_mesh::cw_mesh(PolygonMesh polygons, std::span<const FileNote> what_was_noted)
    : mesh(std::move(polygons)), cut(triangulate(mesh)), notes(notes_as_json(what_was_noted)) {
  offsets.reserve(mesh.face_count() + 1);
  std::uint64_t end = 0;
  offsets.push_back(end);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    end += mesh.face(f).size();
    offsets.push_back(end);
  }
}

namespace cagewright::c {

char* handed_out(std::string_view text) {
  auto* const copy = static_cast<char*>(std::malloc(text.size() + 1));
  if (copy == nullptr) {
    throw std::bad_alloc();
  }
  std::memcpy(copy, text.data(), text.size());
  copy[text.size()] = '\0';
  return copy;
}

std::string notes_as_json(std::span<const FileNote> notes) {
  nlohmann::json list = nlohmann::json::array();
  for (const FileNote& note : notes) {
    list.push_back({{"code", note.code}, {"message", note.message}});
  }
  return text_of(list, -1);
}

} // namespace cagewright::c

void cw_mesh_free(cw_mesh* mesh) {
  delete mesh;
}

size_t cw_mesh_vertex_count(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->mesh.positions.size() : 0;
}

size_t cw_mesh_face_count(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->mesh.face_count() : 0;
}

size_t cw_mesh_corner_count(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->mesh.corners().size() : 0;
}

size_t cw_mesh_triangle_count(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->cut.triangles.size() : 0;
}

const double* cw_mesh_positions(const cw_mesh* mesh) {
  return mesh != nullptr ? reinterpret_cast<const double*>(mesh->mesh.positions.data()) : nullptr;
}

const uint32_t* cw_mesh_corners(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->mesh.corners().data() : nullptr;
}

const uint64_t* cw_mesh_offsets(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->offsets.data() : nullptr;
}

const uint32_t* cw_mesh_triangles(const cw_mesh* mesh) {
  return mesh != nullptr ? reinterpret_cast<const uint32_t*>(mesh->cut.triangles.data()) : nullptr;
}

const uint32_t* cw_mesh_face_of_triangle(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->cut.face_of.data() : nullptr;
}

const float* cw_mesh_colors(const cw_mesh* mesh) {
  return mesh == nullptr || mesh->mesh.colors.empty()
             ? nullptr
             : reinterpret_cast<const float*>(mesh->mesh.colors.data());
}

size_t cw_mesh_group_count(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->mesh.group_names.size() : 0;
}

const char* cw_mesh_group_name(const cw_mesh* mesh, size_t group) {
  return mesh != nullptr && group < mesh->mesh.group_names.size()
             ? mesh->mesh.group_names[group].c_str()
             : "";
}

const uint32_t* cw_mesh_face_groups(const cw_mesh* mesh) {
  return mesh == nullptr || mesh->mesh.face_groups.empty() ? nullptr
                                                           : mesh->mesh.face_groups.data();
}

const char* cw_mesh_notes(const cw_mesh* mesh) {
  return mesh != nullptr ? mesh->notes.c_str() : "[]";
}

cw_mesh_view cw_mesh_as_view(const cw_mesh* mesh) {
  if (mesh == nullptr) {
    return {};
  }
  const std::size_t faces = mesh->mesh.face_count();
  const std::span<const Index> corners = mesh->mesh.corners();
  const bool has_triangles_only = mesh->cut.triangles.size() == faces;
  return {cw_points(cw_mesh_positions(mesh), mesh->mesh.positions.size()),
          has_triangles_only ? cw_triangles(corners.data(), faces)
                             : cw_array{corners.data(), CW_UINT32, corners.size(), 1, 0, 0},
          {has_triangles_only ? nullptr : mesh->offsets.data(), CW_UINT64, faces + 1, 1, 0, 0}};
}

cw_code cw_read_mesh(const char* path, cw_pose pose, cw_mesh** out, cw_error** error) {
  return call_for(out, error, [&]() -> Status {
    if (Status given = all_given({{path, "the path"}}); !given) {
      return given;
    }
    const Result<Pose> known = pose_of(pose);
    return known ? hand_out(ModelFile::open(path, *known), out) : Status(known.error());
  });
}

cw_code cw_parse_mesh(const void* bytes, size_t size, const char* format, const char* name,
                      cw_pose pose, cw_mesh** out, cw_error** error) {
  return call_for(out, error, [&]() -> Status {
    if (size > 0) {
      if (Status given = all_given({{bytes, "the file in memory"}}); !given) {
        return given;
      }
    }
    const Result<Pose> placed = pose_of(pose);
    if (!placed) {
      return placed.error();
    }
    std::string text(static_cast<const char*>(bytes), size);
    const Result<MeshFormat> known = format_of(text, format);
    if (!known) {
      return known.error();
    }
    return hand_out(
        ModelFile::parse(std::move(text), *known, name != nullptr ? name : "the bytes", *placed),
        out);
  });
}

cw_code cw_write_mesh(const cw_mesh_view* mesh, const char* path, cw_error** error) {
  return call(error, [&]() -> Status {
    if (Status there = all_given({{path, "the path"}}); !there) {
      return there;
    }
    const Result<MeshArgument> given = MeshArgument::of(mesh, "the mesh");
    return given ? write_mesh(given->polygons(), path) : Status(given.error());
  });
}
