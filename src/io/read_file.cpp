#include "io/read_file.h"

#include "io/native_file.h"
#include "io/source.h"

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

} // namespace

Result<FileBytes> read_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return cannot_open(path, error ? error.default_error_condition().value() : ENOENT);
  }
  if (std::filesystem::is_directory(status)) {
    return cannot_open(path, "this is a folder; name a file in it");
  }
  if (!std::filesystem::is_regular_file(status)) {
    return cannot_open(path, "this is not a file but a device or a pipe; save it as a file first");
  }
  std::uint64_t size = 0;
  const FilePointer file = open_regular_file(path, size);
  if (!file) {
    return cannot_open(path, errno);
  }
  if (size > largest_file) {
    return Error{ErrorCode::too_large, one_line(path.string()) + ": the file has " +
                                           std::to_string(size) + " bytes, and at most " +
                                           std::to_string(largest_file) +
                                           " can be read; simplify the model"};
  }
  // A plain new[]: what read() fills need not be cleared first.
  std::unique_ptr<char[]> data(new (std::nothrow) char[static_cast<std::size_t>(size)]);
  if (!data) {
    return Error{ErrorCode::too_large, one_line(path.string()) + ": there is no memory for its " +
                                           std::to_string(size) + " bytes; simplify the model"};
  }
  errno = 0;
  // Fewer where someone has cut the file meanwhile: what is left is all there is.
  const std::size_t done = std::fread(data.get(), 1, static_cast<std::size_t>(size), file.get());
  if (std::ferror(file.get()) != 0) {
    return cannot_open(path, errno);
  }
  return FileBytes(std::move(data), done);
}

} // namespace cagewright
