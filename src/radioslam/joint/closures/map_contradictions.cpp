#include "radioslam/joint/closures/map_contradictions.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/joint/places/map_witness.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinHeld = 1000;  // points that were compared
constexpr double kMaxThrough = 0.4;     // share of points seen through, however the world is made
/// The same against the group of the pair that lays the maps best.
constexpr double kMaxOverBest = 3, kMaxBeyondBest = 0.02;

}  // namespace

template <class Pose>
std::vector<LoopGroup> held_against_maps(const MapWitness* maps, const std::vector<Closure>& closures,
                                         const std::vector<TeamLoop<Pose>>& loops,
                                         std::vector<LoopGroup> groups) {
  if (!maps) return groups;
  std::vector<std::optional<double>> through;  // per group
  std::map<std::pair<std::size_t, std::size_t>, double> least;
  for (const LoopGroup& group : groups) {
    through.emplace_back();
    if (group.evidence < kMinSupport) continue;
    std::vector<const Closure*> members;
    for (const std::size_t k : group.loops) members.push_back(&closures[loops[k].closures.front()]);
    const SeenThrough held = maps->held_against(members);
    if (held.all() < kMinHeld) continue;
    through.back() = held.share();
    double& best = least.try_emplace({group.segment_a, group.segment_b}, 1).first->second;
    best = std::min(best, held.share());
  }
  std::size_t k = 0;
  std::erase_if(groups, [&](const LoopGroup& group) {
    const std::optional<double> share = through[k++];
    if (!share) return false;
    const double best = least.at({group.segment_a, group.segment_b});
    return *share > kMaxThrough || *share > kMaxOverBest * best + kMaxBeyondBest;
  });
  return groups;
}

template std::vector<LoopGroup> held_against_maps(const MapWitness*, const std::vector<Closure>&,
                                                  const std::vector<TeamLoop<SE2>>&, std::vector<LoopGroup>);
template std::vector<LoopGroup> held_against_maps(const MapWitness*, const std::vector<Closure>&,
                                                  const std::vector<TeamLoop<SE3>>&, std::vector<LoopGroup>);

}  // namespace radioslam
