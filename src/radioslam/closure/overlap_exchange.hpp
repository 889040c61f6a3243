// The overlap search between two robots that each hold their own poses only. Both know the alignment (the
// links, or the skeleton's covariances between the two) and each other's sensor. Robot a asks, robot b
// answers:
//
//   a -> b   which of b's boxes to open, and of which to send the poses
//   b -> a   per box of the second list the records of its poses, per opened one the summaries of its halves
//   ...      a box is opened only where it meets a box of a's; until nothing is left to ask
//   a -> b   the pairs kept
//
// a never sends a pose of its own, and every box and pose of b's is sent at most once. a runs the same tests
// on the same numbers as the central search, so the result is the same to the last bit. Encoding: little
// endian; counts, pose and node numbers uint32; everything else IEEE doubles as they are, of symmetric
// matrices the lower triangle. A message that is not well-formed throws std::invalid_argument.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "radioslam/closure/overlap_judge.hpp"

namespace radioslam {

using OverlapMessage = std::vector<std::byte>;

/// Robot b's side.
template <OverlapSource Source>
class OverlapAnswerer {
 public:
  using Pose = typename Source::View::Pose;

  OverlapAnswerer(const Source& source, std::size_t robot)
      : records_(source.records(robot)), tree_(OverlapTreeBuilder<Source>(source, robot).build()) {}

  /// The summaries of its pieces.
  OverlapMessage greeting() const;
  OverlapMessage answer(const OverlapMessage& request) const;
  /// What it would take to send every pose at once.
  OverlapMessage everything() const;

 private:
  const std::vector<typename Source::View::Record>& records_;
  OverlapTree<Pose> tree_;
};

/// Robot a's side.
template <OverlapSource Source>
class OverlapAsker {
 public:
  using View = typename Source::View;
  using Pose = typename View::Pose;
  using Record = typename View::Record;

  /// Of `source` it reads robot a's poses, the view, and which pieces are tied.
  OverlapAsker(const Source& source, std::uint32_t a, std::uint32_t b, const OverlapRule& rule);

  void take_greeting(const OverlapMessage& greeting);
  /// Empty when there is nothing left to ask.
  OverlapMessage request();
  void take_answer(const OverlapMessage& answer);

  /// Ordered by poses; and as the message that tells b.
  OverlapCandidates result() const;
  OverlapMessage farewell() const;

 private:
  using Judge = OverlapJudge<View>;
  using Bound = TieBound<Pose>;
  using Node = OverlapNode<Pose>;
  struct Summary {
    Node node;
    Record middle;
  };
  /// A box of a's that waits for what b says about one of its own.
  struct Waiting {
    std::uint32_t node_a;
    std::vector<Bound> ties;
  };

  void meet(std::uint32_t i, std::uint32_t j, std::span<const Bound> from);
  bool knows_poses(const Node& J) const;
  void compare(const Waiting& box, const Node& J);

  const Source& source_;
  std::uint32_t a_, b_;
  View view_;
  Judge judge_;
  OverlapTree<Pose> tree_;
  std::map<std::uint32_t, Summary> summaries_;  ///< of b's nodes
  std::map<std::uint32_t, Record> poses_;       ///< of b's that were sent
  std::map<std::uint32_t, std::vector<Waiting>> to_open_, to_send_, asked_open_, asked_send_;
  OverlapCandidates found_;
};

/// What an exchange cost, in bytes.
struct ExchangeCost {
  std::uint64_t requests = 0, answers = 0, farewell = 0;
  std::uint64_t all_poses = 0;  ///< instead of requests and answers
  int rounds = 0;
};

struct OverlapExchange {
  OverlapCandidates found;
  ExchangeCost cost;
};

/// Both sides at once, for robots a < b: what search_overlaps finds between them, and what it costs.
template <OverlapSource Source>
OverlapExchange exchange_overlaps(const Source& source, std::uint32_t a, std::uint32_t b,
                                  const std::vector<OverlapSensor>& sensors, const OverlapParams& params);

}  // namespace radioslam
