/// \file
/// Large arrays of numbers that are written before they are read.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <type_traits>

namespace cagewright {

namespace detail {

/// Memory at a 64-byte boundary, in huge pages where it is large and the system has them. Throws
/// std::bad_alloc. To be freed by free_aligned alone.
void* allocate_aligned(std::size_t bytes);
void free_aligned(void* data) noexcept;

} // namespace detail

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
    void operator()(T* data) const { detail::free_aligned(data); }
  };

  static T* allocate(std::size_t size) {
    if (size > std::size_t(-1) / 2 / sizeof(T)) {
      throw std::bad_alloc();
    }
    return static_cast<T*>(detail::allocate_aligned(size * sizeof(T)));
  }

  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

} // namespace cagewright
