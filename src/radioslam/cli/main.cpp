#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "radioslam/cli/program.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam::cli {
namespace {

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// SIGINT and SIGTERM, except those that the caller had set to be ignored (nohup, background jobs).
sigset_t ending_signals() {
  sigset_t signals{};
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM}) {
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  }
  return signals;
}

/// Runs in a thread of its own, which may lock, free memory and remove files; a signal handler may not.
void wait_for_end(sigset_t signals) {
  int signal = 0;
  if (sigwait(&signals, &signal) != 0) return;
  remove_unfinished_outputs();
  _exit(kInterrupted);
}

extern "C" void end_as_our_failure(int) { _exit(kOurFailure); }

/// Call first, before any thread starts. SIGINT and SIGTERM then remove unfinished outputs and end the
/// program with kInterrupted; a signal that was ignored when the program started stays ignored. A closed pipe
/// becomes a write error instead of a signal, and a failed RADIOSLAM_CHECK ends the program with kOurFailure.
void install_signal_handling() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGABRT, end_as_our_failure);
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(wait_for_end, signals).detach();
}

}  // namespace
}  // namespace radioslam::cli

int main(int argc, char** argv) {
  radioslam::cli::install_signal_handling();
  return radioslam::cli::run_program({argv + 1, argv + argc});
}
