#include "radioslam/graph/distributed/simulated_network.hpp"

#include <numeric>

namespace radioslam {

std::size_t Traffic::bytes() const {
  return std::accumulate(section_bytes.begin(), section_bytes.end(), header_bytes);
}

SimulatedNetwork::SimulatedNetwork(std::size_t robots, const NetworkParams& params)
    : params_(params), rng_(static_cast<std::uint64_t>(params.seed)), inbox_(robots) {}

template <class Pose>
void SimulatedNetwork::send(const Message<Pose>& message, Traffic& traffic) {
  MessageBytes counted;
  std::string bytes = encode(message, &counted);
  ++traffic.messages;
  traffic.header_bytes += counted.header;
  for (std::size_t k = 0; k < kSectionKinds; ++k) traffic.section_bytes[k] += counted.sections[k];
  traffic.sent_by_robot.resize(inbox_.size(), 0);
  traffic.sent_by_robot[message.from] += bytes.size();
  if (rng_.uniform() < params_.loss_share) {
    ++traffic.lost;
    return;
  }
  if (rng_.uniform() < params_.repeat_share) put(message.to, bytes);
  put(message.to, std::move(bytes));
}

void SimulatedNetwork::put(RobotNumber to, std::string bytes) {
  const auto delay = rng_.below(static_cast<std::uint64_t>(params_.delay_rounds) + 1);
  inbox_[to].push_back({round_ + 1 + static_cast<std::uint32_t>(delay), std::move(bytes)});
  ++in_flight_;
}

std::vector<std::string> SimulatedNetwork::receive(RobotNumber robot) {
  std::vector<std::string> arrived;
  std::vector<Parcel> later;
  for (Parcel& parcel : inbox_[robot])
    if (parcel.due <= round_)
      arrived.push_back(std::move(parcel.bytes));
    else
      later.push_back(std::move(parcel));
  inbox_[robot] = std::move(later);
  in_flight_ -= arrived.size();
  return arrived;
}

template void SimulatedNetwork::send(const Message<SE2>&, Traffic&);
template void SimulatedNetwork::send(const Message<SE3>&, Traffic&);

}  // namespace radioslam
