#include <cagewright/io/read_joints.h>

#include "files.h"

#include <gtest/gtest.h>

#include <string>

namespace cagewright {
namespace {

Result<Skeleton> read(const std::string& text) {
  const test::TemporaryFolder folder;
  return read_joints(folder.add("joints.txt", text));
}

TEST(ReadJoints, ReadsPoints) {
  const auto skeleton = read("# elbows\n1 2 3\n\n -1e0 2\t3 # left\r\n");
  ASSERT_TRUE(skeleton) << skeleton.error().message;
  ASSERT_EQ(skeleton->joints.size(), 2U);
  EXPECT_EQ(skeleton->joints[1].position, Vec3(-1, 2, 3));
  EXPECT_EQ(skeleton->joints[1].parent, Joint::none);
}

TEST(ReadJoints, ReadsParentsWhereverTheyStand) {
  const auto skeleton = read("0 0 1 2\n0 0 0 0\n0 0 2 1\n");
  ASSERT_TRUE(skeleton) << skeleton.error().message;
  EXPECT_EQ(skeleton->joints[0].parent, 1U);
  EXPECT_EQ(skeleton->joints[1].parent, Joint::none);
  EXPECT_EQ(skeleton->joints[2].parent, 0U);
}

TEST(ReadJoints, NamesTheLineOfWhatIsNoJoint) {
  for (const char* bad :
       {"1 2", "1 2 nan", "1 2 x", "1 2 3 -1", "1 2 3 0.5", "1 2 3 0 5", "1e999 0 0"}) {
    const auto skeleton = read("0 0 0\n" + std::string(bad) + "\n");
    ASSERT_FALSE(skeleton) << bad;
    EXPECT_NE(skeleton.error().message.find("joints.txt:2: "), std::string::npos)
        << skeleton.error().message;
    EXPECT_NE(skeleton.error().message.find("x y z"), std::string::npos) << "the remedy";
  }
}

TEST(ReadJoints, RefusesParentsThatAreNotThereAndEmptyFiles) {
  EXPECT_NE(read("0 0 0 2\n").error().message.find("names joint 2"), std::string::npos);
  EXPECT_NE(read("# none\n").error().message.find("has no joints"), std::string::npos);
}

} // namespace
} // namespace cagewright
