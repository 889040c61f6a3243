#include "radioslam/team/virtual_network.hpp"

namespace radioslam {

VirtualNetwork::VirtualNetwork(std::vector<std::string> robots, const NetworkFaults& faults)
    : robots_(std::move(robots)), faults_(faults), random_(faults.seed) {
  const std::size_t half = (robots_.size() + 1) / 2;
  for (std::size_t k = 0; k < robots_.size(); ++k)
    is_apart_.push_back(
        faults.partition &&
        (faults.partition->apart.empty() ? k < half : faults.partition->apart.contains(robots_[k])));
}

void VirtualNetwork::send(std::size_t from, const SentMessage& message, Stamp now) {
  for (std::size_t to = 0; to < robots_.size(); ++to) {
    if (to == from || (!message.to.empty() && message.to != robots_[to])) continue;
    LinkTraffic& traffic = traffic_[{robots_[from], robots_[to], message.kind}];
    ++traffic.messages;
    traffic.bytes += message.bytes.size();
    if (!reaches(from, to, now) || random_.uniform() < faults_.loss) {
      ++traffic.lost;
      continue;
    }
    traffic.arrived_bytes += message.bytes.size();
    flights_.push_back({Stamp{now.ns + Stamp::from_seconds(faults_.delay_s).ns}, from, to, message.bytes});
  }
}

void VirtualNetwork::deliver(
    Stamp now, const std::function<void(std::size_t, const std::string&, std::string_view)>& to) {
  while (!flights_.empty() && flights_.front().arrives <= now) {
    const Flight flight = std::move(flights_.front());
    flights_.pop_front();
    to(flight.to, robots_[flight.from], flight.bytes);
  }
}

bool VirtualNetwork::reaches(std::size_t from, std::size_t to, Stamp now) const {
  const auto is_off = [&](std::size_t k) {
    const auto on = faults_.late.find(robots_[k]);
    return on != faults_.late.end() && now < on->second;
  };
  if (is_off(from) || is_off(to)) return false;
  const auto& partition = faults_.partition;
  const bool is_divided = partition && partition->begin <= now && now < partition->end;
  return !is_divided || is_apart_[from] == is_apart_[to];
}

}  // namespace radioslam
