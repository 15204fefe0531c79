#include "io/atomic_file.h"

#include "io/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace cagewright {
namespace {

namespace fs = std::filesystem;

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

// Names of files that are being written: for a program that ends in the middle of it.
std::mutex named_parts_mutex;
std::set<fs::path> named_parts;
std::atomic<bool> is_any_written = false;

// A folder as open() takes it.
fs::path folder_of(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

// The short names of parts, whatever that of the file is. Two programs writing the same file do not
// meet, and a leftover of a killed one is passed by. \returns what `make` does, tried with names
// until one is free.
template <class Make> int with_free_name(const fs::path& target, fs::path& part, Make make) {
  for (int i = 0; i < 10000; ++i) {
    part = target.parent_path() / (".cagewright-" + std::to_string(i) + ".part");
    const std::lock_guard lock(named_parts_mutex);
    const int made = make(part);
    if (made >= 0) {
      named_parts.insert(part);
    }
    if (made >= 0 || errno != EEXIST) {
      return made;
    }
  }
  return -1;
}

int create_named(const fs::path& target, fs::path& part) {
  return with_free_name(target, part, [](const fs::path& name) {
    return ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  });
}

fs::path descriptor_path(int file) {
  return "/proc/self/fd/" + std::to_string(file);
}

int link_to(int file, const fs::path& name) {
  return ::linkat(AT_FDCWD, descriptor_path(file).c_str(), AT_FDCWD, name.c_str(),
                  AT_SYMLINK_FOLLOW);
}

} // namespace

Error cannot_write(const fs::path& path, int error) {
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
  case EFBIG:
    return {ErrorCode::cannot_write,
            name + ": the limit of file sizes is reached; raise it (ulimit -f unlimited)"};
  case ENAMETOOLONG:
    return {ErrorCode::cannot_write, name + ": the name is too long; give a shorter one"};
  default:
    return {ErrorCode::cannot_write,
            name + ": cannot be written: " + std::generic_category().message(error) +
                "; choose another place"};
  }
}

PartFile::PartFile(PartFile&& other) noexcept
    : path_(std::move(other.path_)), target_(std::move(other.target_)),
      part_(std::exchange(other.part_, {})), file_(std::exchange(other.file_, -1)),
      mode_(other.mode_), direct_(other.direct_), bytes_(std::move(other.bytes_)) {}

PartFile::~PartFile() {
  if (file_ >= 0) {
    ::close(file_);
  }
  if (!part_.empty()) {
    const std::lock_guard lock(named_parts_mutex);
    ::unlink(part_.c_str());
    named_parts.erase(part_);
  }
}

Result<PartFile> PartFile::create(const fs::path& path) {
  PartFile file(path);
  file.target_ = path;
  struct stat old {};
  const bool replaces = ::stat(path.c_str(), &old) == 0;
  if (replaces && S_ISDIR(old.st_mode)) {
    return Error{ErrorCode::cannot_write,
                 one_line(path.string()) + ": this is a folder; name a file in it"};
  }
  if (replaces && !S_ISREG(old.st_mode)) {
    file.direct_ = true;
    return ::access(path.c_str(), W_OK) == 0 ? Result<PartFile>(std::move(file))
                                             : cannot_write(path, errno);
  }
  if (replaces) {
    // Renaming would succeed, against the owner's wish. The superuser's access() says yes always.
    constexpr unsigned anyone = S_IWUSR | S_IWGRP | S_IWOTH;
    if (::access(path.c_str(), W_OK) != 0 || (old.st_mode & anyone) == 0) {
      return Error{ErrorCode::cannot_write, one_line(path.string()) +
                                                ": the file that is there is protected against "
                                                "writing; choose another name or change its "
                                                "permissions (chmod u+w)"};
    }
    file.mode_ = old.st_mode & 07777U;
  }
  std::error_code ignored;
  if (fs::is_symlink(path, ignored)) {
    const fs::path real = fs::weakly_canonical(path, ignored);
    file.target_ = real.empty() ? path : real;
  }
  if (const int error = file.open_part(); error != 0) {
    return cannot_write(path, error);
  }
  return file;
}

int PartFile::open_part() {
  if (target_.filename().empty()) {
    return ENOENT;
  }
  // A name that is too long is found out now, not when the work is done.
  struct stat ignored {};
  if (::lstat(target_.c_str(), &ignored) != 0 && errno != ENOENT) {
    return errno;
  }
#ifdef O_TMPFILE
  if (::access("/proc/self/fd", X_OK) == 0) {
    file_ = ::open(folder_of(target_).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  }
#endif
  if (file_ < 0) {
    file_ = create_named(target_, part_);
  }
  if (file_ < 0) {
    part_.clear();
    return errno;
  }
  if (mode_ != 0) {
    ::fchmod(file_, mode_); // else the file system has none: nothing to keep
  }
  return 0;
}

Status PartFile::append(std::string_view bytes) {
  if (direct_) {
    bytes_.append(bytes);
    return success();
  }
  const int error = write_all(file_, bytes);
  return error == 0 ? success() : cannot_write(path_, error);
}

Status PartFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  if (direct_) {
    bytes_.replace(offset, bytes.size(), bytes);
    return success();
  }
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno != EINTR) {
      return cannot_write(path_, errno);
    }
    const std::size_t count = written < 0 ? 0 : static_cast<std::size_t>(written);
    bytes.remove_prefix(count);
    offset += count;
  }
  return success();
}

// Gives a file without a name one. 0 or what went wrong; EEXIST is not among it.
int PartFile::name_part() {
  if (mode_ == 0 && link_to(file_, target_) == 0) {
    return 0;
  }
  const int made =
      with_free_name(target_, part_, [this](const fs::path& name) { return link_to(file_, name); });
  if (made == 0) {
    return 0;
  }
  part_.clear();
  return copy_to_named_part();
}

// Where a file without a name cannot be given one after all.
int PartFile::copy_to_named_part() {
  const int copy = create_named(target_, part_);
  if (copy < 0) {
    part_.clear();
    return errno;
  }
  std::array<char, 1U << 16U> block;
  int error = ::lseek(file_, 0, SEEK_SET) == 0 ? 0 : errno;
  while (error == 0) {
    const ssize_t count = ::read(file_, block.data(), block.size());
    if (count == 0) {
      break;
    }
    error = count < 0 ? errno : write_all(copy, {block.data(), static_cast<std::size_t>(count)});
  }
  ::close(std::exchange(file_, copy));
  if (mode_ != 0) {
    ::fchmod(file_, mode_);
  }
  return error;
}

Status PartFile::commit_directly() {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  if (file_ < 0) {
    return cannot_write(path_, errno);
  }
  const int error = write_all(file_, bytes_);
  const int closing_error = ::close(std::exchange(file_, -1)) == 0 ? 0 : errno;
  return error == 0 && closing_error == 0 ? success()
                                          : cannot_write(path_, error != 0 ? error : closing_error);
}

Status PartFile::commit() {
  if (direct_) {
    return commit_directly();
  }
  int error = part_.empty() ? name_part() : 0;
  // Some file systems report a full disk only on closing.
  const int closing_error = ::close(std::exchange(file_, -1)) == 0 ? 0 : errno;
  error = error != 0 ? error : closing_error;
  if (error == 0 && !part_.empty()) {
    const std::lock_guard lock(named_parts_mutex);
    error = ::rename(part_.c_str(), target_.c_str()) == 0 ? 0 : errno;
    named_parts.erase(part_);
  }
  if (error != 0) {
    return cannot_write(path_, error); // the destructor removes the part
  }
  part_.clear();
  is_any_written = true;
  return success();
}

Status write_file_atomically(const fs::path& path, std::string_view bytes) {
  const NamedBytes file{path, bytes};
  return write_files_atomically({&file, 1});
}

Status write_files_atomically(std::span<const NamedBytes> files) {
  std::vector<PartFile> parts;
  for (const NamedBytes& file : files) {
    Result<PartFile> part = PartFile::create(file.path);
    if (!part) {
      return part.error();
    }
    parts.push_back(*std::move(part));
    if (Status status = parts.back().append(file.bytes); !status) {
      return status;
    }
  }
  // Devices first: they may yet fail, and then no file has appeared.
  std::vector<PartFile*> order;
  for (PartFile& part : parts) {
    order.push_back(&part);
  }
  std::stable_partition(order.begin(), order.end(),
                        [](const PartFile* part) { return part->is_direct(); });
  for (PartFile* part : order) {
    if (Status status = part->commit(); !status) {
      return status;
    }
  }
  return success();
}

void abandon_part_files() {
  named_parts_mutex.lock(); // for ever: nothing is to begin, or to get its name, after this
  for (const fs::path& part : named_parts) {
    ::unlink(part.c_str());
  }
}

bool has_written_files() {
  return is_any_written;
}

Status can_write_file(const fs::path& path) {
  const Result<PartFile> part = PartFile::create(path);
  return part ? success() : Status(part.error());
}

} // namespace cagewright
