#include "arrays.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace cagewright::c {
namespace {

std::size_t size_of(cw_type type) {
  switch (type) {
  case CW_INT8:
  case CW_UINT8:
    return 1;
  case CW_INT16:
  case CW_UINT16:
    return 2;
  case CW_FLOAT32:
  case CW_INT32:
  case CW_UINT32:
    return 4;
  case CW_FLOAT64:
  case CW_INT64:
  case CW_UINT64:
    return 8;
  }
  return 0; // of no type that we know
}

bool is_float(cw_type type) {
  return type == CW_FLOAT64 || type == CW_FLOAT32;
}

Error malformed(std::string message) {
  return {ErrorCode::malformed, std::move(message)};
}

/// An array with its strides filled in.
Result<cw_array> with_strides(cw_array array, const std::string& what) {
  const std::size_t size = size_of(array.type);
  if (size == 0) {
    return malformed(what + ": there is no number type " + std::to_string(array.type));
  }
  if (array.data == nullptr && array.rows > 0 && array.columns > 0) {
    return malformed(what + ": there is no data");
  }
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max());
  if (array.columns > 0 && array.rows > most / size / array.columns) {
    return Error{ErrorCode::too_large, what + ": " + std::to_string(array.rows) + " rows of " +
                                           std::to_string(array.columns) +
                                           " numbers are more than memory can hold"};
  }
  if (array.row_stride == 0 && array.column_stride == 0) {
    array.column_stride = static_cast<std::ptrdiff_t>(size);
    array.row_stride = static_cast<std::ptrdiff_t>(size * array.columns);
  }
  return array;
}

bool is_packed(const cw_array& array) {
  const std::size_t size = size_of(array.type);
  return array.column_stride == static_cast<std::ptrdiff_t>(size) &&
         (array.rows <= 1 ||
          array.row_stride == static_cast<std::ptrdiff_t>(size * array.columns)) &&
         reinterpret_cast<std::uintptr_t>(array.data) % size == 0;
}

template <class Stored, class T> void copy_as(const cw_array& array, std::vector<T>& numbers) {
  const auto* const first = static_cast<const std::byte*>(array.data);
  std::size_t at = 0;
  for (std::size_t r = 0; r < array.rows; ++r) {
    const std::byte* const row = first + static_cast<std::ptrdiff_t>(r) * array.row_stride;
    for (std::size_t c = 0; c < array.columns; ++c) {
      Stored number;
      std::memcpy(&number, row + static_cast<std::ptrdiff_t>(c) * array.column_stride,
                  sizeof number);
      if constexpr (std::is_same_v<Stored, std::uint64_t> && std::is_same_v<T, std::int64_t>) {
        // Beyond any index, and so told as one that is too large.
        number = std::min<std::uint64_t>(number, std::numeric_limits<std::int64_t>::max());
      }
      numbers[at++] = static_cast<T>(number);
    }
  }
}

/// All numbers, row after row.
template <class T> std::vector<T> copied(const cw_array& array) {
  std::vector<T> numbers(array.rows * array.columns);
  switch (array.type) {
  case CW_FLOAT64:
    copy_as<double>(array, numbers);
    break;
  case CW_FLOAT32:
    copy_as<float>(array, numbers);
    break;
  case CW_INT8:
    copy_as<std::int8_t>(array, numbers);
    break;
  case CW_UINT8:
    copy_as<std::uint8_t>(array, numbers);
    break;
  case CW_INT16:
    copy_as<std::int16_t>(array, numbers);
    break;
  case CW_UINT16:
    copy_as<std::uint16_t>(array, numbers);
    break;
  case CW_INT32:
    copy_as<std::int32_t>(array, numbers);
    break;
  case CW_UINT32:
    copy_as<std::uint32_t>(array, numbers);
    break;
  case CW_INT64:
    copy_as<std::int64_t>(array, numbers);
    break;
  case CW_UINT64:
    copy_as<std::uint64_t>(array, numbers);
    break;
  }
  return numbers;
}

Result<std::vector<std::int64_t>> integers_of(const cw_array& given, const std::string& what) {
  Result<cw_array> array = with_strides(given, what);
  if (!array) {
    return array.error();
  }
  if (is_float(array->type)) {
    return malformed(what + ": indices are integers, not floating-point numbers; convert them");
  }
  return copied<std::int64_t>(*array);
}

Error no_such_vertex(const std::string& place, std::int64_t vertex, std::size_t count) {
  return malformed(place + " refers to vertex " + std::to_string(vertex) + ", but there are " +
                   std::to_string(count) + " (counted from 0)");
}

/// The corners of one face, checked.
Status add_face(std::span<const std::int64_t> corners, std::size_t vertices,
                const std::string& place, std::vector<Index>& room, PolygonMesh& mesh) {
  room.clear();
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(vertices)) {
      return no_such_vertex(place, corner, vertices);
    }
    room.push_back(static_cast<Index>(corner));
  }
  if (room.size() < 3) {
    return malformed(place + " has " + std::to_string(room.size()) +
                     (room.size() == 1 ? " corner" : " corners") + "; a face has at least 3");
  }
  mesh.add_face(room);
  return success();
}

Status add_rows(const cw_array& array, const std::string& name, std::size_t vertices,
                PolygonMesh& mesh) {
  const Result<std::vector<std::int64_t>> corners = integers_of(array, name);
  if (!corners) {
    return corners.error();
  }
  std::vector<Index> room;
  for (std::size_t f = 0; f < array.rows; ++f) {
    std::span<const std::int64_t> row =
        std::span(*corners).subspan(f * array.columns, array.columns);
    while (!row.empty() && row.back() < 0) {
      row = row.first(row.size() - 1);
    }
    if (Status added = add_face(row, vertices, name + ": row " + std::to_string(f), room, mesh);
        !added) {
      return added;
    }
  }
  return success();
}

Status add_lists(const cw_array& corner_array, const cw_array& offset_array,
                 const std::string& name, std::size_t vertices, PolygonMesh& mesh) {
  const Result<std::vector<std::int64_t>> corners = integers_of(corner_array, name);
  if (!corners) {
    return corners.error();
  }
  Result<std::vector<std::int64_t>> offsets = integers_of(offset_array, name + ": offsets");
  if (!offsets) {
    return offsets.error();
  }
  const auto count = static_cast<std::int64_t>(corners->size());
  if (offsets->empty() || offsets->back() != count) {
    offsets->push_back(count);
  }
  std::vector<Index> room;
  for (std::size_t f = 0; f + 1 < offsets->size(); ++f) {
    const std::string place = name + ": face " + std::to_string(f);
    const std::int64_t begin = (*offsets)[f];
    const std::int64_t end = (*offsets)[f + 1];
    if (begin < 0 || begin > end || end > count) {
      return malformed(place + " has the corners from " + std::to_string(begin) + " up to " +
                       std::to_string(end) + " of " + std::to_string(count) +
                       "; offsets rise from 0 to the number of corners");
    }
    const auto row = std::span(*corners).subspan(static_cast<std::size_t>(begin),
                                                 static_cast<std::size_t>(end - begin));
    if (Status added = add_face(row, vertices, place, room, mesh); !added) {
      return added;
    }
  }
  return success();
}

/// Triangles in the caller's memory, if they are just as ours; null if not.
const Triangle* packed_triangles(const cw_mesh_view& view) {
  const cw_array& faces = view.faces;
  const bool is_index = faces.type == CW_UINT32 || faces.type == CW_INT32;
  const Result<cw_array> array = with_strides(faces, "");
  return view.offsets.data == nullptr && is_index && faces.columns == 3 && array &&
                 is_packed(*array)
             ? static_cast<const Triangle*>(faces.data)
             : nullptr;
}

} // namespace

Result<Points> Points::of(const cw_array& given, const std::string& what) {
  const Result<cw_array> array = with_strides(given, what);
  if (!array) {
    return array.error();
  }
  if (array->columns != 3) {
    return malformed(what + " have " + std::to_string(array->columns) +
                     (array->columns == 1 ? " column" : " columns") + ", not the 3 of x, y, z");
  }
  if (array->rows > std::numeric_limits<Index>::max()) {
    return Error{ErrorCode::too_large, what + " are more than 4294967295"};
  }
  Points points;
  if (array->type == CW_FLOAT64 && is_packed(*array)) {
    points.view_ = {static_cast<const Vec3*>(array->data), array->rows};
    return points;
  }
  const std::vector<double> numbers = copied<double>(*array);
  points.own_.resize(array->rows);
  for (std::size_t p = 0; p < array->rows; ++p) {
    points.own_[p] = Vec3(numbers[3 * p], numbers[3 * p + 1], numbers[3 * p + 2]);
  }
  points.view_ = points.own_;
  return points;
}

Result<std::vector<double>> numbers_of(const cw_array& given, const std::string& what) {
  const Result<cw_array> array = with_strides(given, what);
  if (!array) {
    return array.error();
  }
  if (array->columns != 1) {
    return malformed(what + " have " + std::to_string(array->columns) + " columns, not 1");
  }
  return copied<double>(*array);
}

Result<std::vector<Index>> indices_of(const cw_array& array, std::size_t count,
                                      const std::string& what) {
  const Result<std::vector<std::int64_t>> numbers = integers_of(array, what);
  if (!numbers) {
    return numbers.error();
  }
  std::vector<Index> indices;
  for (const std::int64_t number : *numbers) {
    if (number < 0 || number >= static_cast<std::int64_t>(count)) {
      return no_such_vertex(what, number, count);
    }
    indices.push_back(static_cast<Index>(number));
  }
  return indices;
}

Result<MeshArgument> MeshArgument::of(const cw_mesh_view* view, const std::string& name) {
  if (view == nullptr) {
    return malformed(name + " is missing (NULL)");
  }
  Result<Points> positions = Points::of(view->positions, name + "'s positions");
  if (!positions) {
    return positions.error();
  }
  const std::size_t vertices = positions->view().size();
  MeshArgument mesh;
  mesh.positions_ = std::move(*positions);
  const std::string faces = name + "'s faces";
  if (view->faces.rows > std::numeric_limits<Index>::max()) {
    return Error{ErrorCode::too_large, faces + " are more than 4294967295"};
  }
  if (const Triangle* const triangles = packed_triangles(*view)) {
    mesh.triangles_ = {triangles, view->faces.rows};
    for (std::size_t t = 0; t < mesh.triangles_.size(); ++t) {
      for (const Index corner : mesh.triangles_[t]) {
        if (corner >= vertices) {
          const bool is_signed = view->faces.type == CW_INT32;
          return no_such_vertex(faces + ": row " + std::to_string(t),
                                is_signed ? static_cast<std::int32_t>(corner)
                                          : static_cast<std::int64_t>(corner),
                                vertices);
        }
      }
    }
    return mesh;
  }
  if (view->offsets.data == nullptr && view->faces.columns == 3) {
    return with_triangles(std::move(mesh), view->faces, faces);
  }
  PolygonMesh polygons;
  const Status added = view->offsets.data == nullptr
                           ? add_rows(view->faces, faces, vertices, polygons)
                           : add_lists(view->faces, view->offsets, faces, vertices, polygons);
  if (!added) {
    return added.error();
  }
  polygons.positions.assign(mesh.positions_.view().begin(), mesh.positions_.view().end());
  Triangulation cut = triangulate(polygons);
  mesh.own_ = std::move(cut.triangles);
  mesh.face_of_ = std::move(cut.face_of);
  mesh.triangles_ = mesh.own_;
  mesh.polygons_ = std::move(polygons);
  return mesh;
}

Result<MeshArgument> MeshArgument::with_triangles(MeshArgument mesh, const cw_array& faces,
                                                  const std::string& name) {
  const Result<std::vector<std::int64_t>> corners = integers_of(faces, name);
  if (!corners) {
    return corners.error();
  }
  const std::size_t vertices = mesh.positions_.view().size();
  mesh.own_.resize(faces.rows);
  for (std::size_t i = 0; i < corners->size(); ++i) {
    const std::int64_t corner = (*corners)[i];
    if (corner < 0 || corner >= static_cast<std::int64_t>(vertices)) {
      return no_such_vertex(name + ": row " + std::to_string(i / 3), corner, vertices);
    }
    mesh.own_[i / 3][i % 3] = static_cast<Index>(corner);
  }
  mesh.triangles_ = mesh.own_;
  return mesh;
}

PolygonMesh MeshArgument::polygons() const {
  if (polygons_) {
    return *polygons_;
  }
  PolygonMesh mesh;
  mesh.positions.assign(positions_.view().begin(), positions_.view().end());
  for (const Triangle& triangle : triangles_) {
    mesh.add_face(triangle);
  }
  return mesh;
}

Result<ModelAndCage> ModelAndCage::of(const cw_mesh_view* model, const cw_mesh_view* cage) {
  Result<MeshArgument> first = MeshArgument::of(model, "the model");
  if (!first) {
    return first.error();
  }
  Result<MeshArgument> second = MeshArgument::of(cage, "the cage");
  if (!second) {
    return second.error();
  }
  return ModelAndCage{std::move(*first), std::move(*second)};
}

} // namespace cagewright::c
