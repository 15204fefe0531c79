/// \file
/// The statements of a text STL file, for all that walk through one.
#pragma once

#include "io/readers.h"
#include "io/text_cursor.h"

#include <string>
#include <string_view>

namespace cagewright {

// solid NAME
//   facet normal X Y Z
//     outer loop
//       vertex X Y Z (three times)
//     endloop
//   endfacet
// endsolid NAME
//
// Programs differ in upper and lower case, in line ends (all of it may stand on one line), write
// "end loop" for "endloop", and add words, such as a colour, behind a statement.

enum class StlStatement { solid, facet, vertex, end_facet, end_solid, other, unknown, end_of_file };

/// Walks through the statements.
class StlWalker {
public:
  explicit StlWalker(TextCursor& cursor) : cursor_(cursor) {}

  /// The next statement. The cursor stands behind its words: before the three numbers of a vertex;
  /// before those of a normal where has_normal() says so. What is left unread is skipped.
  StlStatement next() {
    while (true) {
      cursor_.skip_blanks();
      is_first_ = is_first_ || cursor_.at_line_end();
      if (!cursor_.next_word_of_file()) {
        return StlStatement::end_of_file;
      }
      begin_ = cursor_.offset();
      const StlStatement statement = read(stl_keyword(cursor_.word()));
      if (statement != StlStatement::unknown || is_first_) {
        is_first_ = false;
        return statement;
      }
    }
  }

  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] bool has_normal() const { return has_normal_; }

private:
  StlStatement read(const std::string& keyword) {
    if (keyword == "vertex") {
      return StlStatement::vertex;
    }
    if (keyword == "facet") {
      has_normal_ = skip_word("normal");
      return StlStatement::facet;
    }
    if (keyword == "outer") {
      skip_word("loop");
      return StlStatement::other;
    }
    if (keyword == "solid") {
      skip_name();
      return StlStatement::solid;
    }
    return end_of(keyword == "end" ? "end" + second_word() : keyword);
  }

  StlStatement end_of(const std::string& keyword) {
    if (keyword == "endfacet") {
      return StlStatement::end_facet;
    }
    if (keyword == "endsolid") {
      skip_name();
      return StlStatement::end_solid;
    }
    const bool is_known = keyword == "endloop" || keyword == "color" || keyword == "colour";
    return is_known ? StlStatement::other : StlStatement::unknown;
  }

  std::string second_word() {
    cursor_.skip_blanks();
    return cursor_.at_line_end() ? std::string() : stl_keyword(cursor_.word());
  }

  bool skip_word(std::string_view wanted) {
    cursor_.skip_blanks();
    if (stl_keyword(cursor_.peek_word()) != wanted) {
      return false;
    }
    cursor_.word();
    return true;
  }

  /// A name may be any words, also those of statements, and ends with the line, or where a facet
  /// begins on the same one.
  void skip_name() {
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      TextCursor ahead = cursor_;
      if (stl_keyword(ahead.word()) == "facet") {
        ahead.skip_blanks();
        if (stl_keyword(ahead.peek_word()) == "normal") {
          return;
        }
      }
      cursor_.word();
    }
  }

  TextCursor& cursor_;
  std::size_t begin_ = 0; // of the statement
  bool is_first_ = true;  // on its line
  bool has_normal_ = false;
};

} // namespace cagewright
