#include "radioslam/closure/overlap/overlap_exchange.hpp"

#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"

namespace radioslam {
namespace {

template <class Party>
class RoundByRound {
 public:
  RoundByRound(std::vector<Party>& parties, OverlapTraffic& traffic) : parties_(parties), traffic_(traffic) {
    traffic.bytes.resize(parties.size());
    for (std::size_t r = 0; r < parties.size(); ++r) send(r, parties[r].begin());
  }

  void run() {
    while (!on_the_way_.empty()) {
      bool is_asked = false;
      for (const OverlapMessage& message : std::exchange(on_the_way_, {})) {
        auto answer = parties_[message.to].hear(message.bytes);
        RADIOSLAM_CHECK(answer.has_value(), "what a party says is understood");
        send(message.to, *std::move(answer));
        is_asked = is_asked || message.kind == OverlapMessageKind::kRequest;
      }
      if (is_asked) ++traffic_.rounds;
    }
  }

 private:
  void send(std::size_t from, std::vector<OverlapMessage> messages) {
    for (OverlapMessage& message : messages) {
      traffic_.bytes[from][static_cast<std::size_t>(message.kind)] += message.bytes.size();
      on_the_way_.push_back(std::move(message));
    }
  }

  std::vector<Party>& parties_;
  OverlapTraffic& traffic_;
  std::vector<OverlapMessage> on_the_way_;
};

}  // namespace

OverlapTraffic& OverlapTraffic::operator+=(const OverlapTraffic& other) {
  if (bytes.empty()) bytes.resize(other.bytes.size());
  for (std::size_t r = 0; r < bytes.size(); ++r)
    for (std::size_t kind = 0; kind < bytes[r].size(); ++kind) bytes[r][kind] += other.bytes[r][kind];
  rounds += other.rounds;
  return *this;
}

template <OverlapSource Source>
TeamOverlapExchange<Source>::TeamOverlapExchange(const Source& source,
                                                 const std::vector<OverlapSensor>& sensors,
                                                 const OverlapParams& params, OverlapTraffic& traffic)
    : source_(source) {
  RADIOSLAM_CHECK(sensors.size() == source.robots(), "every robot has a sensor");
  const auto robots = static_cast<std::uint32_t>(source.robots());
  for (std::uint32_t r = 0; r < robots; ++r) {
    std::vector<std::string> shares(robots);
    for (std::uint32_t to = 0; to < robots; ++to)
      if (to != r) shares[to] = source.share(r, to);
    parties_.emplace_back(r, source.poses(r), std::move(shares), sensors[r], params);
  }
  OverlapTraffic sent;
  RoundByRound<Party>(parties_, sent).run();
  traffic += sent;
  for (const Party& party : parties_) RADIOSLAM_CHECK(party.is_finished(), "the search has come to an end");
}

template <OverlapSource Source>
OverlapCounts TeamOverlapExchange<Source>::search(std::uint32_t a, const TakeOverlaps& take) const {
  OverlapCounts counts;
  for (std::uint32_t b = a + 1; b < parties_.size(); ++b) {
    OverlapCandidates found = parties_[a].found(b);
    found.counts.pairs = std::uint64_t{source_.poses(a).records().size()} * source_.poses(b).records().size();
    counts += found.counts;
    take(std::move(found.candidates));
  }
  return counts;
}

template class TeamOverlapExchange<LinkCovariance<SE2>>;
template class TeamOverlapExchange<LinkCovariance<SE3>>;
template class TeamOverlapExchange<JointCovariance<SE2>>;
template class TeamOverlapExchange<JointCovariance<SE3>>;

}  // namespace radioslam
