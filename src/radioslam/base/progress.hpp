// Progress reports of long computations. The library never prints; the caller decides what to do with them.
#pragma once

#include <functional>
#include <string_view>

namespace radioslam {

/// Called with a stage's name and the completed fraction, 0 to 1. May be empty.
using Progress = std::function<void(std::string_view stage, double fraction)>;

inline void report_progress(const Progress& progress, std::string_view stage, double fraction) {
  if (progress) progress(stage, fraction);
}

}  // namespace radioslam
