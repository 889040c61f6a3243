#include <memory>
#include <string>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/distributed/alternating.hpp"
#include "radioslam/graph/distributed/block_coordinate.hpp"
#include "radioslam/graph/distributed/separators.hpp"
#include "radioslam/graph/distributed/two_stage.hpp"

namespace radioslam {
namespace {

/// Two robots of three poses each, with a factor between every pair.
template <class Pose>
RobotGraph<Pose> first_robot() {
  PoseGraph<Pose> graph;
  graph.poses.resize(6);
  const auto measure = [&](std::size_t i, std::size_t j) {
    auto& factor = graph.relative_poses.emplace_back();
    factor.i = PoseId(i);
    factor.j = PoseId(j);
    factor.T_i_j = Pose::exp(Pose::Tangent::Unit(0));
  };
  for (const std::size_t i : {0U, 1U, 3U, 4U}) measure(i, i + 1);
  for (const std::size_t i : {0U, 1U, 2U}) measure(i, i + 3);
  return split_by_robot(graph, team_poses({0, 0, 0, 1, 1, 1}, 2))[0];
}

template <class Pose>
void hear(const Message<Pose>& message) {
  static const RobotGraph<Pose> robot = first_robot<Pose>();
  SeparatorsParams repeating;
  repeating.repeat_after = 1;
  repeating.outliers.gate = 28;
  std::vector<std::unique_ptr<DistributedSolver<Pose>>> solvers;
  solvers.push_back(std::make_unique<SeparatorsSolver<Pose>>(robot, SeparatorsParams{}));
  solvers.push_back(std::make_unique<SeparatorsSolver<Pose>>(robot, repeating));
  solvers.push_back(std::make_unique<BlockCoordinateSolver<Pose>>(robot, BlockCoordinateParams{}));
  solvers.push_back(std::make_unique<TwoStageSolver<Pose>>(robot, TwoStageParams{}));
  solvers.push_back(std::make_unique<AlternatingSolver<Pose>>(robot, AlternatingParams{}));
  for (const auto& solver : solvers)
    for (int round = 0; round < 3; ++round)
      for (const auto& answer : solver->round({message}))
        RADIOSLAM_CHECK(answer.to == 1, "a robot speaks to those it shares factors with");
}

template <class Pose>
void read(std::string_view bytes) {
  const auto message = decode<Pose>(bytes);
  if (!message) return;
  RADIOSLAM_CHECK(decode<Pose>(encode(*message)).has_value(), "what was read can be written and read");
  hear(*message);
}

}  // namespace
}  // namespace radioslam

/// Any bytes are a message or none, and no message harms the robot that hears it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(data, data + size);
  radioslam::read<radioslam::SE2>(bytes);
  radioslam::read<radioslam::SE3>(bytes);
  return 0;
}
