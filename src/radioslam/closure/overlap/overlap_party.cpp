#include "radioslam/closure/overlap/overlap_party.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"

namespace radioslam {
namespace {

constexpr std::uint8_t kVersion = 1;

template <class Node, class Record>
void write_box(const Node& node, const std::vector<Record>& records, OverlapFieldWriter& out) {
  visit_node(node, out);
  Record::visit(records[node.middle], out);
}

}  // namespace

std::vector<PairRun> runs_of(const std::vector<OverlapCandidate>& pairs) {
  std::vector<PairRun> runs;
  for (const OverlapCandidate& pair : pairs)
    if (!runs.empty() && runs.back().pose_a == pair.pose_a && runs.back().end_b == pair.pose_b)
      ++runs.back().end_b;
    else
      runs.push_back({pair.pose_a, pair.pose_b, pair.pose_b + 1});
  return runs;
}

template <OverlapPoses Poses, class Team>
OverlapParty<Poses, Team>::OverlapParty(std::uint32_t robot, const Poses& own,
                                        std::vector<std::string> shares, const OverlapSensor& sensor,
                                        const OverlapParams& params)
    : robot_(robot),
      own_(own),
      shares_{std::move(shares), {}},
      sensor_(sensor),
      params_(params),
      tree_(OverlapTreeBuilder<Poses>(own).build()),
      partners_(shares_.own.size()) {
  RADIOSLAM_CHECK(robot < partners_.size(), "the robot is one of the team");
  shares_.own[robot].clear();
  shares_.heard.resize(partners_.size());
  partners_[robot].is_done = true;
}

template <OverlapPoses Poses, class Team>
OverlapMessage OverlapParty<Poses, Team>::message(std::uint32_t to, OverlapMessageKind kind,
                                                  std::string_view content) const {
  WireWriter out;
  out.append("RO");
  for (const std::uint8_t byte :
       {kVersion, static_cast<std::uint8_t>(Pose::kDim), static_cast<std::uint8_t>(kind)})
    out.byte(byte);
  out.whole(robot_);
  out.append(content);
  return {to, kind, out.take()};
}

template <OverlapPoses Poses, class Team>
auto OverlapParty<Poses, Team>::begin() const -> Messages {
  Messages out;
  for (std::uint32_t r = 0; r < robots(); ++r) {
    if (r == robot_) continue;
    OverlapFieldWriter sensor;
    sensor(sensor_.range_m), sensor(sensor_.view_rad);
    const std::string share = Team::is_shared(robot_, r) ? shares_.own[r] : std::string();
    out.push_back(message(r, OverlapMessageKind::kEstimate, sensor.take() + share));
  }
  return out;
}

template <OverlapPoses Poses, class Team>
auto OverlapParty<Poses, Team>::hear(std::string_view bytes) -> std::optional<Messages> {
  WireReader in(bytes);
  const bool is_ours = in.take(2) == "RO" && in.byte() == kVersion && in.byte() == Pose::kDim;
  const std::uint8_t kind = in.byte();
  const std::uint32_t from = in.whole32();
  if (!in.good() || !is_ours || from >= robots() || from == robot_) return std::nullopt;
  const std::string_view content = in.take(in.left());
  bool is_taken = false;
  switch (OverlapMessageKind{kind}) {
    case OverlapMessageKind::kRequest:
      return answer(from, content);
    case OverlapMessageKind::kEstimate:
      is_taken = hear_estimate(from, content);
      break;
    case OverlapMessageKind::kBoxes:
      is_taken = hear_boxes(from, content);
      break;
    case OverlapMessageKind::kPoses:
      is_taken = hear_poses(from, content);
      break;
    case OverlapMessageKind::kPairs:
      is_taken = hear_pairs(from, content);
      break;
  }
  if (!is_taken) return std::nullopt;
  return advance();
}

template <OverlapPoses Poses, class Team>
bool OverlapParty<Poses, Team>::hear_estimate(std::uint32_t from, std::string_view content) {
  Partner& partner = partners_[from];
  WireReader in(content);
  const OverlapSensor sensor{in.f64(), in.f64()};
  const std::string_view share = in.take(in.left());
  if (partner.sensor || !in.good() || !(sensor.range_m >= 0) || !(sensor.view_rad > 0)) return false;
  if (Team::is_shared(from, robot_) ? !Team::accepts(shares_.own[from], share) : !share.empty()) return false;
  partner.sensor = sensor;
  shares_.heard[from] = share;
  for (std::uint32_t r = 0; r < robots(); ++r)
    if (r != robot_ && !partners_[r].sensor) return true;
  team_ = Team::heard(robot_, shares_);
  if (team_) {
    runs_ = team_->runs(robot_, own_);
    std::reverse(runs_.begin(), runs_.end());
    for (std::uint32_t b = robot_ + 1; b < robots(); ++b)
      partners_[b].rule = overlap_rule(params_, sensor_, *partners_[b].sensor);
  } else {
    partner.sensor.reset();
    shares_.heard[from].clear();
  }
  return team_.has_value();
}

template <OverlapPoses Poses, class Team>
auto OverlapParty<Poses, Team>::answer(std::uint32_t a, std::string_view content) const
    -> std::optional<Messages> {
  const auto request = read_request(content);
  const auto is_ours = [&](std::uint32_t box) { return box < tree_.nodes.size(); };
  if (!request || a > robot_ || !std::all_of(request->send.begin(), request->send.end(), is_ours))
    return std::nullopt;
  const auto& records = own_.records();
  OverlapFieldWriter boxes, poses;
  for (const std::uint32_t j : request->send)
    for (std::uint32_t l = tree_.nodes[j].begin; l < tree_.nodes[j].end; ++l)
      if (l != tree_.nodes[j].middle) View::Record::visit(records[l], poses);
  for (const std::uint32_t j : request->open) {
    if (!is_ours(j) || tree_.nodes[j].leaf()) return std::nullopt;
    for (const std::uint32_t half : {j + 1, tree_.nodes[j].right})
      write_box(tree_.nodes[half], records, boxes);
  }
  if (request->is_for_roots()) {
    boxes(static_cast<std::uint32_t>(tree_.roots.size()));
    for (const auto& root : tree_.roots) {
      boxes(root.node), boxes(root.component);
      write_box(tree_.nodes[root.node], records, boxes);
    }
  }
  Messages out;
  if (!request->send.empty()) out.push_back(message(a, OverlapMessageKind::kPoses, poses.take()));
  if (request->send.empty() || !request->open.empty())
    out.push_back(message(a, OverlapMessageKind::kBoxes, boxes.take()));
  return out;
}

template <OverlapPoses Poses, class Team>
auto OverlapParty<Poses, Team>::search(std::uint32_t b) -> Search {
  Partner& of_b = partners_[b];
  return {*of_b.view, of_b.rule, {robot_, b}, tree_of_run_, own_.records(), of_b.boxes};
}

template <OverlapPoses Poses, class Team>
bool OverlapParty<Poses, Team>::hear_boxes(std::uint32_t b, std::string_view content) {
  Partner& of_b = partners_[b];
  if (!of_b.view || !of_b.boxes.is_asking()) return false;
  const bool were_roots = of_b.boxes.asks_roots();
  typename RemoteBoxes<View>::Waitings opened;
  if (!of_b.boxes.receive_boxes(content, *of_b.view, opened)) return false;
  const Search through = search(b);
  if (were_roots) through.visit_roots(of_b.found);
  for (const auto& [j, waiting] : opened)
    for (const auto& box : waiting) through.visit_halves(box.node_a, j, box.ties, of_b.found);
  return true;
}

template <OverlapPoses Poses, class Team>
bool OverlapParty<Poses, Team>::hear_poses(std::uint32_t b, std::string_view content) {
  Partner& of_b = partners_[b];
  if (!of_b.view) return false;
  typename RemoteBoxes<View>::Waitings sent;
  if (!of_b.boxes.receive_poses(content, *of_b.view, sent)) return false;
  const Search through = search(b);
  for (const auto& [j, waiting] : sent)
    for (const auto& box : waiting) through.compare_all(box.node_a, j, box.ties, of_b.found);
  return true;
}

template <OverlapPoses Poses, class Team>
void OverlapParty<Poses, Team>::start_run(const PoseInterval& run) {
  tree_of_run_ = OverlapTreeBuilder<Poses>(own_).build(run);
  const auto columns = team_->columns(robot_, own_, run);
  for (std::uint32_t b = robot_ + 1; b < robots(); ++b) {
    Partner& of_b = partners_[b];
    of_b.view.emplace(team_->view(robot_, b, columns));
    if (of_b.boxes.has_roots()) search(b).visit_roots(of_b.found);
  }
}

template <OverlapPoses Poses, class Team>
auto OverlapParty<Poses, Team>::advance() -> Messages {
  Messages out;
  if (!team_ || has_sent_pairs_) return out;
  for (;;) {
    bool waits = false;
    for (std::uint32_t b = robot_ + 1; b < robots(); ++b) {
      Partner& of_b = partners_[b];
      if (of_b.view && of_b.view->ties() > 0 && !of_b.boxes.is_asking())
        if (const auto request = of_b.boxes.request())
          out.push_back(message(b, OverlapMessageKind::kRequest, write_request(*request)));
      waits = waits || of_b.boxes.is_asking();
    }
    if (waits) return out;
    if (runs_.empty()) break;
    start_run(runs_.back());
    runs_.pop_back();
  }
  finish(out);
  return out;
}

template <OverlapPoses Poses, class Team>
void OverlapParty<Poses, Team>::finish(Messages& out) {
  has_sent_pairs_ = true;
  for (std::uint32_t b = robot_ + 1; b < robots(); ++b) {
    OverlapCandidates& found = partners_[b].found;
    sort_by_poses(found.candidates);
    const std::vector<PairRun> runs = runs_of(found.candidates);
    OverlapFieldWriter pairs;
    pairs(static_cast<std::uint32_t>(runs.size()));
    std::uint32_t last = 0;
    for (const PairRun& run : runs) {
      pairs(run.pose_a - std::exchange(last, run.pose_a));
      pairs(run.begin_b);
      pairs(run.end_b - run.begin_b);
    }
    out.push_back(message(b, OverlapMessageKind::kPairs, pairs.take()));
    partners_[b].is_done = true;
  }
}

template <OverlapPoses Poses, class Team>
bool OverlapParty<Poses, Team>::hear_pairs(std::uint32_t a, std::string_view content) {
  if (a > robot_ || partners_[a].is_done) return false;
  OverlapFieldReader in(content);
  std::vector<PairRun> runs;
  std::uint32_t last = 0;
  for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
    last += in.number();
    const std::uint32_t begin = in.number(), size = in.number();
    in.refuse_unless(begin < own_.records().size() && size <= own_.records().size() - begin);
    runs.push_back({last, begin, begin + size});
  }
  if (!in.is_complete()) return false;
  partners_[a].received = std::move(runs);
  partners_[a].is_done = true;
  return true;
}

template <OverlapPoses Poses, class Team>
bool OverlapParty<Poses, Team>::is_finished() const {
  return std::all_of(partners_.begin(), partners_.end(), [](const Partner& p) { return p.is_done; });
}

template class OverlapParty<LinkPoses<SE2>, LinkTeam<SE2>>;
template class OverlapParty<LinkPoses<SE3>, LinkTeam<SE3>>;
template class OverlapParty<JointPoses<SE2>, JointTeam<SE2>>;
template class OverlapParty<JointPoses<SE3>, JointTeam<SE3>>;

}  // namespace radioslam
