/// \file
/// Changes of a JSON text that leave every other byte as it is.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

/// Finds values in a text that the parser has accepted.
class JsonText {
public:
  /// A value: its bytes are [begin, end).
  struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  explicit JsonText(std::string_view text) : text_(text) {}

  [[nodiscard]] Span whole() const { return {blanks(0), text_.size()}; }

  /// The member of the object that begins at `object`; of several of one name the last, as the
  /// parser takes it.
  [[nodiscard]] std::optional<Span> member(Span object, std::string_view name) const;

  /// An element of the array that begins at `array`.
  [[nodiscard]] std::optional<Span> element(Span array, std::size_t index) const;

  /// text[list][index] from the outermost object. The elements of a list are looked up once.
  [[nodiscard]] std::optional<Span> find(const std::string& list, std::size_t index);

private:
  [[nodiscard]] std::size_t blanks(std::size_t at) const;
  [[nodiscard]] std::size_t next_item(std::size_t end) const;
  [[nodiscard]] std::size_t end_of_string(std::size_t at) const;
  [[nodiscard]] std::size_t end_of_value(std::size_t at) const;

  std::string_view text_;
  std::map<std::string, std::vector<Span>> elements_; // of the lists that were asked for
};

/// Replacements in a JSON text, applied together. They must not overlap.
class JsonPatch {
public:
  explicit JsonPatch(std::string_view text) : text_(text), finder_(text) {}

  /// text[list][index] becomes `value`. Nothing happens where there is no such element.
  void replace(const std::string& list, std::size_t index, std::string value);

  /// text[list][index][name], where it exists.
  void replace(const std::string& list, std::size_t index, std::string_view name,
               std::string value);

  /// The same; where there is no such member it is added.
  void set(const std::string& list, std::size_t index, std::string_view name, std::string value);

  /// text[list][index][name][element], where it exists.
  void replace_element(const std::string& list, std::size_t index, std::string_view name,
                       std::size_t element, std::string value);

  /// A further element of a list, which is made where there is none.
  void append(const std::string& list, std::string value);

  [[nodiscard]] std::string take() &&;

private:
  struct Replacement {
    JsonText::Span at;
    std::string text;
  };

  std::string_view text_;
  JsonText finder_;
  std::vector<Replacement> replacements_;
  std::map<std::string, std::vector<std::string>> appended_;
};

} // namespace cagewright
