#include <cagewright/coordinates/aligned_buffer.h>

#include <cstdlib>

#ifdef _WIN32
#include <malloc.h>
#endif
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace cagewright::detail {
namespace {

constexpr std::size_t huge_page = std::size_t(1) << 21U;

void* allocate(std::size_t alignment, std::size_t bytes) {
#ifdef _WIN32
  return _aligned_malloc(bytes, alignment);
#else
  return std::aligned_alloc(alignment, bytes);
#endif
}

// Mapping a fresh gigabyte by pages of 4 kB takes longer than filling it. Only advice: where it is
// refused everything still works.
void advise_huge_pages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  (void)madvise(data, bytes, MADV_HUGEPAGE);
#endif
}

} // namespace

void* allocate_aligned(std::size_t bytes) {
  const std::size_t alignment = bytes >= 4 * huge_page ? huge_page : 64;
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  void* data = allocate(alignment, whole > 0 ? whole : alignment);
  if (data == nullptr) {
    throw std::bad_alloc();
  }
  if (alignment == huge_page) {
    advise_huge_pages(data, whole);
  }
  return data;
}

void free_aligned(void* data) noexcept {
#ifdef _WIN32
  _aligned_free(data);
#else
  std::free(data);
#endif
}

} // namespace cagewright::detail
