#include "io/linked_files.h"

#include "io/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cagewright {
namespace {

using Names = std::vector<std::filesystem::path>;

TEST(LinkedFiles, AreThoseThatTheModelNamesAndThatExist) {
  const test::TemporaryFolder folder;
  folder.add("skin.mtl", "newmtl a\n");
  folder.add("two words.mtl", "newmtl b\n");
  folder.add("b.png", "x");
  EXPECT_EQ(linked_files(folder.add("a.obj", "mtllib skin.mtl b.png none.mtl\nv 0 0 0\n"
                                             "mtllib two words.mtl\nmtllib skin.mtl\n")),
            (Names{"skin.mtl", "b.png", "two words.mtl"}));
  EXPECT_EQ(linked_files(folder.add("a.ply", "ply\nformat ascii 1.0\ncomment TextureFile b.png\r\n"
                                             "comment TextureFile c.png\nend_header\n"
                                             "comment TextureFile skin.mtl\n")),
            (Names{"b.png"}));
  EXPECT_EQ(linked_files(folder.add("a.gltf", R"({"asset": {"version": "2.0"}, "images": [
              {"uri": "two%20words.mtl"}, {"uri": "data:image/png;base64,AAAA"}, {"bufferView": 0},
              {"uri": "../../nowhere.png"}, 7]})")),
            (Names{"two words.mtl"}));
  EXPECT_EQ(linked_files(folder.add("a.stl", "solid skin.mtl\n")), Names{});
  EXPECT_EQ(linked_files("no such file.obj"), Names{});
}

} // namespace
} // namespace cagewright
