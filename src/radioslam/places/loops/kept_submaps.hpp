// Submaps around a robot's keyframes, kept from one search to the next: a keyframe is compared with several
// scans, and found again among those that look alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "radioslam/lidar/submap.hpp"

namespace radioslam {

/// Thread-safe. Keeps those used last, some ten megabytes of them; nothing depends on which.
class KeptSubmaps {
 public:
  /// That around keyframe k; `make` is called unless it is kept, and must give the same whenever it is.
  std::shared_ptr<const Submap> around(std::size_t k, const std::function<Submap()>& make);

 private:
  struct Place {
    std::once_flag is_made;
    std::shared_ptr<const Submap> submap;
    std::uint64_t last_use = 0;
    std::size_t bytes = 0;  ///< 0: not made yet
  };

  void forget_beyond_bound();

  std::mutex mutex_;
  std::map<std::size_t, std::shared_ptr<Place>> places_;
  std::uint64_t uses_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace radioslam
