#include "radioslam/cli/freed_memory.hpp"

#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace radioslam::cli {

#if defined(__GLIBC__)
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 128 << 20);
  mallopt(M_ARENA_MAX, 1);
}

void give_back_freed_memory() { malloc_trim(0); }
#else
void keep_freed_memory() {}

void give_back_freed_memory() {}
#endif

}  // namespace radioslam::cli
