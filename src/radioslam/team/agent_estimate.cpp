#include "radioslam/team/agent_estimate.hpp"

#include <cstdio>
#include <deque>
#include <utility>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

/// A short name of a text, the same on every machine (FNV-1a).
std::string digest_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  char name[17];
  std::snprintf(name, sizeof(name), "%016llx", static_cast<unsigned long long>(hash));
  return name;
}

template <class Pose>
class AgentEstimateOf : public AgentEstimate {
 public:
  AgentEstimateOf(const RunParams& params, const StreamParams& stream) : params_(params), known_(stream) {}

  void hear(const std::string& robot, const std::string& record) override {
    if (auto decoded = decode_record(record)) waiting_[robot].push_back(*std::move(decoded));
  }

  std::optional<EstimateJob> job(Stamp now) override {
    if (is_made_) return std::nullopt;
    take_until(Stamp{now.ns - Stamp::from_seconds(kCut_s).ns}, now);
    auto request = known_.request(now);
    if (!request) return std::nullopt;
    std::string key = last_key_ + '@' + std::to_string(now.ns);
    for (const auto& [robot, records] : heard_) key += ';' + robot + '=' + std::to_string(records);
    key = digest_of(key);
    is_made_ = true;
    made_key_ = key;
    return EstimateJob{std::move(key), [request = *std::move(request), &params = params_] {
                         return AnyGrownEstimate(estimate<Pose>(request, params));
                       }};
  }

  std::vector<TeamEvent> take(const AnyGrownEstimate& result, Stamp now) override {
    is_made_ = false;
    const auto& grown = std::get<GrownEstimate<Pose>>(result);
    const bool is_new = grown.solution != nullptr;
    known_.take(grown);
    if (!is_new) return {};
    last_key_ = made_key_;
    return frames_.move_to(known_.last()->team, now, known_.keyframes());
  }

  const PublishedFrames& frames() const override { return frames_; }
  const std::map<std::string, LoggedKeyframes>& keyframes() const override { return known_.keyframes(); }
  std::vector<EstimatedTrajectory> largest_frame() const override {
    if (!known_.last()) return {};
    return radioslam::largest_frame(known_.last()->team, frames_);
  }
  std::size_t records() const override { return known_.known().records; }

 private:
  /// Of every robot, its log before the first keyframe after a time.
  void take_until(Stamp until, Stamp now) {
    for (auto& [robot, records] : waiting_) {
      const auto is_later = [until](const Record& record) {
        const auto* keyframe = std::get_if<KeyframeRecord>(&record);
        return keyframe && keyframe->stamp > until;
      };
      while (!records.empty() && !is_later(records.front())) {
        known_.hear(robot, std::move(records.front()), now);
        records.pop_front();
        ++heard_[robot];
      }
    }
  }

  const RunParams& params_;
  GrowingEstimate<Pose> known_;
  PublishedFrames frames_;
  std::map<std::string, std::deque<Record>> waiting_;
  std::map<std::string, std::size_t> heard_;
  bool is_made_ = false;
  std::string last_key_, made_key_;  ///< of the last solution, and of the job that is made
};

}  // namespace

std::unique_ptr<AgentEstimate> agent_estimate(int dimension, const RunParams& params,
                                              const StreamParams& stream) {
  if (dimension == 2) return std::make_unique<AgentEstimateOf<SE2>>(params, stream);
  return std::make_unique<AgentEstimateOf<SE3>>(params, stream);
}

}  // namespace radioslam
