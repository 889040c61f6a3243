#include "radioslam/joint/places/place_recognition.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/places/loops/loop_verification.hpp"

namespace radioslam {
namespace {

constexpr double kApart_m = 2;  // between scans of a submap in space, each of which shows most of it
constexpr double kSamePose_m = 0.1, kSamePose_rad = 0.05;

VerifiedClosure closure_of(const Proposal& proposal, const ScanLoop& loop, const ScannedRobot& a,
                           const ScannedRobot& b) {
  return closure_of_scan(RobotIndex(proposal.a), a.scans->keyframe_stamps[proposal.i], RobotIndex(proposal.b),
                         b.scans->keyframe_stamps[proposal.j], loop);
}

/// Several alignments may lead a pair to one and the same pose.
void reject_repetitions(const std::vector<Proposal>& proposals, std::vector<VerifiedClosure>& closures) {
  std::map<std::array<std::size_t, 4>, std::vector<std::size_t>> of_pair;
  for (std::size_t k = 0; k < proposals.size(); ++k) {
    auto& [closure, judgement] = closures[k];
    if (judgement.status != ClosureStatus::kAccepted) continue;
    const Proposal& pair = proposals[k];
    auto& others = of_pair[{pair.a, pair.b, pair.i, pair.j}];
    const auto is_same = [&, &T_i_j = closure.T_i_j](std::size_t other) {
      const SE3::Tangent off = (closures[other].closure.T_i_j.inverse() * T_i_j).log();
      return off.head<3>().norm() < kSamePose_m && off.tail<3>().norm() < kSamePose_rad;
    };
    if (std::any_of(others.begin(), others.end(), is_same)) reject(judgement, "measured before");
    others.push_back(k);
  }
}

}  // namespace

std::optional<VerificationBudget> budget_of_round(const PlaceParams& places,
                                                  std::optional<VerificationBudget> given, std::size_t robots,
                                                  int round, std::size_t done) {
  constexpr int kBudgetedRounds = 2, kMaxDoublings = 30;
  if (given) {
    const auto rounds =
        static_cast<std::size_t>(std::max(1, std::min(places.rounds, kBudgetedRounds) - round));
    given->registrations = (given->registrations - done + rounds - 1) / rounds;
  } else if (places.least_worth > 0) {
    const auto first = static_cast<std::size_t>(places.first_round) * (robots * (robots - 1) / 2);
    given = VerificationBudget{first << std::min(round, kMaxDoublings), VerificationBudget::Order::kWorth,
                               places.least_worth, true};
  }
  return given;
}

bool has_comparable_scans(const MeasuredScans& scans) {
  int spatial = 0, planar = 0;
  for (const auto& robot : scans.robots)
    if (robot && !robot->keyframes.poses.empty())
      ++(robot->keyframes.kind == ScannerKind::kPlanar ? planar : spatial);
  return spatial > 1 || planar > 1;
}

void RecognisedPlaces::append(RecognisedPlaces more) {
  closures.insert(closures.end(), more.closures.begin(), more.closures.end());
  attempts.insert(attempts.end(), more.attempts.begin(), more.attempts.end());
  exchange = std::move(more.exchange);
  counts.bytes = exchange.sent();
  counts.compared += more.counts.compared;
  counts.proposed = counts.registrations + more.counts.proposed;
  counts.registrations += more.counts.registrations;
  counts.verified += more.counts.verified;
}

void RecognisedPlaces::note_judgement(const std::vector<Closure>& judged,
                                      const std::vector<ClosureJudgement>& judgements) {
  const auto key = [](const Closure& closure) {
    return std::make_tuple(closure.robot_i, closure.stamp_i, closure.robot_j, closure.stamp_j);
  };
  std::set<std::tuple<RobotIndex, Stamp, RobotIndex, Stamp>> accepted;
  for (std::size_t k = 0; k < judged.size(); ++k)
    if (judged[k].kind == ClosureKind::kLidar && judgements[k].status == ClosureStatus::kAccepted)
      accepted.insert(key(judged[k]));
  for (std::size_t k = 0; k < attempts.size(); ++k)
    attempts[k].holds = accepted.contains(key(closures[k].closure));
}

template <class Pose>
RecognisedPlaces recognise_places(const PlaceInput<Pose>& input, const PlaceParams& params,
                                  const ScanParams& scan_params, const RadioAlignmentParams& alignment,
                                  const Progress& progress) {
  PlaceProposals proposed = propose_places(input, params, scan_params.loops, alignment);
  const std::vector<Proposal>& proposals = proposed.pairs;
  RecognisedPlaces found{{}, {}, std::move(proposed.exchange), proposed.counts};
  const auto verification = [&](double source_m, double apart_m) {
    const LoopVerificationParams of{params.submap_m, source_m, apart_m,
                                    Pose::kDim == 3 ? Storeys::kSeveral : Storeys::kOne};
    return LoopVerification(scan_params.loops, of, scan_params.lidar.map, scan_params.search,
                            scan_params.lidar.registration);
  };
  const LoopVerification spatial = verification(0, kApart_m), planar = verification(params.source_m, 0);
  std::vector<std::optional<PlacedKeyframes>> placed;
  for (const ScannedRobot& robot : proposed.robots)
    placed.push_back(robot.scans ? std::optional(robot.placed()) : std::nullopt);
  found.closures.resize(proposals.size());
  report_progress(progress, "places", 0);
  parallel_for(proposals.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Proposal& proposal = proposals[k];
      const ScannedRobot &a = proposed.robots[proposal.a], &b = proposed.robots[proposal.b];
      const ScanLoop loop = (b.kind() == ScannerKind::kPlanar ? planar : spatial)
                                .verify(*placed[proposal.a], proposal.i, *placed[proposal.b], proposal.j,
                                        expected_place(proposal));
      found.closures[k] = closure_of(proposal, loop, a, b);
    }
  });
  reject_repetitions(proposals, found.closures);
  for (std::size_t k = 0; k < proposals.size(); ++k)
    found.attempts.push_back({RobotIndex(proposals[k].a), RobotIndex(proposals[k].b), proposals[k].i,
                              proposals[k].j,
                              proposals[k].anywhere ? std::numeric_limits<double>::infinity()
                                                    : horizontal_sigma(proposals[k].T_i_j)});
  for (const Proposal& pair : proposals) {
    const bool is_planar = proposed.robots[pair.b].kind() == ScannerKind::kPlanar;
    found.exchange.send_scans(proposed.robots, pair, is_planar ? params.source_m : 0);
  }
  found.counts.bytes = found.exchange.sent();
  found.counts.registrations = proposals.size();
  found.counts.verified = static_cast<std::size_t>(
      std::count_if(found.closures.begin(), found.closures.end(),
                    [](const VerifiedClosure& c) { return c.judgement.status == ClosureStatus::kAccepted; }));
  report_progress(progress, "places", 1);
  return found;
}

#define RADIOSLAM_PLACES(Pose)                                                                               \
  template RecognisedPlaces recognise_places(const PlaceInput<Pose>&, const PlaceParams&, const ScanParams&, \
                                             const RadioAlignmentParams&, const Progress&);
RADIOSLAM_PLACES(SE2)
RADIOSLAM_PLACES(SE3)
#undef RADIOSLAM_PLACES

}  // namespace radioslam
