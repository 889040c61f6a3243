#include "radioslam/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace radioslam {
namespace {

std::atomic<std::size_t> g_threads{0};
std::atomic<std::ptrdiff_t> g_helpers{0};  // threads at work in loops, less those that called one

/// Takes as many helpers for a loop as are wanted and free: a loop within another one gets what that leaves.
std::size_t take_helpers(std::size_t wanted) {
  const auto limit = static_cast<std::ptrdiff_t>(thread_count()) - 1;
  std::ptrdiff_t busy = g_helpers, taken = 0;
  do {
    taken = std::clamp<std::ptrdiff_t>(limit - busy, 0, static_cast<std::ptrdiff_t>(wanted));
  } while (!g_helpers.compare_exchange_weak(busy, busy + taken));
  return static_cast<std::size_t>(taken);
}

}  // namespace

void set_thread_count(std::size_t threads) { g_threads = threads; }

std::size_t thread_count() {
  static const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());  // reads a system file
  const std::size_t chosen = g_threads;
  return chosen > 0 ? chosen : cores;
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  const std::size_t chunk = std::max<std::size_t>({std::size_t{1}, grain});
  const std::size_t chunks = (count + chunk - 1) / chunk;
  if (count == 0) return;
  const std::size_t helpers = take_helpers(chunks - 1);
  if (helpers == 0) return body(0, count);
  std::atomic<std::size_t> next_chunk{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (std::size_t c = next_chunk++; c < chunks; c = next_chunk++) {
      try {
        body(c * chunk, std::min(count, (c + 1) * chunk));
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        if (!failure) failure = std::current_exception();
      }
    }
  };
  // Who runs out of chunks, the caller too, leaves its place to loops within the chunks that remain.
  const auto work_and_leave = [&] {
    work();
    --g_helpers;
  };
  std::vector<std::jthread> threads;
  for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(work_and_leave);
  work_and_leave();
  threads.clear();
  ++g_helpers;
  if (failure) std::rethrow_exception(failure);
}

}  // namespace radioslam
