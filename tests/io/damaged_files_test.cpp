// What no reader may do, whatever the file holds: crash, hang, return a mesh that breaks its
// promises, or complain in more than one line.
#include "io/files.h"

#include "core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cagewright {
namespace {

using test::Sample;

void expect_sound_or_explained(const Result<PolygonMesh>& mesh) {
  if (!mesh) {
    EXPECT_TRUE(mesh.error().message.starts_with("file:")) << mesh.error().message;
    EXPECT_NE(mesh.error().message.find("; "), std::string::npos)
        << "no remedy: " << mesh.error().message;
    EXPECT_TRUE(std::none_of(mesh.error().message.begin(), mesh.error().message.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20;
    })) << mesh.error().message;
    return;
  }
  EXPECT_GT(mesh->face_count(), 0U);
  for (const Index corner : mesh->corners()) {
    ASSERT_LT(corner, mesh->positions.size());
  }
  for (std::size_t f = 0; f < mesh->face_count(); ++f) {
    ASSERT_GE(mesh->face(f).size(), 3U);
  }
  for (const Vec3& p : mesh->positions) {
    ASSERT_TRUE(p.allFinite());
  }
  ASSERT_TRUE(mesh->colors.empty() || mesh->colors.size() == mesh->positions.size());
  for (const auto& color : mesh->colors) {
    ASSERT_TRUE(std::all_of(color.begin(), color.end(), [](float c) { return c >= 0 && c <= 1; }));
  }
  ASSERT_TRUE(mesh->face_groups.empty() || mesh->face_groups.size() == mesh->face_count());
  for (const Index group : mesh->face_groups) {
    ASSERT_LT(group, mesh->group_names.size());
  }
}

class DamagedFile : public testing::TestWithParam<Sample> {};

TEST_P(DamagedFile, IsReadWhenItIsNotDamaged) {
  const Result<PolygonMesh> mesh = test::read(GetParam().bytes, GetParam().format);
  ASSERT_TRUE(mesh) << mesh.error().message;
  expect_sound_or_explained(mesh);
}

TEST_P(DamagedFile, IsSoundOrExplainedWhereverItIsCutShort) {
  const std::string& bytes = GetParam().bytes;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    SCOPED_TRACE("cut after " + std::to_string(size) + " bytes");
    // A copy of its own, so that a sanitizer sees a read beyond the end.
    const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    expect_sound_or_explained(test::read({cut.data(), cut.size()}, GetParam().format));
  }
}

TEST_P(DamagedFile, IsSoundOrExplainedWithOtherBytesInIt) {
  Random random(7);
  const std::string_view telling = "0123456789-+.eE/ \n\r\\#\"{}[],:\xff\x80\x7f";
  int refused = 0;
  for (int i = 0; i < 10000; ++i) {
    SCOPED_TRACE("mutation " + std::to_string(i));
    std::string bytes = GetParam().bytes;
    for (std::uint64_t changes = 1 + random.below(4); changes != 0; --changes) {
      const std::size_t at = random.below(bytes.size());
      switch (random.below(5)) {
      case 0:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        bytes[at] = telling[random.below(telling.size())];
        break;
      case 2:
        bytes.insert(at, 1 + random.below(8), telling[random.below(telling.size())]);
        break;
      case 3:
        bytes.erase(at, 1 + random.below(8));
        break;
      default:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      }
    }
    const Result<PolygonMesh> mesh = test::read(bytes, GetParam().format);
    refused += mesh ? 0 : 1;
    expect_sound_or_explained(mesh);
  }
  EXPECT_GT(refused, 100); // the mutations reach something
}

TEST_P(DamagedFile, IsExplainedWhenItIsOnlyNoise) {
  Random random(11);
  for (std::size_t size = 1; size < 400; ++size) {
    std::string bytes(size, '\0');
    for (char& c : bytes) {
      c = static_cast<char>(random.below(256));
    }
    const Result<PolygonMesh> mesh = test::read(bytes, GetParam().format);
    EXPECT_FALSE(mesh);
    expect_sound_or_explained(mesh);
  }
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, DamagedFile, testing::ValuesIn(test::samples()),
                         [](const auto& parameter) {
                           std::string name = parameter.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

} // namespace
} // namespace cagewright
