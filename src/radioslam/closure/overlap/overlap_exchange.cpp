#include "radioslam/closure/overlap/overlap_exchange.hpp"

#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"

namespace radioslam {
namespace {

template <class Record>
void write_record(const Record& record, OverlapFieldWriter& out) {
  Record::visit(record, out);
}

template <class Node, class Record>
void write_summary(const Node& node, const Record& middle, OverlapFieldWriter& out) {
  visit_node(node, out);
  write_record(middle, out);
}

template <class Record>
Record read_record(OverlapFieldReader& in) {
  Record record;
  Record::visit(record, in);
  return record;
}

/// A request's two lists of nodes: to open, and to send the poses of.
struct Request {
  std::vector<std::uint32_t> open, send;
};

/// Each box at most once, and poses of boxes that have none in common: an answer is never longer than the
/// tree.
template <class Pose>
Request read_request(const OverlapMessage& message, const OverlapTree<Pose>& tree) {
  OverlapFieldReader in(message);
  Request request;
  for (auto* list : {&request.open, &request.send})
    for (std::uint32_t n = in.number(); n > 0; --n) {
      const std::uint32_t box = in.number();
      expect_well_formed(box < tree.nodes.size() && (list->empty() || list->back() < box));
      list->push_back(box);
    }
  expect_well_formed(in.at_end());
  for (std::size_t k = 1; k < request.send.size(); ++k)
    expect_well_formed(tree.nodes[request.send[k - 1]].end <= tree.nodes[request.send[k]].begin);
  return request;
}

/// A box of poses from `begin` on.
template <class Node>
void expect_box(const Node& node, std::uint32_t number, std::uint32_t begin) {
  expect_well_formed(node.begin >= begin && node.end > node.begin &&
                     node.middle == node.begin + node.size() / 2 &&
                     (node.leaf() || (node.right > number + 1 && node.size() > 1)));
}

}  // namespace

template <OverlapSource Source>
OverlapMessage OverlapServer<Source>::hello() const {
  OverlapFieldWriter out;
  out(static_cast<std::uint32_t>(tree_.roots.size()));
  for (const auto& [root, piece] : tree_.roots) {
    out(root);
    write_summary(tree_.nodes[root], records_[tree_.nodes[root].middle], out);
  }
  return out.take();
}

template <OverlapSource Source>
OverlapMessage OverlapServer<Source>::answer(const OverlapMessage& message) const {
  const Request request = read_request(message, tree_);
  OverlapFieldWriter out;
  for (const std::uint32_t j : request.send)
    for (std::uint32_t l = tree_.nodes[j].begin; l < tree_.nodes[j].end; ++l) write_record(records_[l], out);
  for (const std::uint32_t j : request.open) {
    expect_well_formed(!tree_.nodes[j].leaf());
    for (const std::uint32_t half : {j + 1, tree_.nodes[j].right})
      write_summary(tree_.nodes[half], records_[tree_.nodes[half].middle], out);
  }
  return out.take();
}

template <OverlapSource Source>
OverlapMessage OverlapServer<Source>::everything() const {
  OverlapFieldWriter out;
  out(static_cast<std::uint32_t>(records_.size()));
  for (const auto& record : records_) write_record(record, out);
  return out.take();
}

template <OverlapSource Source>
OverlapClient<Source>::OverlapClient(const Source& source, std::uint32_t a, std::uint32_t b,
                                     const OverlapRule& rule)
    : source_(source),
      a_(a),
      b_(b),
      view_(source.view(a, b)),
      test_(view_, rule),
      tree_(OverlapTreeBuilder<Source>(source, a).build()) {}

template <OverlapSource Source>
void OverlapClient<Source>::receive_hello(const OverlapMessage& hello) {
  OverlapFieldReader in(hello);
  std::vector<Bound> ties(view_.ties());
  for (std::size_t t = 0; t < ties.size(); ++t) ties[t].tie = static_cast<std::uint32_t>(t);
  const std::uint32_t roots = in.number();
  expect_well_formed(roots <= source_.pieces(b_).size());
  std::uint32_t begin = 0;
  for (std::uint32_t q = 0; q < roots; ++q) {
    const std::uint32_t j = in.number();
    begin = read_summary(j, begin, in).node.end;
    for (const auto& [root, piece] : tree_.roots)
      if (!ties.empty() && source_.joined(a_, piece, b_, q)) visit_boxes(root, j, ties);
  }
  expect_well_formed(in.at_end());
}

/// Of a box that is new, of poses from `begin` on.
template <OverlapSource Source>
auto OverlapClient<Source>::read_summary(std::uint32_t j, std::uint32_t begin, OverlapFieldReader& in)
    -> const Summary& {
  expect_well_formed(!summaries_.contains(j));
  Summary& summary = summaries_[j];
  visit_node(summary.node, in);
  summary.middle = read_record<Record>(in);
  expect_box(summary.node, j, begin);
  return summary;
}

/// Splits a's box where that is the next step; boxes that need b's halves or poses are queued for a request.
template <OverlapSource Source>
void OverlapClient<Source>::visit_boxes(std::uint32_t i, std::uint32_t j, std::span<const Bound> from) {
  const Node& I = tree_.nodes[i];
  const Summary& J = summaries_[j];
  std::vector<Bound> ties;
  const BoxStatus status =
      test_.box({I, source_.records(a_)[I.middle]}, {J.node, J.middle}, from, ties, found_.counts);
  if (status == BoxStatus::kSplitA) {
    visit_boxes(i + 1, j, ties);
    visit_boxes(I.right, j, ties);
  } else if (status == BoxStatus::kSplitB) {
    to_open_[j].push_back({i, std::move(ties)});
  } else if (status != BoxStatus::kOutside) {
    if (knows_poses(J.node))
      compare({i, std::move(ties)}, J.node);
    else
      to_send_[j].push_back({i, std::move(ties)});
  }
}

template <OverlapSource Source>
OverlapMessage OverlapClient<Source>::request() {
  if (to_open_.empty() && to_send_.empty()) return {};
  asked_open_ = std::exchange(to_open_, {});
  asked_send_ = std::exchange(to_send_, {});
  OverlapFieldWriter out;
  for (const auto* asked : {&asked_open_, &asked_send_}) {
    out(static_cast<std::uint32_t>(asked->size()));
    for (const auto& [j, _] : *asked) out(j);
  }
  return out.take();
}

template <OverlapSource Source>
void OverlapClient<Source>::receive_answer(const OverlapMessage& answer) {
  OverlapFieldReader in(answer);
  for (const auto& [j, boxes] : asked_send_) {
    const Node& J = summaries_[j].node;
    for (std::uint32_t l = J.begin; l < J.end; ++l) poses_[l] = read_record<Record>(in);
    for (const Waiting& box : boxes) compare(box, J);
  }
  for (const auto& [j, boxes] : asked_open_) {
    const Node J = summaries_.at(j).node;
    std::uint32_t begin = J.begin;
    for (const std::uint32_t half : {j + 1, J.right}) {
      const Node& H = read_summary(half, begin, in).node;
      expect_well_formed(H.begin == begin && H.end == (half == J.right ? J.end : J.middle));
      begin = H.end;
      for (const Waiting& box : boxes) visit_boxes(box.node_a, half, box.ties);
    }
  }
  expect_well_formed(in.at_end());
}

/// Before a box is visited only enclosing boxes can have been sent, so all of its poses are known or none.
template <OverlapSource Source>
bool OverlapClient<Source>::knows_poses(const Node& J) const {
  return poses_.contains(J.begin);
}

template <OverlapSource Source>
void OverlapClient<Source>::compare(const Waiting& box, const Node& J) {
  const Node& I = tree_.nodes[box.node_a];
  const auto& own = source_.records(a_);
  for (std::uint32_t k = I.begin; k < I.end; ++k)
    for (std::uint32_t l = J.begin; l < J.end; ++l)
      test_.compare({a_, b_, k, l}, own[k], poses_.at(l), box.ties, found_);
}

template <OverlapSource Source>
OverlapCandidates OverlapClient<Source>::result() const {
  OverlapCandidates ordered = found_;
  std::sort(ordered.candidates.begin(), ordered.candidates.end(), [](const auto& x, const auto& y) {
    return std::pair(x.pose_a, x.pose_b) < std::pair(y.pose_a, y.pose_b);
  });
  return ordered;
}

template <OverlapSource Source>
OverlapMessage OverlapClient<Source>::final_message() const {
  OverlapFieldWriter out;
  const auto all = result();
  out(static_cast<std::uint32_t>(all.candidates.size()));
  for (const auto& c : all.candidates) out(c.pose_a), out(c.pose_b), out(c.distance_m), out(c.mahalanobis);
  return out.take();
}

template <OverlapSource Source>
OverlapExchange exchange_overlaps(const Source& source, std::uint32_t a, std::uint32_t b,
                                  const std::vector<OverlapSensor>& sensors, const OverlapParams& params) {
  RADIOSLAM_CHECK(a < b && sensors.size() == source.robots(), "every robot has a sensor, a is listed first");
  const OverlapServer<Source> server(source, b);
  OverlapClient<Source> client(source, a, b, overlap_rule(params, sensors[a], sensors[b]));
  ExchangeCost cost;
  OverlapMessage message = server.hello();
  cost.answers = message.size();
  client.receive_hello(message);
  for (message = client.request(); !message.empty(); message = client.request(), ++cost.rounds) {
    cost.requests += message.size();
    message = server.answer(message);
    cost.answers += message.size();
    client.receive_answer(message);
  }
  cost.final_message = client.final_message().size();
  cost.all_poses = server.everything().size();
  OverlapExchange exchange{client.result(), cost};
  exchange.found.counts.pairs = std::uint64_t{source.records(a).size()} * source.records(b).size();
  return exchange;
}

#define RADIOSLAM_OVERLAP_EXCHANGE(Source)                                                \
  template class OverlapServer<Source>;                                                   \
  template class OverlapClient<Source>;                                                   \
  template OverlapExchange exchange_overlaps(const Source&, std::uint32_t, std::uint32_t, \
                                             const std::vector<OverlapSensor>&, const OverlapParams&)
RADIOSLAM_OVERLAP_EXCHANGE(LinkCovariance<SE2>);
RADIOSLAM_OVERLAP_EXCHANGE(LinkCovariance<SE3>);
RADIOSLAM_OVERLAP_EXCHANGE(JointCovariance<SE2>);
RADIOSLAM_OVERLAP_EXCHANGE(JointCovariance<SE3>);

}  // namespace radioslam
