// A network between robots that loses, delays, reorders and repeats messages, and counts their bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/graph/distributed/message.hpp"

namespace radioslam {

struct NetworkParams {
  double loss_share = 0;    ///< of messages that never arrive
  int delay_rounds = 0;     ///< largest delay beyond the next round; each is drawn evenly up to it
  double repeat_share = 0;  ///< of messages that arrive a second time, with a delay of its own
  int seed = 1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(loss_share, "", 0, 1, "share of messages between robots that are lost");
    RADIOSLAM_BASIC_FIELD(delay_rounds, "", 0, 1000, "largest delay of a message, beyond the next round");
    RADIOSLAM_BASIC_FIELD(repeat_share, "", 0, 1, "share of messages that arrive twice");
    RADIOSLAM_BASIC_FIELD(seed, "", 0, 2147483647, "seed of the losses and delays");
  }
};

/// Bytes and messages sent in a round, lost ones included.
struct Traffic {
  std::size_t messages = 0, lost = 0, header_bytes = 0;
  std::array<std::size_t, kSectionKinds> section_bytes{};
  std::vector<std::size_t> sent_by_robot;  ///< bytes
  std::size_t bytes() const;
};

class SimulatedNetwork {
 public:
  SimulatedNetwork(std::size_t robots, const NetworkParams& params);

  template <class Pose>
  void send(const Message<Pose>& message, Traffic& traffic);
  /// What arrives at a robot in this round, as bytes.
  std::vector<std::string> receive(RobotNumber robot);
  /// Ends the round.
  void advance() { ++round_; }
  bool idle() const { return in_flight_ == 0; }

 private:
  struct Parcel {
    std::uint32_t due = 0;
    std::string bytes;
  };
  void put(RobotNumber to, std::string bytes);

  NetworkParams params_;
  Rng rng_;
  std::vector<std::vector<Parcel>> inbox_;
  std::uint32_t round_ = 0;
  std::size_t in_flight_ = 0;
};

}  // namespace radioslam
