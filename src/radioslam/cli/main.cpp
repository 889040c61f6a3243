#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/program.hpp"

int main(int argc, char** argv) {
  radioslam::cli::end_cleanly();
  return radioslam::cli::run_program({argv + 1, argv + argc});
}
