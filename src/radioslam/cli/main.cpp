#include "radioslam/cli/program.hpp"
#include "radioslam/cli/signals.hpp"

int main(int argc, char** argv) {
  radioslam::cli::install_signal_handling();
  return radioslam::cli::run_program({argv + 1, argv + argc});
}
