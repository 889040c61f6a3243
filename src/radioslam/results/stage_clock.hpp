// Wall time per stage of a run, in the order of the stages.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "radioslam/results/results.hpp"

namespace radioslam {

/// Calls stages and records how long each takes, in all of its calls:
///   StageClock timed;
///   auto radio = timed("radio", measure_radio, mission, params, progress);
class StageClock {
 public:
  template <class Stage, class... Arguments>
  auto operator()(std::string_view name, Stage&& stage, Arguments&&... arguments) {
    const auto begin = Clock::now();
    if constexpr (std::is_void_v<std::invoke_result_t<Stage, Arguments...>>) {
      std::invoke(std::forward<Stage>(stage), std::forward<Arguments>(arguments)...);
      record(name, begin);
    } else {
      auto result = std::invoke(std::forward<Stage>(stage), std::forward<Arguments>(arguments)...);
      record(name, begin);
      return result;
    }
  }

  const std::vector<StageTiming>& timings() const { return timings_; }

 private:
  using Clock = std::chrono::steady_clock;

  void record(std::string_view name, Clock::time_point begin) {
    const std::chrono::duration<double> spent = Clock::now() - begin;
    for (StageTiming& stage : timings_)
      if (stage.stage == name) return void(stage.seconds += spent.count());
    timings_.push_back({std::string(name), spent.count()});
  }

  std::vector<StageTiming> timings_;
};

}  // namespace radioslam
