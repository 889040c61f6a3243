// A team of agents on a bad network (`team`): final error, bytes and delay over loss, the length of a
// partition and the size of the team, beside what simpler ways of sharing would send.
//
// Towns are simulated, without scans. The simpler ways have a perfect network:
//   at one        every robot's log sent once to one of them, which estimates; nothing comes back
//   to all        every robot's log sent once to every other one
//   descriptors   a descriptor of every keyframe, sent to every other robot
//   boxes first   a distributed overlap search (`prune --distributed`), then descriptors of those keyframes
//                 that can overlap with one of the receiver's
// The last two are what place recognition takes; the estimate would come in addition.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// Some forty links a robot, if all are in range, in a town that grows with the team.
struct TeamCase {
  std::size_t robots = 3;
  double path_m = 400;  ///< of each robot, at 4 m/s
  double loss = 0;
  double partition_s = 0;  ///< in the middle of the mission
};

/// Perfect, losses, partitions, both; then teams of 2 to 50, which drive less.
std::vector<TeamCase> team_cases();

/// Bytes are in all, by all robots.
struct TeamSample {
  std::optional<double> run_ate_m;    ///< of the recorded mission, without a network
  std::optional<double> agent_ate_m;  ///< of what the agents have in the end; of the worst of them
  std::optional<double> way_ate_m;    ///< median over agents that estimate and times
  double way_share = 0;               ///< of all records said so far, mean over these
  bool all_know_all = false;
  double settled_s = 0;  ///< after the last record, until nobody lacked one; to a second
  double driven_m = 0;   ///< by all robots
  std::size_t bytes = 0, messages = 0, lost = 0;
  std::size_t bytes_at_one = 0, bytes_to_all = 0, bytes_of_descriptors = 0, bytes_boxes_first = 0;
};

struct TeamStudy {
  std::uint64_t first_seed = 1;
  double descriptor_bytes = 0;  ///< mean, of a street scanned by 16 beams
  std::vector<TeamCase> cases;
  std::vector<std::vector<TeamSample>> samples;  ///< by case, then by seed
};

/// Independent of the number of threads.
TeamStudy study_team(const std::vector<TeamCase>& cases, std::uint64_t first_seed, int seeds,
                     const Progress& progress = {});

StudyTable team_table(const TeamStudy& study);

/// "3 x 400 m, loss 30 %, partition 60 s"
std::string text_of(const TeamCase& of);

}  // namespace radioslam
