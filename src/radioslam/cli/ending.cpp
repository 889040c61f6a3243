#include "radioslam/cli/ending.hpp"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "radioslam/cli/program.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam::cli {
namespace {

std::atomic<bool> g_concludes = false, g_is_to_conclude = false;

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
  do {
    if (sigwait(&signals, &signal) != 0) return;
  } while (g_concludes && !g_is_to_conclude.exchange(true));
  remove_unfinished_outputs();
  _exit(kInterrupted);
}

extern "C" void end_as_our_failure(int) { _exit(kOurFailure); }

}  // namespace

void end_cleanly() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGABRT, end_as_our_failure);
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread(wait_for_end, signals).detach();
}

void conclude_on_signal() { g_concludes = true; }

bool is_to_conclude() { return g_is_to_conclude; }

}  // namespace radioslam::cli
