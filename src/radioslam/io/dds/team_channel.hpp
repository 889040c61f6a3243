// The messages between the robots of a team, whose contents are not looked into. They travel as one type,
//   radioslam_msgs/msg/TeamMessage:  string from, string to, uint8 kind, uint8[] octets
// on the topics /radioslam/digest (to all, best effort: the next one comes soon), /radioslam/team (to all)
// and /radioslam/to/<robot> (to one alone, so that nobody else pays for it), the latter reliable: the last 64
// are repeated until they have arrived.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/io/dds/dds_topic.hpp"

namespace radioslam {

struct TeamMessage {
  std::string from, to;  ///< robots; `to` is empty for all
  std::uint8_t kind = 0;
  std::string octets;
};

std::string encode_cdr(const TeamMessage& message);
/// Nothing if the bytes are no such message, in whatever way.
std::optional<TeamMessage> decode_team_message(std::string_view cdr);

class TeamChannel {
 public:
  enum class Delivery { kReliable, kBestEffort };
  using Take = std::function<void(TeamMessage)>;

  /// Messages for this robot are passed to `take` by threads of Cyclone's, possibly several at a time; it
  /// should be quick and must not throw.
  TeamChannel(DdsDomain& domain, std::string robot, Take take);

  /// False if it has not been sent: nobody of that name is there yet, or reliable readers do not keep up.
  /// Messages to one robot are always reliable.
  [[nodiscard]] bool send(const std::string& to, std::uint8_t kind, std::string_view octets,
                          Delivery delivery = Delivery::kReliable);
  /// Whether another message to the robot would push out none that is still on its way. A robot that does not
  /// acknowledge what it gets, since it has ended, has room again after kLongestWait.
  bool has_room(const std::string& robot);
  /// Robots that this one reaches, and that reach it.
  std::size_t others() const { return std::min(all_.matched(), all_reader_.matched()); }
  /// Samples that were no messages, and those that were lost.
  std::uint64_t not_understood() const { return not_understood_; }
  /// Messages of another robot that goes by this one's name; they are not passed on.
  std::uint64_t of_namesakes() const { return of_namesakes_; }
  std::uint64_t lost() const;

 private:
  static constexpr std::chrono::milliseconds kLongestWait{300};

  struct Link {
    std::unique_ptr<DdsWriter> writer;
    std::size_t written = 0;  ///< since all of it had arrived, or for kLongestWait
    std::chrono::steady_clock::time_point since{};
  };

  DdsReader::Take receiver();
  Link& link_to(const std::string& robot);

  DdsDomain& domain_;
  std::string robot_;
  Take take_;
  std::atomic<std::uint64_t> not_understood_ = 0, of_namesakes_ = 0;
  DdsWriter digest_, all_;
  std::map<std::string, Link> to_;
  DdsReader digest_reader_, all_reader_, own_reader_;  // last, as they call back
};

}  // namespace radioslam
