/// \file
/// Pictures in memory, and as PNG.
#pragma once

#include <cagewright/core/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cagewright {

/// Red, green, blue, opacity; 0 to 255, sRGB, the colour not multiplied by the opacity.
using Pixel = std::array<std::uint8_t, 4>;

struct Image {
  int width = 0;
  int height = 0;
  std::vector<Pixel> pixels; ///< width * height, row after row from the top

  [[nodiscard]] const Pixel& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// The bytes of a PNG file; without the opacity when every pixel is opaque. The same image gives
/// the same bytes. Errors: too_large.
Result<std::string> encode_png(const Image& image);

/// Writes a PNG file, complete or not at all. Errors: too_large, cannot_write.
Status write_png(const Image& image, const std::filesystem::path& path);

/// Reads a PNG file. Errors: cannot_open, malformed, too_large.
Result<Image> read_png(const std::filesystem::path& path);

/// Pictures of the same height from left to right.
Image side_by_side(const std::vector<Image>& images);

} // namespace cagewright
