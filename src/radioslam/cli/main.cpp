#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/freed_memory.hpp"
#include "radioslam/cli/program.hpp"

int main(int argc, char** argv) {
  radioslam::cli::keep_freed_memory();
  radioslam::cli::end_cleanly();
  return radioslam::cli::run_program({argv + 1, argv + argc});
}
