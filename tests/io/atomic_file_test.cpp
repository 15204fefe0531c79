#include "io/atomic_file.h"

#include "io/files.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>

namespace cagewright {
namespace {

using test::bytes_of;
using test::TemporaryFolder;
using Names = std::vector<std::string>;

TEST(WriteFileAtomically, WritesAndReplaces) {
  const TemporaryFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a.json", "first"));
  EXPECT_EQ(bytes_of(folder / "a.json"), "first");
  ASSERT_TRUE(write_file_atomically(folder / "a.json", std::string("sec\0nd", 6)));
  EXPECT_EQ(bytes_of(folder / "a.json"), std::string("sec\0nd", 6));
  EXPECT_EQ(folder.names(), Names{"a.json"});
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenTheNewOneCannotBeCompleted) {
  const TemporaryFolder folder;
  folder.add("a.obj", "old");
  // A limit on the size of files stands for a full disk: the second half cannot be written.
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit limit { 1 << 16, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  const Status status = write_file_atomically(folder / "a.obj", std::string(1 << 17, 'x'));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::cannot_write);
  EXPECT_EQ(folder.names(), Names{"a.obj"});
  EXPECT_EQ(bytes_of(folder / "a.obj"), "old");
}

TEST(WriteFileAtomically, SaysWhyItCannot) {
  const TemporaryFolder folder;
  const auto message = [&](const std::filesystem::path& path) {
    const Status status = write_file_atomically(path, "x");
    EXPECT_FALSE(status);
    return status ? "written" : status.error().message;
  };
  EXPECT_EQ(message(folder.path()),
            folder.path().string() + ": this is a folder; name a file in it");
  EXPECT_EQ(message(folder / "none/a.obj"),
            (folder / "none/a.obj").string() + ": the folder does not exist; create it first");
  folder.add("file", "");
  EXPECT_EQ(message(folder / "file/a.obj"),
            (folder / "file/a.obj").string() + ": the folder does not exist; create it first");
  EXPECT_FALSE(write_file_atomically("", "x"));
  EXPECT_FALSE(write_file_atomically(folder / std::string(300, 'n'), "x"));
  EXPECT_EQ(folder.names(), Names{"file"});
}

TEST(WriteFileAtomically, RespectsAFileThatMayNotBeWritten) {
  const TemporaryFolder folder;
  ::chmod(folder.add("a.obj", "old").c_str(), 0444); // root might write, but should not either
  const Status status = write_file_atomically(folder / "a.obj", "new");
  ASSERT_FALSE(status);
  EXPECT_EQ(bytes_of(folder / "a.obj"), "old");
}

TEST(WriteFileAtomically, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  ::chmod(folder.add("real.obj", "old").c_str(), 0640);
  std::filesystem::create_symlink("real.obj", folder / "link.obj");
  ASSERT_TRUE(write_file_atomically(folder / "link.obj", "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.obj"));
  EXPECT_EQ(bytes_of(folder / "real.obj"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((folder / "real.obj").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(WriteFileAtomically, TakesNamesOfAnyLength) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  ASSERT_TRUE(write_file_atomically(folder / name, "x"));
  EXPECT_EQ(folder.names(), Names{name});
}

TEST(WriteFileAtomically, PassesByWhatAKilledProgramLeft) {
  const TemporaryFolder folder;
  folder.add(".cagewright-0.part", "half");
  ASSERT_TRUE(write_file_atomically(folder / "a.obj", "whole"));
  EXPECT_EQ(bytes_of(folder / "a.obj"), "whole");
  EXPECT_EQ(folder.names(), (Names{".cagewright-0.part", "a.obj"}));
}

TEST(WriteFilesAtomically, WritesAllOrNone) {
  const TemporaryFolder folder;
  const std::vector<NamedBytes> files = {{folder / "a.obj", "mesh"},
                                         {folder / "none/a.json", "{}"}};
  EXPECT_FALSE(write_files_atomically(files));
  EXPECT_EQ(folder.names(), Names{});
  const std::vector<NamedBytes> full = {{folder / "a.obj", "mesh"}, {"/dev/full", "{}"}};
  EXPECT_FALSE(write_files_atomically(full)); // the device is written first
  EXPECT_EQ(folder.names(), Names{});
  const std::vector<NamedBytes> both = {{folder / "a.obj", "mesh"}, {folder / "a.json", "{}"}};
  EXPECT_TRUE(write_files_atomically(both));
  EXPECT_EQ(folder.names(), (Names{"a.json", "a.obj"}));
}

TEST(PartFile, LeavesNothingUnlessCommitted) {
  const TemporaryFolder folder;
  {
    Result<PartFile> file = PartFile::create(folder / "a.bin");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->append("0123"));
    ASSERT_TRUE(file->overwrite(1, "xy"));
  }
  EXPECT_EQ(folder.names(), Names{});
  Result<PartFile> file = PartFile::create(folder / "a.bin");
  ASSERT_TRUE(file && file->append("0123") && file->overwrite(1, "xy") && file->commit());
  EXPECT_EQ(bytes_of(folder / "a.bin"), "0xy3");
}

TEST(WriteFileAtomically, WritesDevicesDirectly) {
  ASSERT_TRUE(write_file_atomically("/dev/null", "x"));
  struct stat status {};
  ASSERT_EQ(::stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode)); // and does not put a file in their place
}

} // namespace
} // namespace cagewright
