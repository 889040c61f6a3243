// Another robot's boxes and poses, as far as it has sent them: what a search through its tree
// (overlap_box_search.hpp) has to wait for is collected, requested, and taken up again when it has come.
//
//   a -> b   request: boxes to open, then boxes to send the poses of; none of either: the roots
//   b -> a   boxes: of the roots, or of both halves of each opened box
//            poses: of each box of the second list, all but the middle one, which came with the box
//
// A box is opened only if it may overlap a box of a's, and once. Any bytes are taken or refused as a whole,
// at a cost in proportion to their number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/closure/overlap/overlap_bounds.hpp"
#include "radioslam/closure/overlap/overlap_fields.hpp"

namespace radioslam {

/// All fields of a box but its middle pose's record: halves are named after their box, and the middle is in
/// the middle.
template <class Node, class Visitor>
void visit_node(Node& node, Visitor&& visit) {
  visit(node.begin), visit(node.end), visit(node.right);
  visit(node.centre_m), visit(node.half_extent_m), visit(node.radius_m);
  visit(node.spread.sigma_m), visit(node.spread.sigma_rad), visit(node.heading_spread_rad);
  visit(node.min_travelled_m), visit(node.max_travelled_m);
}

/// What a robot asks of another one's tree.
struct BoxRequest {
  std::vector<std::uint32_t> open, send;  ///< increasing; neither: the roots
  bool is_for_roots() const { return open.empty() && send.empty(); }
};
std::string write_request(const BoxRequest& request);
/// Nothing unless these are all the bytes of a request with each box at most once.
std::optional<BoxRequest> read_request(std::string_view bytes);

/// Box `j` of poses from `begin` on, as `visit_node` and its middle's record.
template <class Node>
bool is_box(const Node& node, std::uint32_t j, std::uint32_t begin) {
  return node.begin >= begin && node.end > node.begin &&
         (node.leaf() || (node.right > j + 1 && node.size() > 1));
}

template <OverlapView View>
class RemoteBoxes {
 public:
  using Pose = typename View::Pose;
  using Record = typename View::Record;
  using Node = OverlapNode<Pose>;
  using Bound = LinkBound<Pose>;
  using Root = typename OverlapTree<Pose>::Root;
  /// A box of a that waits for what is inside a box of b.
  struct Waiting {
    std::uint32_t node_a;
    std::vector<Bound> ties;
  };
  using Waitings = std::map<std::uint32_t, std::vector<Waiting>>;  ///< by b's box

  // For the search.
  const std::vector<Root>& roots() const { return roots_; }
  const Node& node(std::uint32_t j) const { return boxes_.at(j).node; }
  const Record& middle(std::uint32_t j) const { return boxes_.at(j).middle; }
  const Record& record(std::uint32_t l) const { return poses_.at(l); }
  bool has_halves(std::uint32_t i, std::uint32_t j, std::span<const Bound> ties) {
    const Node& whole = node(j);
    const bool is_known =
        is_box_of(j + 1, whole.begin, whole.middle) && is_box_of(whole.right, whole.middle, whole.end);
    if (!is_known) to_open_[j].push_back({i, {ties.begin(), ties.end()}});
    return is_known;
  }
  bool has_poses(std::uint32_t i, std::uint32_t j, std::span<const Bound> ties) {
    const auto first = poses_.lower_bound(node(j).begin), last = poses_.lower_bound(node(j).end);
    const bool is_known = std::distance(first, last) == std::ptrdiff_t{node(j).size()};
    if (!is_known) to_send_[j].push_back({i, {ties.begin(), ties.end()}});
    return is_known;
  }

  /// What is asked next: what the search waits for, at first the roots. Nothing if it waits for nothing.
  std::optional<BoxRequest> request();
  /// Whether an answer has not come yet.
  bool is_asking() const { return asks_roots_ || !asked_open_.empty() || !asked_send_.empty(); }

  bool asks_roots() const { return asks_roots_; }
  bool has_roots() const { return has_roots_; }

  /// Boxes asked for; refused if false. `opened`: what waited for halves.
  bool receive_boxes(std::string_view content, const View& view, Waitings& opened);
  /// Poses asked for; `sent`: what waited for them.
  bool receive_poses(std::string_view content, const View& view, Waitings& sent);

 private:
  struct Box {
    Node node;
    Record middle;
  };

  /// Whether box j is known and is that of these poses; its number alone may be another root's.
  bool is_box_of(std::uint32_t j, std::uint32_t begin, std::uint32_t end) const {
    const auto box = boxes_.find(j);
    return box != boxes_.end() && box->second.node.begin == begin && box->second.node.end == end;
  }

  /// Refused unless it is a new box of poses from `begin` on.
  Box read_box(std::uint32_t j, std::uint32_t begin, const View& view, OverlapFieldReader& in) const;
  bool receive_roots(OverlapFieldReader& in, const View& view);

  std::vector<Root> roots_;
  std::map<std::uint32_t, Box> boxes_;     ///< of b's nodes
  std::map<std::uint32_t, Record> poses_;  ///< of b
  Waitings to_open_, to_send_, asked_open_, asked_send_;
  bool has_roots_ = false, asks_roots_ = false;
};

}  // namespace radioslam
