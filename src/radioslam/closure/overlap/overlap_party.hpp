// One robot of a distributed overlap search. It holds its own poses only; of the others it learns what they
// send it. Of two robots, a listed before b:
//
//   estimate   each -> each other   its sensor, and its share of the team's estimate, without which poses
//                                   cannot be compared: skeleton_message.hpp, or b's ends of radio links
//   request    a -> b               which of b's boxes to open, and of which to send the poses
//   boxes, poses   b -> a           the answers (overlap_remote_boxes.hpp)
//   pairs      a -> b               the pairs kept, when there is nothing left to ask: of each pose of a the
//                                   runs of b's poses
//
// a runs the central search (overlap_box_search.hpp) on the same numbers, so the pairs are the same to the
// last bit. Of a's poses none is sent. A message is
//   'R' 'O' | version | dimension | kind | sender | content
// with whole numbers in base 128 and 64-bit reals (base/wire.hpp). Any bytes are taken or refused, at a cost
// in proportion to their number besides the search itself; what is refused changes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/closure/overlap/overlap_box_search.hpp"
#include "radioslam/closure/overlap/overlap_remote_boxes.hpp"

namespace radioslam {

enum class OverlapMessageKind : std::uint8_t { kEstimate, kRequest, kBoxes, kPoses, kPairs };
inline constexpr std::array<const char*, 5> kOverlapMessageKinds{"estimate", "requests", "boxes", "poses",
                                                                 "pairs"};

/// The pairs of pose_a of a with the poses [begin_b, end_b) of b.
struct PairRun {
  std::uint32_t pose_a = 0, begin_b = 0, end_b = 0;
  bool operator==(const PairRun&) const = default;
};
/// Of two robots' pairs, sorted by poses.
std::vector<PairRun> runs_of(const std::vector<OverlapCandidate>& pairs);

/// A message on its way.
struct OverlapMessage {
  std::uint32_t to = 0;
  OverlapMessageKind kind = OverlapMessageKind::kEstimate;
  std::string bytes;
};

template <OverlapPoses Poses, class Team>
class OverlapParty {
 public:
  using View = typename Poses::View;
  using Pose = typename View::Pose;
  using Messages = std::vector<OverlapMessage>;

  /// `shares`: what it knows of its relation to each robot of the team; its own is not used. Refers to the
  /// poses.
  OverlapParty(std::uint32_t robot, const Poses& own, std::vector<std::string> shares,
               const OverlapSensor& sensor, const OverlapParams& params);

  /// What it says first.
  Messages begin() const;
  /// What it answers to any bytes; nothing if they are refused.
  std::optional<Messages> hear(std::string_view bytes);

  /// Whether it knows its pairs with all other robots.
  bool is_finished() const;
  /// Pairs with a robot listed later, by poses, and what it took to find them.
  const OverlapCandidates& found(std::uint32_t b) const { return partners_[b].found; }
  /// Pairs with a robot listed before, as it sent them.
  const std::vector<PairRun>& received(std::uint32_t a) const { return partners_[a].received; }

 private:
  using Search = OverlapBoxSearch<View, RemoteBoxes<View>>;
  struct Partner {
    std::optional<OverlapSensor> sensor;  ///< once its estimate has come
    OverlapRule rule;
    std::optional<View> view;  ///< of the present run; of a robot listed later
    RemoteBoxes<View> boxes;
    OverlapCandidates found;
    std::vector<PairRun> received;
    bool is_done = false;
  };

  std::uint32_t robots() const { return static_cast<std::uint32_t>(partners_.size()); }
  OverlapMessage message(std::uint32_t to, OverlapMessageKind kind, std::string_view content) const;
  Search search(std::uint32_t b);

  bool hear_estimate(std::uint32_t from, std::string_view content);
  std::optional<Messages> answer(std::uint32_t a, std::string_view content) const;
  bool hear_boxes(std::uint32_t b, std::string_view content);
  bool hear_poses(std::uint32_t b, std::string_view content);
  bool hear_pairs(std::uint32_t a, std::string_view content);

  /// Asks what is to be asked next; at the end of the last run, sends the pairs.
  Messages advance();
  void start_run(const PoseInterval& run);
  void finish(Messages& out);

  std::uint32_t robot_;
  const Poses& own_;
  OverlapShares shares_;
  OverlapSensor sensor_;
  OverlapParams params_;
  OverlapTree<Pose> tree_;  ///< of all own poses, for the others
  OverlapTree<Pose> tree_of_run_;
  std::optional<Team> team_;        ///< once all have sent their estimate
  std::vector<PoseInterval> runs_;  ///< of own poses that are still to be searched, the next one last
  std::vector<Partner> partners_;   ///< per robot
  bool has_sent_pairs_ = false;     ///< whether the pairs were
};

}  // namespace radioslam
