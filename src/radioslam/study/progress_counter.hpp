// Thread-safe progress counter of a study.
#pragma once

#include <cstddef>
#include <mutex>
#include <string_view>

#include "radioslam/base/progress.hpp"

namespace radioslam {

class ProgressCounter {
 public:
  ProgressCounter(const Progress& progress, std::string_view stage, std::size_t total)
      : progress_(progress), stage_(stage), total_(total) {}

  void one_more() {
    const std::lock_guard lock(mutex_);
    report_progress(progress_, stage_, static_cast<double>(++done_) / static_cast<double>(total_));
  }

 private:
  const Progress& progress_;
  std::string_view stage_;
  std::size_t total_, done_ = 0;
  std::mutex mutex_;
};

}  // namespace radioslam
