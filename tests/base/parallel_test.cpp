#include "radioslam/base/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace radioslam {
namespace {

class ParallelFor : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override { set_thread_count(GetParam()); }
  void TearDown() override { set_thread_count(0); }
};

TEST_P(ParallelFor, VisitsEveryItemOnce) {
  std::vector<int> visits(1001, 0);
  parallel_for(visits.size(), 10, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) ++visits[i];
  });
  for (const int v : visits) EXPECT_EQ(v, 1);
}

TEST_P(ParallelFor, RethrowsWhatABodyThrew) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t begin, std::size_t) {
                              if (begin == 0) throw std::runtime_error("no");
                            }),
               std::runtime_error);
}

TEST_P(ParallelFor, DoesNothingForNothing) {
  parallel_for(0, 1, [](std::size_t, std::size_t) { FAIL(); });
}

TEST_P(ParallelFor, NeverUsesMoreThreadsThanAreAllowed) {
  std::atomic<std::size_t> running{0}, most{0};
  std::vector<int> visits(600, 0);
  parallel_for(6, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part)
      parallel_for(100, 5, [&, part](std::size_t begin, std::size_t end) {
        const std::size_t now = ++running;
        std::size_t before = most;
        while (before < now && !most.compare_exchange_weak(before, now)) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        for (std::size_t i = begin; i < end; ++i) ++visits[100 * part + i];
        --running;
      });
  });
  for (const int v : visits) EXPECT_EQ(v, 1);
  EXPECT_LE(most, GetParam());
}

TEST_P(ParallelFor, AThreadThatIsDoneHelpsALoopWithinWhatRemains) {
  std::set<std::thread::id> threads;
  std::mutex mutex;
  parallel_for(2, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      if (part == 0) continue;  // done at once
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
      parallel_for(300, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
          const std::lock_guard lock(mutex);
          threads.insert(std::this_thread::get_id());
        }
      });
    }
  });
  EXPECT_EQ(threads.size(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelFor, testing::Values(1, 2, 5));

}  // namespace
}  // namespace radioslam
