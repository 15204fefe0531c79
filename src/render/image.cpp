#include <cagewright/render/image.h>

#include "io/atomic_file.h"
#include "io/read_file.h"

#include <png.h>

#include <algorithm>

namespace cagewright {
namespace {

bool is_opaque(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](const Pixel& pixel) { return pixel[3] == 255; });
}

std::vector<std::uint8_t> without_opacity(const Image& image) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 3);
  for (const Pixel& pixel : image.pixels) {
    bytes.insert(bytes.end(), pixel.begin(), pixel.begin() + 3);
  }
  return bytes;
}

} // namespace

Result<std::string> encode_png(const Image& image) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);

  const bool opaque = is_opaque(image);
  header.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  const std::vector<std::uint8_t> rgb =
      opaque ? without_opacity(image) : std::vector<std::uint8_t>();
  const void* pixels = opaque ? static_cast<const void*>(rgb.data()) : image.pixels.data();

  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels, 0, nullptr) == 0) {
    return Error{ErrorCode::too_large, std::string("cannot make a PNG file: ") + header.message};
  }
  bytes.resize(size);
  return bytes;
}

Status write_png(const Image& image, const std::filesystem::path& path) {
  const Result<std::string> bytes = encode_png(image);
  if (!bytes) {
    return bytes.error();
  }
  return write_file_atomically(path, *bytes);
}

Result<Image> read_png(const std::filesystem::path& path) {
  const Result<FileBytes> file = read_file(path);
  if (!file) {
    return file.error();
  }
  const std::string_view bytes = file->view();
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  const auto complain = [&] {
    return Error{ErrorCode::malformed, path.string() + ": " + header.message};
  };
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) {
    return complain();
  }
  header.format = PNG_FORMAT_RGBA;
  if (header.width > 65535 || header.height > 65535) {
    png_image_free(&header);
    return Error{ErrorCode::too_large, path.string() + ": more than 65535 pixels across"};
  }
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  image.pixels.resize(std::size_t{header.width} * header.height);
  if (png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr) == 0) {
    return complain();
  }
  return image;
}

Image side_by_side(const std::vector<Image>& images) {
  Image result;
  for (const Image& image : images) {
    result.width += image.width;
    result.height = image.height;
  }
  result.pixels.reserve(static_cast<std::size_t>(result.width) *
                        static_cast<std::size_t>(result.height));
  for (int y = 0; y < result.height; ++y) {
    for (const Image& image : images) {
      const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
      result.pixels.insert(result.pixels.end(), row, row + image.width);
    }
  }
  return result;
}

} // namespace cagewright
