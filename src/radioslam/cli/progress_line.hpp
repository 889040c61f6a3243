// Progress display: one line on standard error that overwrites itself, shown only on a terminal.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "radioslam/base/progress.hpp"

namespace radioslam::cli {

/// Shows "stage 42 %" if standard error is a terminal, otherwise nothing; clears the line on destruction.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Callback for the library; empty if standard error is not a terminal. Must not outlive this object.
  Progress progress();

 private:
  void show(std::string_view stage, double fraction);

  bool watched_;
  std::string shown_stage_;
  std::chrono::steady_clock::time_point last_shown_{};
};

}  // namespace radioslam::cli
