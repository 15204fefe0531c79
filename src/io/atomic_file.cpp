#include "io/atomic_file.h"

#include "io/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace cagewright {
namespace {

Error cannot_write(const std::filesystem::path& path, int error) {
  const std::string name = one_line(path.string());
  switch (error) {
  case ENOENT:
  case ENOTDIR:
    return {ErrorCode::cannot_write, name + ": the folder does not exist; create it first"};
  case EACCES:
  case EPERM:
  case EROFS:
    return {ErrorCode::cannot_write,
            name + ": writing is not permitted; choose another place or change the permissions"};
  case ENOSPC:
  case EDQUOT:
    return {ErrorCode::cannot_write, name + ": the disk is full; free some space"};
  default:
    return {ErrorCode::cannot_write,
            name + ": cannot be written: " + std::generic_category().message(error) +
                "; choose another place"};
  }
}

// Writes all bytes; 0 or what went wrong.
int write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) {
      return errno;
    }
    bytes.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
  return 0;
}

// Writes and closes; 0 or what went wrong. Some file systems report a full disk only on closing.
int fill_and_close(int file, std::string_view bytes) {
  const int error = write_all(file, bytes);
  const int closing_error = ::close(file) == 0 ? 0 : errno;
  return error != 0 ? error : closing_error;
}

// A new file beside `path`, and its name. The name is short, whatever that of `path` is, and free:
// two programs writing the same file do not meet, and a leftover of a killed one is passed by.
int create_beside(const std::filesystem::path& path, std::filesystem::path& part) {
  for (int i = 0; i < 10000; ++i) {
    part = path.parent_path() / (".cagewright-" + std::to_string(i) + ".part");
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) {
      return file;
    }
  }
  return -1;
}

Status write_directly(const std::filesystem::path& path, std::string_view bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) {
    return cannot_write(path, errno);
  }
  const int error = fill_and_close(file, bytes);
  return error == 0 ? success() : cannot_write(path, error);
}

} // namespace

Status write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  std::filesystem::path target = path;
  struct stat old {};
  const bool replaces = ::stat(path.c_str(), &old) == 0;
  if (replaces && S_ISDIR(old.st_mode)) {
    return Error{ErrorCode::cannot_write,
                 one_line(path.string()) + ": this is a folder; name a file in it"};
  }
  if (replaces && !S_ISREG(old.st_mode)) {
    return write_directly(path, bytes);
  }
  if (replaces) {
    if (::access(path.c_str(), W_OK) != 0) { // renaming would succeed, against the owner's wish
      return cannot_write(path, errno);
    }
    std::error_code ignored;
    const std::filesystem::path real = std::filesystem::canonical(path, ignored);
    target = real.empty() ? path : real;
  }
  std::filesystem::path part;
  const int file = create_beside(target, part);
  if (file < 0) {
    return cannot_write(path, errno);
  }
  if (replaces) {
    ::fchmod(file, old.st_mode & 07777U); // else the file system has none: nothing to keep
  }
  int error = fill_and_close(file, bytes);
  if (error == 0 && ::rename(part.c_str(), target.c_str()) != 0) {
    error = errno;
  }
  if (error != 0) {
    ::unlink(part.c_str());
    return cannot_write(path, error);
  }
  return success();
}

} // namespace cagewright
