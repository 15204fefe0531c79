#include "io/readers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

namespace cagewright {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view export_it = "export the model as OBJ or GLB";
constexpr std::string_view unpack_it = "unpack it first";

// What people have at hand besides meshes.
struct Foreign {
  std::string_view mark;
  std::string_view name;
  std::string_view remedy = export_it;
};

// By the first bytes.
constexpr auto by_begin = std::to_array<Foreign>({
    {"\x1f\x8b", "a gzip archive", unpack_it},
    {"PK\x03\x04", "a zip archive (3MF and USDZ are such)",
     "unpack it, or export it as OBJ or GLB"},
    {"7z\xbc\xaf", "a 7z archive", unpack_it},
    {"\xfd"
     "7zXZ",
     "an xz archive", unpack_it},
    {"BZh", "a bzip2 archive", unpack_it},
    {"Rar!", "a RAR archive", unpack_it},
    {"\x28\xb5\x2f\xfd", "packed by zstd (Blender files are)",
     "unpack it; from Blender export OBJ"},
    {"Kaydara FBX", "an FBX file"},
    {"; FBX", "an FBX file"},
    {"BLENDER", "a Blender file"},
    {"//Maya ASCII", "a Maya scene"},
    {"FOR4", "a Maya scene"},
    {"ISO-10303-21", "a STEP file", "mesh it in a CAD program and export that as STL or OBJ"},
    {"#VRML", "a VRML file"},
    {"#X3D", "an X3D file"},
    {"PXR-USDC", "a USD file"},
    {"#usda", "a USD file"},
    {"3D Geometry File Format", "a Rhino file"},
    {"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0U\0p\0"sv, "a SketchUp file"},
    {"# vtk DataFile", "a VTK file", "export the surface as PLY or STL"},
    {"$MeshFormat", "a Gmsh file", "export the surface as STL or PLY"},
    {"MeshVersionFormatted", "a Medit file", "export the surface as OBJ or STL"},
    {"OCTM", "an OpenCTM file"},
    {"DRACO", "a mesh packed by Draco", "unpack it to PLY or OBJ (draco_decoder)"},
    {"xof 0", "a DirectX file"},
    {"AC3D", "an AC3D file"},
    {"\x89HDF", "an HDF5 file (Alembic files were such)"},
    {"Ogawa", "an Alembic file"},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
     "a SolidWorks or 3ds Max file (or another in Microsoft's container)"},
    {"**ABCDEFGHIJKLM", "a Parasolid file",
     "mesh it in a CAD program and export that as STL or OBJ"},
    {"DBRep_Drawable", "a B-rep of Open CASCADE",
     "mesh it in a CAD program and export that as STL or OBJ"},
    {"AC10", "a DWG drawing"},
    {"QC4DC4D", "a Cinema 4D file"},
    {"*3DSMAX_ASCII", "an ASE file"},
    {"LASF", "a point cloud (LAS)", "reconstruct a surface from it, and export that"},
    {"# .PCD", "a point cloud (PCD)", "reconstruct a surface from it, and export that"},
    {"\x93NUMPY", "a NumPy array", "choose the model"},
    {"\xff\xfe\0\0"sv, "text in UTF-32", "save it as UTF-8"},
    {"\0\0\xfe\xff"sv, "text in UTF-32", "save it as UTF-8"},
    {"GIF8", "a picture (GIF)", "choose the model"},
    {"RIFF", "a picture, sound or film (RIFF)", "choose the model"},
    {"\x89PNG", "a picture (PNG)", "choose the model"},
    {"\xff\xd8\xff", "a picture (JPEG)", "choose the model"},
    {"%PDF", "a PDF document", "choose the model"},
    {"version https://git-lfs", "a pointer of Git LFS, not the file itself", "run 'git lfs pull'"},
});

// By a word among the first bytes of a text with tags.
constexpr auto by_tag = std::to_array<Foreign>({
    {"<!doctype html", "a page of HTML", "download the model itself"},
    {"<html", "a page of HTML", "download the model itself"},
    {"<collada", "a COLLADA file"},
    {"<x3d", "an X3D file"},
    {"<vtkfile", "a VTK file", "export the surface as PLY or STL"},
    {"<amf", "an AMF file"},
    {"<model", "a model of 3MF"},
    {"<svg", "a drawing (SVG)", "choose the model"},
});

constexpr std::size_t looked_at = 2000; // bytes, for tags

std::optional<Foreign> find_tagged(std::string_view bytes) {
  const std::size_t begin = bytes.find_first_not_of("\xef\xbb\xbf \t\r\n");
  if (begin == bytes.npos || bytes[begin] != '<') {
    return std::nullopt;
  }
  std::string text(bytes.substr(begin, looked_at));
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const Foreign& kind : by_tag) {
    if (text.find(kind.mark) != text.npos) {
      return kind;
    }
  }
  return Foreign{"<", "an XML file"};
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[i]);
  }
  return value;
}

/// Kinds whose mark is too short to stand alone.
std::optional<Foreign> find_shaped(std::string_view bytes) {
  if (bytes.size() >= 6 && bytes.starts_with("MM") &&
      (little_endian(bytes.substr(2)) == bytes.size() || bytes.substr(6).starts_with("\2\0"sv))) {
    return Foreign{"MM", "a 3DS file"};
  }
  if (bytes.starts_with("FORM") && bytes.size() >= 12 && bytes.substr(8).starts_with("LWO")) {
    return Foreign{"FORM", "a LightWave file"};
  }
  if (bytes.size() >= 80 && bytes[72] == 'S' && bytes.substr(73, 7) == "      1") {
    return Foreign{"S", "an IGES file", "mesh it in a CAD program and export that as STL or OBJ"};
  }
  if (bytes.size() >= 262 && bytes.substr(257).starts_with("ustar")) {
    return Foreign{"ustar", "a tar archive", unpack_it};
  }
  const std::size_t zero = bytes.find_first_not_of(" \t\r\n");
  if (zero < 16 && bytes.substr(zero).starts_with('0')) {
    const std::size_t word = bytes.find_first_not_of(" \t\r\n", zero + 1);
    if (word < 24 && bytes.substr(word).starts_with("SECTION")) {
      return Foreign{"0", "a DXF file"};
    }
  }
  return std::nullopt;
}

std::optional<Foreign> find_kind(std::string_view bytes) {
  const auto known = std::find_if(by_begin.begin(), by_begin.end(), [&](const Foreign& kind) {
    return bytes.starts_with(kind.mark);
  });
  if (known != by_begin.end()) {
    return *known;
  }
  const std::optional<Foreign> tagged = find_tagged(bytes);
  return tagged ? tagged : find_shaped(bytes);
}

} // namespace

std::optional<Error> foreign_file(const Source& source) {
  const std::optional<Foreign> kind = find_kind(source.bytes);
  if (!kind) {
    return std::nullopt;
  }
  return source.error("is " + std::string(kind->name) + "; " + std::string(kind->remedy),
                      ErrorCode::unsupported);
}

} // namespace cagewright
