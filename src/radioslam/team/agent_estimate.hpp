// An agent's estimate of its team: records in, jobs out, and where they place the robots.
//
// An estimate is of what was measured until kCut_s ago: by then it is known throughout a team in contact, so
// that its robots estimate from the same records and come to the same result. Since then poses follow
// odometry.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/live/growing_estimate.hpp"
#include "radioslam/live/published_frames.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam {

using AnyGrownEstimate = std::variant<GrownEstimate<SE2>, GrownEstimate<SE3>>;

/// An estimate of a mission in the plane or in space; null before the first.
using AnySolution =
    std::variant<std::shared_ptr<const TeamSolution<SE2>>, std::shared_ptr<const TeamSolution<SE3>>>;

/// Work that depends on nothing but what the job holds: two jobs of the same key have the same result, on any
/// machine. The parameters must outlive it.
struct EstimateJob {
  std::string key;
  std::function<AnyGrownEstimate()> run;
};

/// Closures that scans give: within this robot, and between it and later ones in the team's order.
struct ScanResult {
  ScansSoFar own;                                         ///< with what was tried
  std::shared_ptr<const RecognisedPlaces> tried;          ///< between robots
  std::vector<std::pair<Stamp, ClosureRecord>> closures;  ///< without the pose from which they are measured
  bool has_left_out = false;                              ///< pairs that are worth a registration, too
};
/// As an EstimateJob, but of this robot alone.
struct ScanJob {
  std::function<ScanResult()> run;
};

/// A closure of the last estimate, at keyframes of two robots, or of one.
struct JudgedClosure {
  std::string i, j;
  Stamp stamp_i, stamp_j;
  bool is_accepted = false;
};

class AgentEstimate {
 public:
  static constexpr double kCut_s = 3;

  virtual ~AgentEstimate() = default;

  /// The next record of a robot's log, encoded and valid.
  virtual void hear(const std::string& robot, const std::string& record) = 0;
  /// An estimate may be due. Nothing while one is made.
  virtual std::optional<EstimateJob> job(Stamp now) = 0;
  /// What a job gave. Returns what moved.
  virtual std::vector<TeamEvent> take(const AnyGrownEstimate& result, Stamp now) = 0;

  /// Work on scans: `own` of robot `self`, and those of others that it was sent. `tried`: what the last job
  /// gave, or null. At most so many registrations, those of greatest worth; half of them within the robot
  /// where there are more. Nothing before the first estimate.
  virtual std::optional<ScanJob> scan_job(const std::string& self, const ScansSoFar& own,
                                          const std::map<std::string, ScansSoFar>& others,
                                          std::shared_ptr<const RecognisedPlaces> tried,
                                          std::size_t registrations) const = 0;
  /// Keyframes of another robot within `range_m` of this robot's way in any of the likely alignments,
  /// `stride_m` apart. Where nothing aligns the two, any may be; these are farther apart.
  virtual std::vector<Stamp> near(const std::string& self, const std::string& other, double range_m,
                                  double stride_m) const = 0;

  virtual const PublishedFrames& frames() const = 0;
  /// As their logs say them, up to the last job.
  virtual const std::map<std::string, LoggedKeyframes>& keyframes() const = 0;
  /// The robots of the frame with the most, as the last estimate places them.
  virtual std::vector<EstimatedTrajectory> largest_frame() const = 0;
  /// By scans, and those that were recorded.
  virtual std::vector<JudgedClosure> closures() const = 0;
  virtual std::size_t records() const = 0;
  virtual AnySolution solution() const = 0;
};

std::unique_ptr<AgentEstimate> agent_estimate(int dimension, const RunParams& params,
                                              const StreamParams& stream);

}  // namespace radioslam
