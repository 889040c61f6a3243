#include "radioslam/places/loops/kept_submaps.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

Submap submap_of(double spacing_m) { return Submap(LocalMap(spacing_m, {})); }

TEST(KeptSubmaps, MakeEachOnce) {
  KeptSubmaps submaps;
  std::atomic<int> made = 0;
  set_thread_count(4);
  parallel_for(200, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t place = k % 10;
      const auto submap = submaps.around(place, [&] {
        ++made;
        return submap_of(0.1 * static_cast<double>(place + 1));
      });
      EXPECT_NEAR(submap->fine().max_distance_m(), 0.3 * static_cast<double>(place + 1), 1e-9);
    }
  });
  set_thread_count(0);
  EXPECT_EQ(made, 10);
}

/// Of more places than are kept, what is in use stays valid.
TEST(KeptSubmaps, OutliveBeingForgotten) {
  KeptSubmaps submaps;
  const auto first = submaps.around(0, [] { return submap_of(0.1); });
  for (std::size_t k = 1; k < 1000; ++k) submaps.around(k, [] { return submap_of(0.2); });
  EXPECT_NEAR(first->fine().max_distance_m(), 0.3, 1e-9);
}

}  // namespace
}  // namespace radioslam
