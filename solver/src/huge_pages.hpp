#pragma once
// Memory for arrays that a step reads from end to end.

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <vector>

namespace crossdem {

/// Asks for large arrays in pages of 2 MiB, where the system has them: with the common ones of 4 KiB a processor spends
/// a good part of a step of a million particles in finding out where they are.
template <class T>
struct HugePages {
  using value_type = T;

  HugePages() = default;
  template <class Other>
  explicit HugePages(const HugePages<Other>&) {}

  [[nodiscard]] static T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes < page) return static_cast<T*>(::operator new(bytes, small_alignment));
    void* array = ::operator new (bytes, std::align_val_t{page});
    (void)madvise(array, bytes, MADV_HUGEPAGE);  // a wish: refused, the array is slower and no less good
    return static_cast<T*>(array);
  }
  static void deallocate(T* array, std::size_t count) {
    ::operator delete (array, count * sizeof(T) < page ? small_alignment : std::align_val_t{page});
  }

  bool operator==(const HugePages&) const { return true; }

 private:
  static constexpr std::size_t page = std::size_t{1} << 21U;
  static constexpr std::align_val_t small_alignment{alignof(T)};
};

template <class T>
using LargeArray = std::vector<T, HugePages<T>>;

}  // namespace crossdem
