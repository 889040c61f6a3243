#include "radioslam/graph/distributed/stage_agreement.hpp"

#include <algorithm>

namespace radioslam {

StageAgreement::StageAgreement(const std::vector<RobotNumber>& neighbours) {
  for (const RobotNumber n : neighbours) neighbours_[n];
}

bool StageAgreement::hear(RobotNumber from, const StageNews& news) {
  const auto at = neighbours_.find(from);
  if (at == neighbours_.end() || (news.stage > news_.stage && news.stage - news_.stage > 1)) return false;
  auto& [last, this_round] = at->second;
  if (last && (last->finished || last->stage > news.stage)) return true;  // a late message
  last = news;
  this_round = true;
  return true;
}

std::optional<StageEnd> StageAgreement::heard_end() const {
  std::optional<StageEnd> end;
  for (const auto& [robot, heard] : neighbours_) {
    if (heard.last && heard.last->finished) return StageEnd::kFinish;
    if (heard.last && heard.last->stage > news_.stage) end = StageEnd::kNext;
  }
  return end;
}

bool StageAgreement::together() const {
  return std::all_of(neighbours_.begin(), neighbours_.end(), [&](const auto& entry) {
    return entry.second.last && entry.second.last->stage >= news_.stage;
  });
}

bool StageAgreement::count(Activity activity, std::uint32_t rounds_at_rest) {
  if (activity != Activity::kWaited) at_rest_ = activity != Activity::kMoved;
  if (activity == Activity::kMoved || activity == Activity::kSlowed) news_.moved = true;
  bool all_heard = at_rest_;
  std::uint32_t least = news_.quiet;
  for (auto& [robot, heard] : neighbours_) {
    if (heard.this_round && heard.last->stage == news_.stage) {
      news_.moved = news_.moved || heard.last->moved;
      least = std::min(least, heard.last->quiet);
    } else {
      all_heard = false;
    }
    heard.this_round = false;
  }
  news_.quiet = all_heard ? least + 1 : 0;
  return news_.quiet >= rounds_at_rest;
}

void StageAgreement::end(StageEnd end) {
  if (end == StageEnd::kFinish) {
    news_.finished = true;
    return;
  }
  news_ = {news_.stage + 1, 0, false, false};
  at_rest_ = false;
}

}  // namespace radioslam
