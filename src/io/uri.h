/// \file
/// File names and bytes as glTF's URIs hold them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace cagewright {

/// Whether it holds the data itself: "data:...".
bool is_data_uri(std::string_view uri);

/// The bytes of a data URI, in base64 or as %-escapes; none where they are not valid.
std::optional<std::string> decode_data_uri(std::string_view uri);

/// A data URI in base64 for the bytes of a buffer.
std::string data_uri(std::string_view bytes);

/// The bytes after "base64,"; none where a character is not one of the 64. Both alphabets are read,
/// with and without padding, and over several lines.
std::optional<std::string> decode_base64(std::string_view text);
std::string encode_base64(std::string_view bytes);

/// A file name from a URI: "%20" is a blank.
std::string decode_percent(std::string_view uri);

/// Characters that stand for themselves in a URI stay; others become %20 and the like.
std::string encode_percent(std::string_view name);

} // namespace cagewright
