// Progress as one line on standard error that overwrites itself: only where somebody watches.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "radioslam/base/progress.hpp"

namespace radioslam::cli {

/// Shows "stage 42 %" on a terminal and nothing anywhere else; clears the line when it goes.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// A function for the library to call; empty where nobody watches. Must not outlive this object.
  Progress progress();

 private:
  void show(std::string_view stage, double fraction);

  bool watched_;
  std::string shown_stage_;
  std::chrono::steady_clock::time_point last_shown_{};
};

}  // namespace radioslam::cli
