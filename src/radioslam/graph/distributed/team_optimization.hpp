// Runs an optimization without a centre in one process: every robot's solver has its own part of the graph,
// and what they say to each other passes through a simulated network as bytes.
#pragma once

#include <string_view>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/graph/distributed/distributed_solver.hpp"
#include "radioslam/graph/distributed/frames.hpp"
#include "radioslam/graph/distributed/outliers.hpp"
#include "radioslam/graph/distributed/simulated_network.hpp"

namespace radioslam {

enum class DistributedMethod { kTwoStage, kBlockCoordinate, kAsynchronous, kAlternating, kSeparators };

/// A method's name, and what it needs of the network.
struct DistributedMethodInfo {
  const char* name;
  DistributedMethod method;
  bool bears_loss, bears_delay;  ///< it still ends at the optimum, and not before
};
inline constexpr auto kDistributedMethods = std::to_array<DistributedMethodInfo>({
    {"separators", DistributedMethod::kSeparators, false, true},
    {"asynchronous", DistributedMethod::kAsynchronous, true, true},
    {"block-coordinate", DistributedMethod::kBlockCoordinate, true, true},
    {"two-stage", DistributedMethod::kTwoStage, false, false},
    {"alternating", DistributedMethod::kAlternating, false, false},
});

struct TeamOptimizationParams {
  DistributedMethod method = DistributedMethod::kSeparators;
  int max_rounds = 1000;
  FrameVoteParams frames;
  OutlierParams outliers;
  NetworkParams network;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(max_rounds, "", 1, 1e6,
                          "largest number of rounds of an optimization without a centre");
  }
  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("frames", self.frames);
    visit("outliers", self.outliers);
    visit("network", self.network);
  }
};

struct RoundTrace {
  double cost = 0;         ///< of the factors whose poses are in one frame, after the round
  bool one_frame = false;  ///< every factor's poses are
  Traffic traffic;
};

template <class Pose>
struct TeamOptimization {
  RoundTrace start;  ///< before the first round: every robot has optimised its own graph
  std::vector<RoundTrace> rounds;
  std::vector<Pose> poses;    ///< as the robots have them when they stop
  std::vector<Frame> frames;  ///< per pose
  /// Every robot has stopped by itself, and what shares factors with nobody is at an optimum of its own.
  bool settled = false;
  std::vector<double> weights;  ///< per relative pose of the graph, of graduated optimization
  std::size_t refused = 0;      ///< messages
};

/// `graph` has relative poses only. Its values are each robot's own start: they matter up to a rigid motion
/// of each of its connected parts.
template <class Pose>
TeamOptimization<Pose> optimize_team(const PoseGraph<Pose>& graph, const TeamPoses& team,
                                     const TeamOptimizationParams& params, const Progress& progress = {});

}  // namespace radioslam
