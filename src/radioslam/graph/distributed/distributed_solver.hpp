// One robot's part of an optimization without a centre: what it does in a round, given what it heard.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

template <class Pose>
class DistributedSolver {
 public:
  virtual ~DistributedSolver() = default;

  /// One round: takes what was heard since the last one, in any order, and returns at most one message for
  /// every robot that this one shares factors with.
  virtual std::vector<Message<Pose>> round(const std::vector<Message<Pose>>& heard) = 0;
  /// Whether the robot's estimate no longer changes, as far as it can know.
  virtual bool settled() const = 0;
  /// Whether none of the robots that it shares factors with counts as gone.
  virtual bool hears_neighbours() const { return true; }
  /// Own poses, the best estimate so far.
  virtual std::vector<Pose> poses() const = 0;
  /// Per own pose, the frame it is in.
  virtual std::vector<Frame> frames() const = 0;
  /// Messages whose content did not fit the robot's factors.
  virtual std::size_t refused() const = 0;
  /// Per relative pose of the robot's graph, what graduated optimization made of it; nothing where the robot
  /// has not judged it. Empty: none was.
  virtual std::vector<std::optional<double>> weights() const { return {}; }
};

}  // namespace radioslam
