#include "io/read_file.h"

#include "io/source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>

namespace cagewright {
namespace {

Error cannot_open(const std::filesystem::path& path, std::string_view what) {
  return {ErrorCode::cannot_open, one_line(path.string()) + ": " + std::string(what)};
}

Error cannot_open(const std::filesystem::path& path, int error) {
  if (error == ENOENT || error == ENOTDIR) {
    return cannot_open(path, "there is no such file; check the name and the folder");
  }
  if (error == EACCES || error == EPERM) {
    return cannot_open(path, "the file may not be read; change its permissions");
  }
  return cannot_open(path, "the file cannot be read: " + std::generic_category().message(error) +
                               "; copy it to another place");
}

class Descriptor {
public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) {
      ::close(fd_);
    }
  }
  [[nodiscard]] int get() const { return fd_; }

private:
  int fd_;
};

} // namespace

Result<FileBytes> read_file(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    return cannot_open(path, errno);
  }
  if (S_ISDIR(status.st_mode)) {
    return cannot_open(path, "this is a folder; name a file in it");
  }
  if (!S_ISREG(status.st_mode)) {
    return cannot_open(path, "this is not a file but a device or a pipe; save it as a file first");
  }
  // Not blocking: between the two calls the file may have become a pipe.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return cannot_open(path, errno);
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > largest_file) {
    return Error{ErrorCode::too_large, one_line(path.string()) + ": the file has " +
                                           std::to_string(size) + " bytes, and at most " +
                                           std::to_string(largest_file) +
                                           " can be read; simplify the model"};
  }
  // A plain new[]: what read() fills need not be cleared first.
  std::unique_ptr<char[]> data(new (std::nothrow) char[size]);
  if (!data) {
    return Error{ErrorCode::too_large, one_line(path.string()) + ": there is no memory for its " +
                                           std::to_string(size) + " bytes; simplify the model"};
  }
  std::size_t done = 0;
  while (done < size) {
    const ssize_t got = ::read(file.get(), data.get() + done, size - done);
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got < 0) {
      return cannot_open(path, errno);
    }
    if (got == 0) {
      break; // someone cut the file meanwhile: what is left is all there is
    }
    done += static_cast<std::size_t>(got);
  }
  return FileBytes(std::move(data), done);
}

} // namespace cagewright
