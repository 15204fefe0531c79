#include "io/native_file.h"

#include <cerrno>

#include <fcntl.h>
#include <sys/stat.h>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace cagewright {

#ifdef _WIN32

FilePointer open_regular_file(const std::filesystem::path& path, std::uint64_t& size) {
  FilePointer file(_wfopen(path.c_str(), L"rb"));
  struct _stat64 status {};
  if (!file || _fstat64(_fileno(file.get()), &status) != 0) {
    return nullptr;
  }
  if ((status.st_mode & _S_IFMT) != _S_IFREG) {
    errno = EINVAL;
    return nullptr;
  }
  size = static_cast<std::uint64_t>(status.st_size);
  return file;
}

bool seek_to(std::FILE* file, std::uint64_t offset) {
  return _fseeki64(file, static_cast<std::int64_t>(offset), SEEK_SET) == 0;
}

#else

static_assert(sizeof(off_t) == 8, "compile with _FILE_OFFSET_BITS=64");

FilePointer open_regular_file(const std::filesystem::path& path, std::uint64_t& size) {
  // What was a file when the caller looked may have become a pipe.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    return nullptr;
  }
  struct stat status {};
  const bool known = ::fstat(descriptor, &status) == 0;
  FilePointer file(known && S_ISREG(status.st_mode) ? ::fdopen(descriptor, "rb") : nullptr);
  if (!file) {
    const int error = known && !S_ISREG(status.st_mode) ? EINVAL : errno;
    ::close(descriptor);
    errno = error;
    return nullptr;
  }
  size = static_cast<std::uint64_t>(status.st_size);
  return file;
}

bool seek_to(std::FILE* file, std::uint64_t offset) {
  return fseeko(file, static_cast<off_t>(offset), SEEK_SET) == 0;
}

#endif

} // namespace cagewright
