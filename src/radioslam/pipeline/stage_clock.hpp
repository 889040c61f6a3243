// Wall time per stage of a run, in the order of the stages.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "radioslam/results/results.hpp"

namespace radioslam {

class StageClock {
 public:
  /// `timings` must outlive this.
  explicit StageClock(std::vector<StageTiming>& timings) : timings_(timings) {}

  /// Runs `stage` and notes how long it took.
  template <class Work>
  auto time(std::string_view stage, Work&& work) {
    const auto begin = Clock::now();
    if constexpr (std::is_void_v<decltype(work())>) {
      work();
      note(stage, begin);
    } else {
      auto result = work();
      note(stage, begin);
      return result;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  void note(std::string_view stage, Clock::time_point begin) {
    const std::chrono::duration<double> spent = Clock::now() - begin;
    timings_.push_back({std::string(stage), spent.count()});
  }

  std::vector<StageTiming>& timings_;
};

}  // namespace radioslam
