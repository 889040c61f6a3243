// What the agents of a team say to each other, as bytes (docs/formats.md, "Messages of agents").
//
// An envelope, "RST1", kind and sender, then:
//   digest     which records the sender has of every robot, without a gap; whether it solves
//   records    chunks of any robots' logs (records/team_log.hpp)
//   want       stretches of logs that the sender lacks
//   cloud want keyframes whose clouds the sender would register
//   cloud      one of those, packed (lidar/clouds/packed_cloud.hpp)
//   solution   where the sender's estimate places the robots' odometry, for robots that make none
// Nothing depends on one arriving: digests come again, and what is lacking is asked for again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/live/published_frames.hpp"
#include "radioslam/live/scans_so_far.hpp"

namespace radioslam {

inline constexpr std::size_t kMaxAgentMessageBytes = 60000;
inline constexpr std::size_t kMaxTeam = 256;       ///< robots in a digest
inline constexpr std::size_t kMaxStretches = 256;  ///< in a want

/// How much of a robot's log somebody has.
struct LogExtent {
  std::uint32_t life = 0;     ///< which log of the robot it is; a later one is higher
  std::uint64_t records = 0;  ///< without a gap
  std::uint32_t checksum = 0;  ///< of these (KnownLogs), so that logs that differ are seen
  bool operator==(const LogExtent&) const = default;
};

struct Digest {
  std::map<std::string, LogExtent> knows;
  bool solves = true;  ///< makes estimates of its own
};

struct RecordsMessage {
  std::string chunks;
};

/// Records of a robot from `first` up to before `end`.
struct WantedStretch {
  std::string robot;
  std::uint32_t life = 0;
  std::uint64_t first = 0, end = 0;
  bool operator==(const WantedStretch&) const = default;
};
struct Want {
  std::vector<WantedStretch> stretches;
};

struct CloudWant {
  std::vector<Stamp> keyframes;  ///< of the receiver
};

struct CloudMessage {
  Stamp keyframe;  ///< of the sender
  ScannerFacts scanner;
  std::string packed;
};

struct SolutionMessage {
  std::uint64_t records = 0;  ///< from which it was made
  std::map<std::string, PublishedFrame> frames;
};

using AgentMessage = std::variant<Digest, RecordsMessage, Want, CloudWant, CloudMessage, SolutionMessage>;

/// In the order of AgentMessage.
inline constexpr const char* kAgentMessageKinds[] = {"digest",     "records", "want",
                                                     "cloud_want", "cloud",   "solution"};

std::string encode(const std::string& sender, const AgentMessage& message);

struct ReceivedMessage {
  std::string sender;
  AgentMessage message;
};

/// The message, or why these bytes are none. Never reads beyond them; cost linear in their number.
std::variant<ReceivedMessage, std::string> decode_message(std::string_view bytes);

}  // namespace radioslam
