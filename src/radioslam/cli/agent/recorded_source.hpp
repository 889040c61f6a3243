// A robot's recording, sample by sample at the pace of the mission's clock. A front end that does not keep up
// falls behind; nothing is left out.
#pragma once

#include <condition_variable>
#include <mutex>

#include "radioslam/cli/agent/mission_clock.hpp"
#include "radioslam/cli/agent/sample_source.hpp"
#include "radioslam/front_end/recorded_samples.hpp"

namespace radioslam::cli {

class RecordedSource : public SampleSource {
 public:
  /// `goes_on`: the robot's program ran before; it goes on with what is recorded from now on. Without it, all
  /// that is recorded so far comes at once. Keeps references.
  RecordedSource(const Mission& mission, RobotIndex self, bool goes_on, const MissionClock& clock);

  std::optional<MotionSources> begin() override;
  const Mission& names() const override { return mission_; }
  RobotIndex self() const override { return self_; }
  bool odometry_goes_on() const override { return true; }
  std::optional<Sample> next() override;
  void conclude() override;

 private:
  const Mission& mission_;
  RobotIndex self_;
  bool goes_on_;
  const MissionClock& clock_;
  RecordedSamples samples_;
  std::mutex mutex_;
  std::condition_variable concluded_;
  bool is_concluded_ = false;
};

}  // namespace radioslam::cli
