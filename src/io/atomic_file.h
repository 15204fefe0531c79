/// \file
/// Files that are complete or not there.
#pragma once

#include <cagewright/core/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace cagewright {

/// A file that is being written, and appears under its name as a whole: whoever opens the name
/// finds either what was there before or all of it, also when the disk is full or the program is
/// killed.
///
/// Until commit() it has no name where the file system can do that, so that not even a program that
/// is killed leaves anything; else it is `.cagewright-N.part` in the same folder, and removed
/// unless committed. A link is followed, and the permissions of a file that is replaced are kept. A
/// file that nobody may write to is not replaced, whoever runs the program. What is no file but can
/// be written, such as /dev/stdout or a pipe, gets all bytes on commit().
class PartFile {
public:
  /// Errors: cannot_write.
  static Result<PartFile> create(const std::filesystem::path& path);

  PartFile(PartFile&& other) noexcept;
  PartFile& operator=(PartFile&&) = delete;
  ~PartFile();

  /// Adds bytes at the end. Errors: cannot_write.
  Status append(std::string_view bytes);
  /// Writes over bytes that are there. Errors: cannot_write.
  Status overwrite(std::uint64_t offset, std::string_view bytes);
  /// Gives the file its name; nothing else may follow. Errors: cannot_write.
  Status commit();

  /// The bytes go straight to a device or a pipe, which may fail on commit() where a file cannot.
  [[nodiscard]] bool is_direct() const { return direct_; }

private:
  explicit PartFile(std::filesystem::path path) : path_(std::move(path)) {}

  int open_part();
  int name_part();
  int copy_to_named_part();
  Status commit_directly();

  std::filesystem::path path_;   // as the caller has it, for messages
  std::filesystem::path target_; // links followed
  std::filesystem::path part_;   // the name until then; empty: none
  int file_ = -1;
  unsigned mode_ = 0; // of the file that is replaced; 0: none is
  bool direct_ = false;
  std::string bytes_; // where they go straight
};

/// Writes a whole file by a PartFile.
///
/// Errors: cannot_write; nothing is left behind.
Status write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

struct NamedBytes {
  std::filesystem::path path;
  std::string_view bytes;
};

/// Writes several files that belong together: all are complete before the first gets its name.
///
/// Errors: cannot_write; nothing is left behind.
Status write_files_atomically(std::span<const NamedBytes> files);

/// Removes from the disk what there is of files that are not complete, and lets no other one get a
/// name: for a program that is about to end, whatever its threads are doing.
void abandon_part_files();

/// Whether any file has got its name since the program began: what is told of a stop must not say
/// that nothing was written.
bool has_written_files();

/// Why nothing can be written there, and what helps. \param error  an errno
Error cannot_write(const std::filesystem::path& path, int error);

/// Whether such a file can be written, asked before minutes are spent on making it. Errors:
/// cannot_write.
Status can_write_file(const std::filesystem::path& path);

} // namespace cagewright
