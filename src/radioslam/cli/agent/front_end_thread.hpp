// A robot's front end in a thread of its own, which gets the robot's recording at the pace of the mission's
// clock. A front end that does not keep up falls behind; it leaves nothing out.
#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "radioslam/cli/agent/inbox.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/records/resumed_log.hpp"

namespace radioslam::cli {

class PacedFrontEnd {
 public:
  /// `before`: what the robot has said when its program ran before; it goes on with what is recorded from now
  /// on. Without it, all that is recorded so far comes at once. Keeps references.
  PacedFrontEnd(const Mission& mission, RobotIndex self, const RunParams& params,
                const std::optional<KnownLog>& before, const MissionClock& clock, Inbox& inbox);
  ~PacedFrontEnd();
  PacedFrontEnd(const PacedFrontEnd&) = delete;
  PacedFrontEnd& operator=(const PacedFrontEnd&) = delete;

  /// The recording ends here.
  void conclude();

 private:
  void run();
  bool wait_until(Stamp stamp);
  void report(FrontEndNews news = {});
  void add_clouds(const ScanTrajectory& track, std::size_t until, FrontEndNews& news);

  const Mission& mission_;
  RobotIndex self_;
  const RunParams& params_;
  const MissionClock& clock_;
  Inbox& inbox_;
  CloudStore clouds_;
  FrontEnd front_end_;
  std::optional<ResumedLog> resumed_;
  std::optional<Stamp> reported_cloud_;  ///< the last one's keyframe
  std::size_t reported_events_ = 0;
  bool is_finished_ = false;
  std::mutex mutex_;
  std::condition_variable concluded_;
  bool is_concluded_ = false;
  std::thread thread_;  // last, as it uses the others
};

}  // namespace radioslam::cli
