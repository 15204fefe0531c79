#include "io/gltf_json_text.h"

#include <algorithm>
#include <utility>

namespace cagewright {

std::optional<JsonText::Span> JsonText::member(Span object, std::string_view name) const {
  std::optional<Span> found;
  std::size_t at = blanks(object.begin + 1);
  while (at < text_.size() && text_[at] == '"') {
    const std::size_t key_end = end_of_string(at);
    const std::string_view key = text_.substr(at + 1, key_end - at - 2);
    const std::size_t begin = blanks(blanks(key_end) + 1); // past the colon
    const std::size_t end = end_of_value(begin);
    if (key == name) {
      found = Span{begin, end};
    }
    at = next_item(end);
  }
  return found;
}

std::optional<JsonText::Span> JsonText::element(Span array, std::size_t index) const {
  std::size_t at = blanks(array.begin + 1);
  for (; at < text_.size() && text_[at] != ']'; --index) {
    const std::size_t end = end_of_value(at);
    if (index == 0) {
      return Span{at, end};
    }
    at = next_item(end);
  }
  return std::nullopt;
}

std::size_t JsonText::blanks(std::size_t at) const {
  return std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
}

std::size_t JsonText::next_item(std::size_t end) const {
  const std::size_t at = blanks(end);
  return at < text_.size() && text_[at] == ',' ? blanks(at + 1) : at;
}

std::size_t JsonText::end_of_string(std::size_t at) const {
  for (++at; at < text_.size() && text_[at] != '"'; ++at) {
    at += text_[at] == '\\' ? 1 : 0;
  }
  return std::min(at + 1, text_.size());
}

std::size_t JsonText::end_of_value(std::size_t at) const {
  std::size_t depth = 0;
  while (at < text_.size()) {
    const char c = text_[at];
    if (c == '"') {
      at = end_of_string(at);
    } else if (c == '[' || c == '{') {
      ++depth;
      ++at;
    } else if (c == ']' || c == '}') {
      if (depth == 0) {
        return at;
      }
      --depth;
      ++at;
    } else if (depth == 0 && (c == ',' || c == ' ' || c == '\t' || c == '\r' || c == '\n')) {
      return at;
    } else {
      ++at;
      continue; // within a number or a name
    }
    if (depth == 0) {
      return at;
    }
  }
  return at;
}

std::optional<JsonText::Span> JsonText::find(const std::string& list, std::size_t index) {
  const auto [known, is_new] = elements_.try_emplace(list);
  if (is_new) {
    const std::optional<Span> array = member(whole(), list);
    std::size_t at = array && text_[array->begin] == '[' ? blanks(array->begin + 1) : text_.size();
    while (at < text_.size() && text_[at] != ']') {
      const std::size_t end = end_of_value(at);
      known->second.push_back({at, end});
      at = next_item(end);
    }
  }
  return index < known->second.size() ? std::optional(known->second[index]) : std::nullopt;
}

void JsonPatch::replace(const std::string& list, std::size_t index, std::string value) {
  if (const std::optional<JsonText::Span> at = finder_.find(list, index)) {
    replacements_.push_back({*at, std::move(value)});
  }
}

void JsonPatch::replace(const std::string& list, std::size_t index, std::string_view name,
                        std::string value) {
  const std::optional<JsonText::Span> object = finder_.find(list, index);
  const std::optional<JsonText::Span> at = object ? finder_.member(*object, name) : std::nullopt;
  if (at) {
    replacements_.push_back({*at, std::move(value)});
  }
}

void JsonPatch::set(const std::string& list, std::size_t index, std::string_view name,
                    std::string value) {
  const std::optional<JsonText::Span> object = finder_.find(list, index);
  if (!object || finder_.member(*object, name)) {
    replace(list, index, name, std::move(value));
    return;
  }
  const std::size_t first = text_.find_first_not_of(" \t\r\n", object->begin + 1);
  const std::string_view comma = text_[first] == '}' ? "" : ",";
  replacements_.push_back({{object->begin + 1, object->begin + 1},
                           '"' + std::string(name) + "\":" + value + std::string(comma)});
}

void JsonPatch::replace_element(const std::string& list, std::size_t index, std::string_view name,
                                std::size_t element, std::string value) {
  const std::optional<JsonText::Span> object = finder_.find(list, index);
  const std::optional<JsonText::Span> array = object ? finder_.member(*object, name) : std::nullopt;
  const std::optional<JsonText::Span> at = array ? finder_.element(*array, element) : std::nullopt;
  if (at) {
    replacements_.push_back({*at, std::move(value)});
  }
}

void JsonPatch::append(const std::string& list, std::string value) {
  appended_[list].push_back(std::move(value));
}

std::string JsonPatch::take() && {
  for (const auto& [list, values] : appended_) {
    std::string items;
    for (const std::string& value : values) {
      items.append(items.empty() ? "" : ",").append(value);
    }
    const JsonText::Span whole = finder_.whole();
    const std::optional<JsonText::Span> array = finder_.member(whole, list);
    if (array) {
      const bool is_empty = !finder_.element(*array, 0);
      const std::size_t end = array->end - 1;
      replacements_.push_back({{end, end}, (is_empty ? "" : ",") + items});
    } else { // the file's object is never empty: it has an asset
      replacements_.push_back(
          {{whole.begin + 1, whole.begin + 1}, '"' + list + "\":[" + items + "],"});
    }
  }
  std::stable_sort(
      replacements_.begin(), replacements_.end(),
      [](const Replacement& a, const Replacement& b) { return a.at.begin < b.at.begin; });
  std::string result;
  std::size_t copied = 0;
  for (const Replacement& replacement : replacements_) {
    result.append(text_.substr(copied, replacement.at.begin - copied));
    result.append(replacement.text);
    copied = replacement.at.end;
  }
  return result.append(text_.substr(copied));
}

} // namespace cagewright
