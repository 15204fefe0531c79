#include <cagewright/render/image.h>

#include <gtest/gtest.h>
#include <png.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace cagewright {
namespace {

Image small_image(std::uint8_t opacity) {
  Image image{3, 2, {}};
  for (std::uint8_t i = 0; i < 6; ++i) {
    image.pixels.push_back({static_cast<std::uint8_t>(40 * i), i, 255, opacity});
  }
  return image;
}

/// Decodes with libpng's own simplified reader.
Image decoded(const std::string& bytes) {
  png_image header = {};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()), 0);
  header.format = PNG_FORMAT_RGBA;
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  image.pixels.resize(header.width * header.height);
  EXPECT_NE(png_image_finish_read(&header, nullptr, image.pixels.data(), 0, nullptr), 0);
  return image;
}

TEST(Png, GivesBackEveryPixel) {
  for (const int opacity : {0, 128, 255}) {
    const Image image = small_image(static_cast<std::uint8_t>(opacity));
    const Result<std::string> bytes = encode_png(image);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const Image back = decoded(*bytes);
    EXPECT_EQ(back.width, 3);
    EXPECT_EQ(back.height, 2);
    EXPECT_EQ(back.pixels, image.pixels);
  }
}

TEST(Png, OfTheSameImageHasTheSameBytes) {
  EXPECT_EQ(*encode_png(small_image(9)), *encode_png(small_image(9)));
}

TEST(WritePng, LeavesNothingWhereItCannotWrite) {
  const auto folder = std::filesystem::temp_directory_path() / "cagewright_no_such_folder";
  const Status status = write_png(small_image(255), folder / "picture.png");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::cannot_write);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(ReadPng, GivesBackWhatWasWritten) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("cagewright_image_test_" + std::to_string(getpid()) + ".png");
  const Image image = small_image(200);
  ASSERT_TRUE(write_png(image, path));
  const Result<Image> back = read_png(path);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, image.width);
  EXPECT_EQ(back->pixels, image.pixels);

  // A file cut short is refused, wherever it ends.
  const std::string bytes = *encode_png(image);
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{20}, bytes.size() - 20}) {
    std::ofstream(path, std::ios::binary) << bytes.substr(0, length);
    EXPECT_FALSE(read_png(path)) << length;
  }
  std::filesystem::remove(path);
}

TEST(SideBySide, PutsImagesFromLeftToRight) {
  const Image a = small_image(1);
  const Image b = small_image(2);
  const Image both = side_by_side({a, b});
  ASSERT_EQ(both.width, 6);
  ASSERT_EQ(both.height, 2);
  EXPECT_EQ(both.at(2, 1), a.at(2, 1));
  EXPECT_EQ(both.at(3, 0), b.at(0, 0));
}

} // namespace
} // namespace cagewright
