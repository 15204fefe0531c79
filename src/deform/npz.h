/// \file
/// NumPy's .npz files: arrays in a zip archive. Internal to this module.
#pragma once

#include "io/atomic_file.h"
#include "io/native_file.h"
#include <cagewright/core/result.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

/// What an array holds. `type` is NumPy's description: '<f8' for doubles, '<U10' for text...
struct NpyHeader {
  std::string type;
  std::vector<std::uint64_t> shape; ///< rows first; empty for a single value

  [[nodiscard]] std::uint64_t count() const;
};

/// Writes arrays one after the other, uncompressed, without holding them in memory. The file
/// appears under its name when finish() succeeds; a writer that is dropped before leaves nothing.
class NpzWriter {
public:
  static Result<NpzWriter> create(const std::filesystem::path& path);

  /// Starts an array of count() items of `item_size` bytes; exactly so many must follow.
  Status begin(std::string_view name, const NpyHeader& header, std::size_t item_size);
  Status write(std::span<const std::byte> bytes);
  Status end();

  template <class T>
  Status add(std::string_view name, const NpyHeader& header, std::span<const T> values) {
    if (Status s = begin(name, header, sizeof(T)); !s) {
      return s;
    }
    if (Status s = write(std::as_bytes(values)); !s) {
      return s;
    }
    return end();
  }

  Status finish();

private:
  struct Entry {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::uint32_t crc = 0;
  };

  explicit NpzWriter(PartFile file) : file_(std::move(file)) {}
  Status put(std::string_view bytes);

  PartFile file_;
  std::vector<Entry> entries_;
  std::uint64_t offset_ = 0;
};

/// Reads arrays from an archive, stored or deflated, front to back.
class NpzReader {
public:
  static Result<NpzReader> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view name) const;

  /// An array being read; the checksum is compared when its last byte has been read.
  class Array {
  public:
    ~Array();
    Array(Array&&) noexcept;
    Array& operator=(Array&&) = delete;

    [[nodiscard]] const NpyHeader& header() const { return header_; }
    /// Bytes that are still to be read.
    [[nodiscard]] std::uint64_t remaining() const { return remaining_; }
    /// Fills `bytes`. Errors: malformed (the data end before, or are damaged).
    Status read(std::span<std::byte> bytes);

  private:
    friend class NpzReader;
    struct Inflater;
    Array();
    [[nodiscard]] Error damaged(std::string_view how) const;

    std::string label_; // "w.npz: array 'weights'"
    NpyHeader header_;
    std::FILE* file_ = nullptr;
    std::uint64_t remaining_ = 0; // bytes of the entry, uncompressed, that are not read yet
    std::uint64_t compressed_ = 0;
    std::uint32_t crc_ = 0;
    std::uint32_t expected_crc_ = 0;
    std::unique_ptr<Inflater> inflater_;
  };

  /// Errors: malformed (no such array, or damaged).
  Result<Array> array(std::string_view name);

  /// A small array as a whole: exactly `count` items of `type`.
  template <class T>
  Result<std::vector<T>> read(std::string_view name, std::string_view type, std::uint64_t count) {
    Result<Array> source = array(name);
    if (!source) {
      return source.error();
    }
    if (source->header().type != type || source->header().count() != count ||
        source->remaining() != count * sizeof(T)) {
      return unexpected(name, source->header());
    }
    std::vector<T> values(count);
    if (Status s = source->read(std::as_writable_bytes(std::span(values))); !s) {
      return s.error();
    }
    return values;
  }

  [[nodiscard]] Error unexpected(std::string_view name, const NpyHeader& header) const;
  [[nodiscard]] const std::string& label() const { return label_; }

private:
  struct Entry {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::uint64_t compressed = 0;
    std::uint32_t crc = 0;
    std::uint16_t method = 0;
  };

  Status read_directory();

  std::string label_; // the file's name, for messages
  FilePointer file_;
  std::uint64_t file_size_ = 0;
  std::map<std::string, Entry, std::less<>> entries_;
};

} // namespace cagewright
