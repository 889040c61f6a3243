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
  const std::size_t workers = std::min(thread_count(), chunks);
  if (workers <= 1) {
    if (count > 0) body(0, count);
    return;
  }
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
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < workers; ++i) threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace radioslam
