#include "io/binary.h"
#include "io/readers.h"
#include "io/text_cursor.h"

#include <array>
#include <string>

namespace cagewright {
namespace {

constexpr std::size_t header_size = 84; // 80 bytes of anything, then the count of facets
constexpr std::size_t facet_size = 50;  // normal, three corners, two spare bytes

Result<PolygonMesh> read_binary(const Source& source) {
  const std::string_view bytes = source.bytes;
  if (bytes.size() < header_size) {
    return source.error_at_byte(bytes.size(), "the file ends within the STL header of 84 bytes; it "
                                              "is cut short or no STL file" +
                                                  std::string(export_again));
  }
  const auto facets = load<std::uint32_t>(bytes.data() + 80);
  if (facets > (bytes.size() - header_size) / facet_size) {
    return source.error_at_byte(
        80, "the header promises " + counted(facets, "facet") + ", but there is room for " +
                std::to_string((bytes.size() - header_size) / facet_size) +
                "; the file is cut short or no STL file" + std::string(export_again));
  }
  if (facets == 0) {
    return no_faces(source);
  }
  if (facets > std::numeric_limits<Index>::max() / 3) {
    return too_many_vertices(source, std::size_t{3} * facets);
  }
  PolygonMesh mesh;
  mesh.positions.reserve(std::size_t{3} * facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const std::size_t facet = header_size + facet_size * f;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t at = facet + 12 * (1 + corner);
      const Vec3 p(load<float>(&bytes[at]), load<float>(&bytes[at + 4]),
                   load<float>(&bytes[at + 8]));
      if (!p.allFinite()) {
        return source.error_at_byte(at, "facet " + std::to_string(f) +
                                            " has a coordinate that is not a finite number" +
                                            std::string(export_again));
      }
      mesh.positions.push_back(p);
    }
    const Index first = static_cast<Index>(3 * f);
    mesh.add_face({first, first + 1, first + 2});
  }
  return mesh;
}

// solid NAME
//   facet normal X Y Z
//     outer loop
//       vertex X Y Z (three times)
//     endloop
//   endfacet
// endsolid NAME
class StlTextReader {
public:
  explicit StlTextReader(const Source& source) : source_(source), cursor_(source) {}

  Result<PolygonMesh> read() {
    while (cursor_.next_word_of_file()) {
      if (const Status status = read_statement(); !status) {
        return status.error();
      }
    }
    if (in_solid_) {
      return cursor_.error("the file ends without 'endsolid'; it is cut short" +
                           std::string(export_again));
    }
    return mesh_.face_count() == 0 ? Result<PolygonMesh>(no_faces(source_)) : std::move(mesh_);
  }

private:
  Status read_statement() {
    const std::size_t begin = cursor_.offset();
    const std::string keyword = stl_keyword(cursor_.word());
    if (keyword == "vertex") {
      return read_vertex();
    }
    if (keyword == "endfacet") {
      return end_facet(begin);
    }
    if (keyword == "solid" || keyword == "endsolid") {
      in_solid_ = keyword == "solid";
    } else if (keyword == "endloop") {
      return success(); // the facet may end on the same line
    } else if (keyword == "facet") {
      // The normal follows from the corners, and some programs write nan.
      corners_ = 0;
    } else if (keyword != "outer") {
      return source_.error_in_line(begin, in_quotes(keyword) + " is no STL statement" +
                                              std::string(export_again));
    }
    cursor_.next_line();
    return success();
  }

  Status read_vertex() {
    Vec3 p;
    for (double& coordinate : p) {
      cursor_.skip_blanks();
      const std::optional<double> value = cursor_.number();
      if (!value) {
        return cursor_.error((cursor_.at_line_end()
                                  ? "a vertex needs 3 coordinates"
                                  : in_quotes(cursor_.peek_word()) + " is not a finite number") +
                             std::string(export_again));
      }
      coordinate = *value;
    }
    mesh_.positions.push_back(p);
    ++corners_;
    return success();
  }

  Status end_facet(std::size_t begin) {
    if (corners_ != 3) {
      return source_.error_in_line(begin, "a facet has 3 vertices, but this has " +
                                              std::to_string(corners_) + std::string(export_again));
    }
    const Index end = static_cast<Index>(mesh_.positions.size());
    mesh_.add_face({end - 3, end - 2, end - 1});
    corners_ = 0;
    return success();
  }

  Source source_;
  TextCursor cursor_;
  PolygonMesh mesh_;
  std::size_t corners_ = 0; // of the facet under way
  bool in_solid_ = false;
};

} // namespace

std::string stl_keyword(std::string_view word) {
  std::string lower(word.substr(0, 16)); // no keyword is longer
  for (char& c : lower) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  return lower;
}

bool is_stl_text(const Source& source) {
  TextCursor cursor(source);
  return cursor.next_word_of_file() && stl_keyword(cursor.word()) == "solid" &&
         source.bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

Result<PolygonMesh> read_stl(const Source& source, Reading& reading) {
  static_cast<void>(reading);
  return is_stl_text(source) ? StlTextReader(source).read() : read_binary(source);
}

} // namespace cagewright
