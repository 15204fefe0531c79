/// \file
/// Large arrays of numbers that are written before they are read.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace cagewright {

/// N numbers at a 64-byte boundary (a cache line, and the widest vector), *not* set to anything:
/// filling a gigabyte with zeros first costs as much as computing it, and whoever writes a page
/// first should be the thread that goes on with it.
template <class T> class AlignedBuffer {
  static_assert(std::is_trivial_v<T>);

public:
  AlignedBuffer() = default;
  explicit AlignedBuffer(std::size_t size) : data_(allocate(size)), size_(size) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_.get(); }
  [[nodiscard]] const T* data() const { return data_.get(); }
  [[nodiscard]] std::span<T> span() { return {data(), size_}; }
  [[nodiscard]] std::span<const T> span() const { return {data(), size_}; }

private:
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };

  static T* allocate(std::size_t size) {
    constexpr std::size_t huge_page = std::size_t(1) << 21U;
    if (size > (static_cast<std::size_t>(-1) / 2) / sizeof(T)) {
      throw std::bad_alloc();
    }
    const std::size_t alignment = size * sizeof(T) >= 4 * huge_page ? huge_page : 64;
    const std::size_t bytes = (size * sizeof(T) + alignment - 1) / alignment * alignment;
    void* data = std::aligned_alloc(alignment, bytes > 0 ? bytes : alignment);
    if (data == nullptr) {
      throw std::bad_alloc();
    }
#ifdef __linux__
    if (alignment == huge_page) {
      // Mapping a fresh gigabyte by pages of 4 kB takes longer than filling it. Only advice:
      // where it is refused everything still works.
      (void)madvise(data, bytes, MADV_HUGEPAGE);
    }
#endif
    return static_cast<T*>(data);
  }

  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

} // namespace cagewright
