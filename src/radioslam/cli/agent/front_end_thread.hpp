// A robot's front end in a thread of its own, which gets samples as they come.
#pragma once

#include <memory>
#include <optional>
#include <thread>

#include "radioslam/cli/agent/inbox.hpp"
#include "radioslam/cli/agent/sample_source.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/records/resumed_log.hpp"

namespace radioslam::cli {

/// What a robot's journal has of the time before its program was started again.
struct LogBefore {
  KnownLog log;
  RecordedAtKeyframes recorded;
};

class FrontEndThread {
 public:
  enum class Poses { kKept, kReported };  ///< the latter: all go into the inbox, to be published

  /// `before`: what the robot has said when its program ran before. Keeps references.
  FrontEndThread(SampleSource& source, const RunParams& params, const std::optional<LogBefore>& before,
                 const MissionClock& clock, Inbox& inbox, Poses poses);
  ~FrontEndThread();
  FrontEndThread(const FrontEndThread&) = delete;
  FrontEndThread& operator=(const FrontEndThread&) = delete;

  /// No more samples come.
  void conclude() { source_.conclude(); }

 private:
  void run();
  void finish();
  void resume();
  void report(FrontEndNews news = {});
  void add_recorded(FrontEndNews& news);
  void add_clouds(const ScanTrajectory& track, std::size_t until, FrontEndNews& news);

  SampleSource& source_;
  const RunParams& params_;
  const std::optional<LogBefore>& before_;
  const MissionClock& clock_;
  Inbox& inbox_;
  Poses poses_;
  CloudStore clouds_;
  std::unique_ptr<FrontEnd> front_end_;  ///< once it is known what the robot measures
  std::optional<ResumedLog> resumed_;
  std::optional<Stamp> reported_cloud_;  ///< the last one's keyframe
  std::optional<Stamp> reported_recorded_;
  std::size_t reported_events_ = 0;
  bool is_finished_ = false;
  std::thread thread_;  // last, as it uses the others
};

}  // namespace radioslam::cli
