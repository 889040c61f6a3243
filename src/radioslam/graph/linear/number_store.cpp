#include "radioslam/graph/linear/number_store.hpp"

#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace radioslam {
namespace {

constexpr std::size_t kLargePage = std::size_t{2} << 20;
constexpr std::size_t kCacheLine = 64;

/// Of an array that spans some large pages, and of a smaller one.
std::size_t alignment(std::size_t size) {
  return size * sizeof(double) >= 2 * kLargePage ? kLargePage : kCacheLine;
}

double* allocate(std::size_t size) {
  const std::size_t bytes = size * sizeof(double);
  auto* const values = static_cast<double*>(::operator new (bytes, std::align_val_t{alignment(size)}));
#ifdef __linux__
  // Only advice: where it is refused, the pages are small ones.
  if (alignment(size) == kLargePage) madvise(values, bytes, MADV_HUGEPAGE);
#endif
  return values;
}

}  // namespace

NumberStore::NumberStore(std::size_t size) : values_(allocate(size), Free{alignment(size)}), size_(size) {}

void NumberStore::Free::operator()(double* values) const {
  ::operator delete (values, std::align_val_t{alignment});
}

}  // namespace radioslam
