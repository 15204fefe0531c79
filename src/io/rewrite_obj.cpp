#include "io/rewrite_obj.h"

#include "io/number_text.h"
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
    std::vector<std::int64_t> begins; // the number of the first variant of each line
    for (const std::vector<Vec3>& variants : lines_) {
      begins.push_back(static_cast<std::int64_t>(begins.size()) + added_);
      added_ += std::max<std::int64_t>(static_cast<std::int64_t>(variants.size()) - 1, 0);
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
      numbers_.push_back(begins[stored.in_file[i]] + static_cast<std::int64_t>(in_line[i]) + 1);
    }
  }

  /// What stands in the place of a line of the file; none: the line stays, no face uses it.
  [[nodiscard]] std::span<const Vec3> variants(std::size_t line) const {
    return line < lines_.size() ? std::span<const Vec3>(lines_[line]) : std::span<const Vec3>();
  }

  [[nodiscard]] bool renumbered() const { return added_ > 0; }

  /// The number, from 1, that a corner refers to instead of `before`.
  [[nodiscard]] std::int64_t number(std::size_t corner, std::int64_t before) const {
    if (const Index normal = of_corner_[corner]; normal != FileNormals::none) {
      return numbers_[normal];
    }
    return before + (before > 0 ? added_ : before < 0 ? -added_ : 0); // still out of range
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

/// The corner "v/vt/vn" or "v//vn" at the cursor refers to the normal of its own.
void rewrite_obj_corner(TextCopy& copy, TextCursor& cursor, const ObjNormalLines& lines,
                        std::size_t corner) {
  cursor.integer_prefix();
  for (int i = 0; i < 2 && cursor.skip('/'); ++i) {
    const std::size_t begin = cursor.offset();
    const std::optional<std::int64_t> before = cursor.integer_prefix();
    if (i == 1 && before) {
      copy.replace(begin, cursor.offset(), lines.number(corner, *before));
    }
  }
}

} // namespace

std::string rewrite_obj(const Source& source, std::span<const Vec3> positions,
                        std::span<const Vec3> normals, const FileNormals& stored) {
  TextCopy copy(source);
  TextCursor cursor(source, TextCursor::Backslash::continues);
  const ObjNormalLines lines(normals, stored);
  const std::string_view line_end = line_end_of(source);
  std::size_t vertex = 0;
  std::size_t normal = 0;
  std::size_t corner = 0;
  for (; cursor.next_word_of_file(); cursor.next_line()) {
    const std::string_view keyword = cursor.word();
    if (keyword == "v") {
      copy.replace_numbers(cursor, positions[vertex++]);
    } else if (keyword == "vn") {
      rewrite_obj_normal(copy, cursor, lines.variants(normal++), line_end);
    } else if (lines.renumbered() && (keyword == "f" || keyword == "fo")) {
      for (cursor.skip_blanks(); !cursor.at_line_end(); cursor.skip_blanks()) {
        rewrite_obj_corner(copy, cursor, lines, corner++);
      }
    } else if (keyword == "o" || keyword == "g") {
      cursor.rest_of_line(); // a name may end in a backslash
    }
  }
  return std::move(copy).take();
}

} // namespace cagewright
