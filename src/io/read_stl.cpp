#include "io/binary.h"
#include "io/readers.h"
#include "io/stl_text.h"
#include "io/text_cursor.h"

#include <array>
#include <string>

namespace cagewright {
namespace {

constexpr std::size_t header_size = 84; // 80 bytes of anything, then the count of facets
constexpr std::size_t facet_size = 50;  // normal, three corners, two spare bytes

// The count of programs that write while they compute, where they never come back to it. (Others
// leave nought.)
constexpr std::size_t unset_count = std::numeric_limits<std::uint32_t>::max();

std::size_t promised_facets(std::string_view bytes) {
  return load<std::uint32_t>(bytes.data() + 80);
}

/// How many facets there are, and what is told where the header says otherwise.
Result<std::size_t> count_facets(const Source& source, Reading& reading) {
  const std::string_view bytes = source.bytes;
  const std::size_t promised = promised_facets(bytes);
  const std::size_t room = (bytes.size() - header_size) / facet_size;
  const std::size_t spare = (bytes.size() - header_size) % facet_size;
  const auto place = [&] { return source.place_at_byte(80); };
  const std::string header = "the header promises " + counted(promised, "facet");
  if ((promised == 0 || promised == unset_count) && room > 0 && spare == 0) {
    reading.notes.add("facet_count", place,
                      header + ", but the file holds " + std::to_string(room) + "; all are read");
    return room;
  }
  if (promised > room) {
    return source.error_at_byte(80, header + ", but there is room for " + std::to_string(room) +
                                        "; the file is cut short or no STL file" +
                                        std::string(export_again));
  }
  if (const std::size_t left = bytes.size() - header_size - facet_size * promised; left > 0) {
    reading.notes.add("trailing_bytes", place,
                      header + "; " + counted(left, "byte") + " behind them are left out" +
                          (left >= facet_size
                               ? " (room for " + std::to_string(left / facet_size) + " more)"
                               : std::string()));
  }
  return promised;
}

Result<PolygonMesh> read_binary(const Source& source, Reading& reading) {
  const std::string_view bytes = source.bytes;
  if (bytes.size() < header_size) {
    return source.error_at_byte(bytes.size(), "the file ends within the STL header of 84 bytes; it "
                                              "is cut short or no STL file" +
                                                  std::string(export_again));
  }
  const Result<std::size_t> count = count_facets(source, reading);
  if (!count) {
    return count.error();
  }
  const std::size_t facets = *count;
  if (facets == 0) {
    return no_faces(source);
  }
  if (facets > std::numeric_limits<Index>::max() / 3) {
    return too_many_vertices(source, std::size_t{3} * facets);
  }
  PolygonMesh mesh;
  bool has_attributes = false; // mostly a colour
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
    has_attributes |= load<std::uint16_t>(&bytes[facet + 48]) != 0;
  }
  if (has_attributes && reading.attributes != nullptr) {
    reading.attributes->others.emplace_back("attribute bytes of facets");
  }
  return mesh;
}

class StlTextReader {
public:
  StlTextReader(const Source& source, Reading& reading)
      : reading_(reading), source_(source), cursor_(source), walker_(cursor_) {}

  Result<PolygonMesh> read() {
    for (StlStatement next = walker_.next(); next != StlStatement::end_of_file;
         next = walker_.next()) {
      if (const Status status = read_statement(next); !status) {
        return status.error();
      }
    }
    if (in_solid_ || corners_ > 0) {
      return cursor_.error("the file ends without 'endsolid'; it is cut short" +
                           std::string(export_again));
    }
    return mesh_.face_count() == 0 ? Result<PolygonMesh>(no_faces(source_)) : std::move(mesh_);
  }

private:
  Status read_statement(StlStatement statement) {
    switch (statement) {
    case StlStatement::solid:
      in_solid_ = true;
      was_solid_ = true;
      break;
    case StlStatement::end_solid:
      in_solid_ = false;
      break;
    case StlStatement::facet:
      // The normal follows from the corners, and some programs write nan.
      corners_ = 0;
      if (!was_solid_) {
        reading_.notes.add(
            "no_solid", [&] { return source_.place_in_line(walker_.begin()); },
            "a facet before any line 'solid'; read as STL all the same");
      }
      was_solid_ = true;
      break;
    case StlStatement::vertex:
      return read_vertex();
    case StlStatement::end_facet:
      return end_facet(walker_.begin());
    case StlStatement::unknown:
      cursor_.move_to(walker_.begin());
      return source_.error_in_line(walker_.begin(), in_quotes(stl_keyword(cursor_.peek_word())) +
                                                        " is no STL statement" +
                                                        std::string(export_again));
    case StlStatement::other:
    case StlStatement::end_of_file:
      break;
    }
    return success();
  }

  Status read_vertex() {
    Vec3 p;
    for (double& coordinate : p) {
      cursor_.skip_blanks();
      const std::optional<double> value = cursor_.number();
      if (!value) {
        return cursor_.error(cursor_.at_line_end()
                                 ? "a vertex needs 3 coordinates" + std::string(export_again)
                                 : not_a_number(cursor_.peek_word()));
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

  Reading& reading_;
  Source source_;
  TextCursor cursor_;
  StlWalker walker_;
  PolygonMesh mesh_;
  std::size_t corners_ = 0; // of the facet under way
  bool in_solid_ = false;
  bool was_solid_ = false; // a solid has begun, or its absence has been told
};

} // namespace

std::string stl_keyword(std::string_view word) {
  std::string lower(word.substr(0, 16)); // no keyword is longer
  for (char& c : lower) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  return lower;
}

bool has_the_size_of_binary_stl(std::string_view bytes) {
  if (bytes.size() <= header_size) {
    return false;
  }
  const std::uint64_t promised = promised_facets(bytes); // times 50 more than 32 bits hold
  const std::uint64_t body = bytes.size() - header_size;
  return body == facet_size * promised || (promised == unset_count && body % facet_size == 0);
}

// Size first: the bytes of a binary file change when it is written again with other coordinates,
// and may then look like text; its size stays.
bool is_stl_text(const Source& source) {
  TextCursor cursor(source);
  if (has_the_size_of_binary_stl(source.bytes) || !cursor.next_word_of_file() ||
      source.bytes.substr(0, 1024).find('\0') != std::string_view::npos) {
    return false;
  }
  const std::string word = stl_keyword(cursor.word());
  return word == "solid" || word == "facet";
}

Result<PolygonMesh> read_stl(const Source& source, Reading& reading) {
  return is_stl_text(source) ? StlTextReader(source, reading).read() : read_binary(source, reading);
}

} // namespace cagewright
