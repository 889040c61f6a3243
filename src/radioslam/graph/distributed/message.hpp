// What robots say to each other while they optimise together, and its bytes.
//
// A message is about the poses in factors between its two robots, or, on the way up and down a tree of the
// team, about poses in factors between a subtree and the rest; never about a robot's other poses. Layout:
//   'R' 'S' | version | dimension | sender | receiver | round | sections, each: kind | bytes | content
// Whole numbers are LEB128, real ones IEEE 754 little endian. What was not written by `encode` is refused.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/graph/distributed/information_code.hpp"
#include "radioslam/graph/distributed/robot_graph.hpp"

namespace radioslam {

inline constexpr std::uint8_t kWireVersion = 1;
/// More in one message is refused, before anything is allocated.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 26U;
/// Robots have numbers below this one: what a message can make its receiver remember has an end.
inline constexpr RobotNumber kMaxRobots = 512;

/// What a section is about; traffic is counted by it.
enum class SectionKind : std::uint8_t { kTopology, kFrames, kPoses, kMatrices, kSteps, kUp, kDown, kStage };
inline constexpr std::size_t kSectionKinds = 8;
std::string_view to_string(SectionKind kind);

/// A robot and those it shares factors with: the team as a graph of robots, without poses or measurements.
struct RobotLinks {
  RobotNumber robot = 0;
  std::uint32_t version = 0;  ///< higher ones replace lower ones
  std::vector<RobotNumber> neighbours;
  bool operator==(const RobotLinks&) const = default;
  bool links_to(RobotNumber other) const {
    return std::find(neighbours.begin(), neighbours.end(), other) != neighbours.end();
  }
};

/// The frame that part of a robot's trajectory is in: that of the origin's part.
struct Frame {
  RobotNumber origin = 0;
  std::uint32_t part = 0;
  std::uint32_t hops = 0;  ///< robots between here and the origin
  bool same(const Frame& other) const { return origin == other.origin && part == other.part; }
  bool before(const Frame& other) const {
    return std::pair(origin, part) < std::pair(other.origin, other.part);
  }
};

/// The poses that a neighbour sees, as they are at the sender.
template <class Pose>
struct SeenPoses {
  /// TeamTree::id: in the team's frame, the poses are what its sweeps begin with. 0: teams do not change.
  std::uint64_t tree = 0;
  std::vector<Frame> frames;           ///< per part of the sender
  std::vector<std::uint32_t> part_of;  ///< per pose seen; empty if the sender is one part
  std::vector<Pose> poses;             ///< per pose seen, in the frame of its part
};

/// Only the robot that a pose belongs to knows who solves for it.
inline constexpr RobotNumber kUnknownRobot = ~RobotNumber{0};

/// A pose whose step a subtree shares with the rest of the team, and the robot that solves for it.
struct SharedPose {
  PoseKey key;
  RobotNumber solved_by = kUnknownRobot;
  bool operator==(const SharedPose&) const = default;
};

/// What is left of a subtree's quadratic when all but the poses it shares are eliminated:
/// step^T information step / 2 + gradient^T step, sums of the whole subtree beside it.
struct Elimination {
  std::uint64_t tree = 0;  ///< TeamTree::id
  std::uint32_t sweep = 0;
  std::vector<SharedPose> shared;               ///< with information only: it stays as it was otherwise
  std::optional<BlockInformation> information;  ///< of their steps, in their order; absent: as last time
  Eigen::VectorXd gradient;
  double cost = 0;                ///< at the values that were linearised
  double predicted_decrease = 0;  ///< by the steps of those eliminated, the shared ones at rest
};

/// What the team does with the sweep that a Solution ends.
enum class SweepEnd : std::uint8_t { kStep, kRestore, kFinish };

/// The steps of the poses that a child shares, in its order, and what comes next.
struct Solution {
  std::uint64_t tree = 0;  ///< TeamTree::id
  std::uint32_t sweep = 0;
  SweepEnd end = SweepEnd::kStep;
  bool relinearise = true;  ///< the next elimination carries its information again
  double damping = 0;       ///< of the next sweep
  double mu = 0;            ///< of graduated optimization; 0: without
  Eigen::VectorXd steps;
};

/// How far the sender is with a computation in stages; see stage_agreement.hpp.
struct StageNews {
  std::uint32_t stage = 0;
  std::uint32_t quiet = 0;  ///< rounds since a robot is known to have been unsettled
  bool moved = false;       ///< some robot is known to have been unsettled since the stage began
  bool finished = false;    ///< after the last stage
  bool operator==(const StageNews&) const = default;
};

template <class Pose>
struct Message {
  RobotNumber from = 0, to = 0;
  std::uint32_t round = 0;
  std::vector<RobotLinks> topology;
  std::optional<SeenPoses<Pose>> seen;
  std::vector<Eigen::Matrix<double, Pose::kDim, Pose::kDim>> matrices;  ///< per pose seen: relaxed rotations
  std::vector<typename Pose::Tangent> steps;                            ///< per pose seen
  std::optional<Elimination> up;
  std::optional<Solution> down;
  std::optional<StageNews> stage;
};

/// Bytes of a message by what they are about; `header` besides.
struct MessageBytes {
  std::size_t header = 0;
  std::array<std::size_t, kSectionKinds> sections{};
};

template <class Pose>
std::string encode(const Message<Pose>& message, MessageBytes* bytes = nullptr);

/// Nothing where the bytes are no message of this version and dimension. Whether its contents fit the
/// receiver's factors is not looked at. Cost: time and memory in proportion to the bytes, whatever they
/// claim.
template <class Pose>
std::optional<Message<Pose>> decode(std::string_view bytes);

}  // namespace radioslam
