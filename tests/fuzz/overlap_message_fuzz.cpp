// Any bytes are a message of a distributed overlap search or none, and no message harms the robot that hears
// it. An input is a sequence of messages to the first of two robots, each its length in two bytes and its
// bytes: the other robot's answers, rightly or wrongly.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/closure/overlap/overlap_party.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPoses = 12;

/// Two robots that drive beside each other, with two links between them.
LinkCovariance<SE2> link_team() {
  KeyframeOdometry<SE2> chain;
  for (std::size_t k = 0; k < kPoses; ++k) chain.poses.push_back(SE2({2.0 * static_cast<double>(k), 0}, 0));
  chain.cov_steps.assign(kPoses - 1, 1e-3 * SE2::Jacobian::Identity());
  const SE2 T_a_b({0, 5}, 0);
  return {{chain, chain},
          {{0, 2, 1, 2, T_a_b, SE2::Jacobian::Identity()}, {0, 9, 1, 9, T_a_b, SE2::Jacobian::Identity()}}};
}

JointCovariance<SE2> joint_team() {
  PoseGraph2 graph;
  std::vector<ChainOfPoses> robots(2);
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t k = 0; k < kPoses; ++k) {
      robots[r].poses.push_back(PoseId(graph.poses.size()));
      graph.poses.push_back(SE2({2.0 * static_cast<double>(k), 5.0 * static_cast<double>(r)}, 0));
      if (k == 0) continue;
      graph.relative_poses.push_back({PoseId(graph.poses.size() - 2), PoseId(graph.poses.size() - 1),
                                      SE2({2, 0}, 0), 1e3 * SE2::Jacobian::Identity()});
    }
  for (const std::size_t k : {2U, 9U})
    graph.relative_poses.push_back({robots[0].poses[k], robots[1].poses[k], SE2({0, 5}, 0)});
  return *JointCovariance<SE2>::compute(graph, robots);
}

template <class Source>
void hear(const Source& source, std::uint32_t robot, std::string_view bytes) {
  const std::uint32_t other = 1 - robot;
  std::vector<std::string> shares(2);
  shares[other] = source.share(robot, other);
  OverlapParty<typename Source::Poses, typename Source::Team> party(robot, source.poses(robot), shares, {10},
                                                                    {});
  (void)party.begin();
  while (bytes.size() > 2) {
    const std::size_t size =
        static_cast<unsigned char>(bytes[0]) + 256U * static_cast<unsigned char>(bytes[1]);
    const std::string_view message = bytes.substr(2, size);
    bytes.remove_prefix(2 + message.size());
    (void)party.hear(message);
  }
  for (const OverlapCandidate& pair : party.found(other).candidates)
    RADIOSLAM_CHECK(pair.pose_a < kPoses, "pairs are of the robot's own poses");
  for (const PairRun& run : party.received(other))
    RADIOSLAM_CHECK(run.end_b <= kPoses, "and so are those received");
}

}  // namespace
}  // namespace radioslam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  static const auto link = link_team();
  static const auto joint = joint_team();
  const std::string bytes(data, data + size);
  for (const std::uint32_t robot : {0U, 1U}) {
    hear(link, robot, bytes);
    hear(joint, robot, bytes);
  }
  return 0;
}
