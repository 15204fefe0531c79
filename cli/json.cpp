#include "json.h"

#include "io/atomic_file.h"
#include "io/source.h"

#include <charconv>
#include <cstdio>

namespace cagewright::cli {
namespace {

/// The longest of the words that the message has before its first colon but one.
std::string_view file_named_first(std::string_view message, std::span<const std::string> words) {
  std::string_view found;
  for (const std::string& word : words) {
    const std::string shown = one_line(word);
    if (!shown.empty() && shown.size() > found.size() && message.starts_with(shown) &&
        message.substr(shown.size()).starts_with(":")) {
      found = message.substr(0, shown.size());
    }
  }
  return found;
}

/// ":12: ..." or ": byte 80: ...".
nlohmann::json place_of(std::string_view text) {
  const auto number_after = [&](std::string_view prefix, const char* key) -> nlohmann::json {
    std::size_t value = 0;
    if (!text.starts_with(prefix)) {
      return nullptr;
    }
    const std::string_view digits = text.substr(prefix.size());
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end != digits.data() + digits.size() && *end == ':'
               ? nlohmann::json{{key, value}}
               : nullptr;
  };
  const nlohmann::json line = number_after(":", "line");
  return line.is_null() ? number_after(": byte ", "byte") : line;
}

} // namespace

nlohmann::json json_of_failure(std::string_view code, const std::string& message,
                               std::span<const std::string> words) {
  nlohmann::json json = {{"code", code},
                         {"message", message},
                         {"file", nullptr},
                         {"place", nullptr},
                         {"remedy", nullptr}};
  const std::string_view text = message;
  const std::string_view file = file_named_first(text, words);
  if (!file.empty()) {
    json["file"] = file;
    json["place"] = place_of(text.substr(file.size()));
  }
  // Messages are "cause; remedy".
  const std::size_t remedy = text.rfind("; ");
  if (remedy != std::string_view::npos) {
    json["remedy"] = text.substr(remedy + 2);
  }
  return json;
}

Status write_json(const std::string& path, const nlohmann::json& json, int indent) {
  const std::string text = text_of(json, indent);
  if (path != "-") {
    return write_file_atomically(path, text);
  }
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    return Error{ErrorCode::cannot_write,
                 "the standard output cannot be written; is the disk full?"};
  }
  return success();
}

} // namespace cagewright::cli
