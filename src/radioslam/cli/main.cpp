#include <cstdlib>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/program.hpp"

namespace {

/// Graphs are solved and freed hundreds of times; giving the memory back each time took half of the time of
/// judging a team's loops.
void keep_freed_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 128 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  radioslam::cli::end_cleanly();
  return radioslam::cli::run_program({argv + 1, argv + argc});
}
