// How the robots of a team go from one stage of a computation to the next without a centre.
//
// A robot is unsettled in a round when its last move in the stage was not small, when it has not moved in the
// stage yet, or when a neighbour is not known to be in the stage. It passes on
//   quiet = 0 while it is unsettled, else 1 + the least of its own and its neighbours' last quiet:
// the rounds since anybody was last unsettled, as far as it knows. A robot whose quiet reaches
// `rounds_at_rest` knows that all robots were at rest together during rounds_at_rest - diameter rounds, and
// enters the next stage; others do when a neighbour has. So neighbours are at most one stage apart, and as
// nobody moves before all neighbours are in the stage, values of different stages never meet.
//
// `moved` spreads the same way: that somebody has moved more than little since the stage began.
// A round in which a neighbour is not heard counts as unsettled: where messages get lost, stages last longer,
// and a large team does not finish.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

/// What a robot did in a round.
enum class Activity {
  kWaited,  ///< it was not its turn, or not all neighbours are in the stage
  kRested,  ///< its move was as small as at the end of the last stage
  kSlowed,  ///< its move was small enough for this stage
  kMoved,
};

/// What comes after a stage.
enum class StageEnd { kNext, kFinish };

class StageAgreement {
 public:
  explicit StageAgreement(const std::vector<RobotNumber>& neighbours);

  /// A neighbour's news; once per message of a round. False where no neighbour can be so far.
  bool hear(RobotNumber from, const StageNews& news);
  /// How a neighbour has ended the stage, if one has.
  std::optional<StageEnd> heard_end() const;
  /// Whether all neighbours have entered the stage.
  bool together() const;
  /// Ends the round's hearing: whether the team has been at rest for `rounds_at_rest` rounds.
  bool count(Activity activity, std::uint32_t rounds_at_rest);
  void end(StageEnd end);

  std::uint32_t stage() const { return news_.stage; }
  bool moved() const { return news_.moved; }
  bool finished() const { return news_.finished; }
  /// What is sent to neighbours.
  const StageNews& news() const { return news_; }

 private:
  struct Heard {
    std::optional<StageNews> last;
    bool this_round = false;
  };
  StageNews news_;
  bool at_rest_ = false;
  std::map<RobotNumber, Heard> neighbours_;
};

}  // namespace radioslam
