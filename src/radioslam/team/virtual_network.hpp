// A network in virtual time that loses, delays and divides, the same for the same seed. Everybody hears
// everybody, but for these faults.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/base/stamp.hpp"
#include "radioslam/team/agent.hpp"

namespace radioslam {

/// Robots `apart` and the others do not hear each other for a time.
struct Partition {
  Stamp begin, end;
  std::set<std::string> apart = {};  ///< none: the first half of the robots
};

struct NetworkFaults {
  double loss = 0;  ///< probability that a message does not arrive, each way
  double delay_s = 0.05;
  std::optional<Partition> partition = {};
  std::map<std::string, Stamp> late = {};  ///< by robot: when its radio is switched on
  std::uint64_t seed = 1;
};

struct LinkTraffic {
  std::size_t messages = 0, bytes = 0, lost = 0;
  std::size_t arrived_bytes = 0;
};

/// By sender, receiver and kind.
using TeamTraffic = std::map<std::tuple<std::string, std::string, std::size_t>, LinkTraffic>;

class VirtualNetwork {
 public:
  /// Of these robots; `faults` must outlive it.
  VirtualNetwork(std::vector<std::string> robots, const NetworkFaults& faults);

  void send(std::size_t from, const SentMessage& message, Stamp now);
  /// What arrives by now, in the order in which it was sent: receiver, sender, bytes.
  void deliver(Stamp now, const std::function<void(std::size_t, const std::string&, std::string_view)>& to);

  const TeamTraffic& traffic() const { return traffic_; }

 private:
  struct Flight {
    Stamp arrives;
    std::size_t from = 0, to = 0;
    std::string bytes;
  };

  bool reaches(std::size_t from, std::size_t to, Stamp now) const;

  std::vector<std::string> robots_;
  const NetworkFaults& faults_;
  std::vector<bool> is_apart_;  ///< by robot, on which side of the partition it is
  Rng random_;
  std::deque<Flight> flights_;
  TeamTraffic traffic_;
};

}  // namespace radioslam
