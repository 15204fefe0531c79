#include "io/rewrite_obj.h"

#include "io/number_text.h"
#include "io/obj_words.h"
#include "io/repeated_corners.h"
#include "io/text_copy.h"
#include "io/text_cursor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace cagewright {
namespace {

/// The lines of normals that an OBJ file needs: each of its own, and behind it those that vertices
/// need whose normals were equal and no longer are.
class ObjNormalLines {
public:
  ObjNormalLines(std::span<const Vec3> normals, const FileNormals& stored)
      : of_corner_(stored.of_corner) {
    std::vector<std::size_t> in_line(normals.size()); // which variant of its line
    std::unordered_map<Key, std::size_t, Hash> seen;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Index line = stored.in_file[i];
      lines_.resize(std::max<std::size_t>(lines_.size(), line + std::size_t{1}));
      if (stored.normals[i].isZero(0)) {
        continue; // no direction, or not even numbers: the line stays as it is
      }
      std::vector<Vec3>& variants = lines_[line];
      if (!variants.empty() && (variants[0] - normals[i]).cwiseAbs().maxCoeff() < equal_within) {
        continue; // nearly all
      }
      const auto [entry, is_new] = seen.try_emplace(key(line, normals[i]), variants.size());
      in_line[i] = entry->second;
      if (is_new) {
        variants.push_back(normals[i]);
      }
    }
    for (const std::vector<Vec3>& variants : lines_) {
      begins_.push_back(static_cast<std::int64_t>(begins_.size()) + added_);
      added_ += std::max<std::int64_t>(static_cast<std::int64_t>(variants.size()) - 1, 0);
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
      numbers_.push_back(begins_[stored.in_file[i]] + static_cast<std::int64_t>(in_line[i]) + 1);
    }
  }

  /// What stands in the place of a line of the file; none: the line stays, no face uses it.
  [[nodiscard]] std::span<const Vec3> variants(std::size_t line) const {
    return line < lines_.size() ? std::span<const Vec3>(lines_[line]) : std::span<const Vec3>();
  }

  [[nodiscard]] bool renumbered() const { return added_ > 0; }

  /// The number, from 1, that a corner of the mesh refers to instead of `before`, where `seen`
  /// normals stand before its face.
  [[nodiscard]] std::int64_t number(std::size_t corner, std::int64_t before,
                                    std::int64_t seen) const {
    const Index normal = of_corner_[corner];
    return normal != FileNormals::none ? numbers_[normal] : first_number(before, seen);
  }

  /// The same for a corner that is not part of the mesh.
  [[nodiscard]] std::int64_t first_number(std::int64_t before, std::int64_t seen) const {
    const std::int64_t line = before > 0 ? before - 1 : before + seen;
    if (before == 0 || line < 0) {
      return before - (before < 0 ? added_ : 0); // still out of range
    }
    const auto known = static_cast<std::int64_t>(begins_.size());
    return 1 + (line < known ? begins_[static_cast<std::size_t>(line)] : line + added_);
  }

private:
  /// Normals closer than this share a line, as rounding alone can move them apart.
  static constexpr double equal_within = 1e-6;

  using Key = std::array<std::int64_t, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : key) {
        hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 32U;
      }
      return hash;
    }
  };
  static Key key(Index line, const Vec3& normal) {
    // Longer ones than the format means are kept apart by their first digits.
    const Vec3 cell = (normal / equal_within).cwiseMax(-9e18).cwiseMin(9e18);
    return {line, std::llround(cell.x()), std::llround(cell.y()), std::llround(cell.z())};
  }

  std::span<const Index> of_corner_;
  std::vector<std::vector<Vec3>> lines_;
  std::vector<std::int64_t> begins_; // the place of the first variant of each line
  std::vector<std::int64_t> numbers_;
  std::int64_t added_ = 0;
};

/// The line end that the file uses.
std::string_view line_end_of(const Source& source) {
  const std::size_t feed = source.bytes.find('\n');
  if (feed == std::string_view::npos) {
    return source.bytes.find('\r') == std::string_view::npos ? "\n" : "\r";
  }
  return feed > 0 && source.bytes[feed - 1] == '\r' ? "\r\n" : "\n";
}

/// The line of a normal, at its numbers, becomes one for each variant.
void rewrite_obj_normal(TextCopy& copy, TextCursor& cursor, std::span<const Vec3> variants,
                        std::string_view line_end) {
  if (variants.empty()) {
    return;
  }
  copy.replace_numbers(cursor, variants[0]);
  std::string more;
  for (const Vec3& normal : variants.subspan(1)) {
    more.append(line_end).append("vn");
    for (const double x : normal) {
      append_number(more += ' ', x);
    }
  }
  copy.insert(cursor.offset(), more);
}

/// What stands before a face.
struct Before {
  std::int64_t vertices = 0;
  std::int64_t normals = 0;
};

/// A corner of a face in the file.
struct FileCorner {
  std::int64_t vertex = 0; // from 0
  std::int64_t normal = 0; // as it stands, 0: none
  std::size_t begin = 0;   // of the normal's digits
  std::size_t end = 0;
  std::size_t place = 0; // in the face
};

std::vector<FileCorner> read_corners(TextCursor& cursor, const Before& before) {
  std::vector<FileCorner> corners;
  for (cursor.skip_blanks(); !cursor.at_line_end(); cursor.skip_blanks()) {
    FileCorner& corner = corners.emplace_back();
    corner.place = corners.size() - 1;
    const std::int64_t vertex = cursor.integer_prefix().value_or(0);
    corner.vertex = vertex > 0 ? vertex - 1 : vertex + before.vertices;
    for (int i = 0; i < 2 && cursor.skip('/'); ++i) {
      corner.begin = cursor.offset();
      const std::int64_t index = cursor.integer_prefix().value_or(0);
      corner.normal = i == 1 ? index : 0;
      corner.end = cursor.offset();
    }
  }
  return corners;
}

/// The corners of the face at the cursor refer to the normals of their own. `corner` counts those
/// of the mesh, from which the reader has left some out.
void rewrite_obj_face(TextCopy& copy, TextCursor& cursor, const ObjNormalLines& lines,
                      const Before& before, std::size_t& corner) {
  const std::vector<FileCorner> corners = read_corners(cursor, before);
  std::vector<FileCorner> kept = corners;
  if (kept.size() < 3) {
    kept.clear();
  } else {
    drop_repeated_corners(kept, [](const FileCorner& c) { return c.vertex; });
  }
  std::size_t next = 0; // of the kept ones
  for (const FileCorner& c : corners) {
    const bool is_kept = next < kept.size() && kept[next].place == c.place;
    if (c.normal != 0) {
      copy.replace(c.begin, c.end,
                   is_kept ? lines.number(corner, c.normal, before.normals)
                           : lines.first_number(c.normal, before.normals));
    }
    if (is_kept) {
      ++next;
      ++corner;
    }
  }
}

} // namespace

std::string rewrite_obj(const Source& source, std::span<const Vec3> positions,
                        std::span<const Vec3> normals, const FileNormals& stored) {
  TextCopy copy(source);
  TextCursor cursor(source);
  const ObjNormalLines lines(normals, stored);
  const std::string_view line_end = line_end_of(source);
  Before before;
  std::size_t corner = 0;
  while (cursor.next_word_of_file()) {
    const std::string_view keyword = begin_obj_statement(cursor);
    if (keyword == "v") {
      copy.replace_numbers(cursor, positions[static_cast<std::size_t>(before.vertices++)]);
    } else if (keyword == "vn") {
      const auto line = static_cast<std::size_t>(before.normals++);
      rewrite_obj_normal(copy, cursor, lines.variants(line), line_end);
    } else if (lines.renumbered() && is_obj_face(keyword)) {
      rewrite_obj_face(copy, cursor, lines, before, corner);
    }
    cursor.next_line();
    cursor.set_backslash(TextCursor::Backslash::is_text);
  }
  return std::move(copy).take();
}

} // namespace cagewright
