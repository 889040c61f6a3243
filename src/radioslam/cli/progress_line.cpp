#include "radioslam/cli/progress_line.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace radioslam::cli {
namespace {

constexpr std::chrono::milliseconds kRedrawInterval{100};
constexpr const char* kClearLine = "\r\033[K";

}  // namespace

ProgressLine::ProgressLine() : watched_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (watched_ && !shown_stage_.empty()) std::fputs(kClearLine, stderr);
}

Progress ProgressLine::progress() {
  if (!watched_) return {};
  return [this](std::string_view stage, double fraction) { show(stage, fraction); };
}

void ProgressLine::show(std::string_view stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (stage == shown_stage_ && now - last_shown_ < kRedrawInterval) return;
  shown_stage_ = stage;
  last_shown_ = now;
  std::fprintf(stderr, "%s%s %d %%", kClearLine, shown_stage_.c_str(),
               static_cast<int>(std::floor(100 * fraction)));
}

}  // namespace radioslam::cli
