#include "radioslam/io/dds/team_channel.hpp"

#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/cdr_writer.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {
namespace {

constexpr const char* kType = "radioslam_msgs::msg::dds_::TeamMessage_";
constexpr const char* kDigestTopic = "rt/radioslam/digest";
constexpr const char* kTeamTopic = "rt/radioslam/team";
constexpr const char* kToTopic = "rt/radioslam/to/";
constexpr std::int32_t kKept = 64;
constexpr std::size_t kAtOnce = 32;  // of these, to one robot
constexpr std::size_t kMostPadding = 3;

DdsQos reliable() {
  DdsQos qos;
  qos.depth = kKept;
  return qos;
}

DdsQos best_effort() {
  DdsQos qos;
  qos.reliability = DdsReliability::kBestEffort;
  return qos;
}

/// ROS allows letters, digits and '_' in the names of topics; others are written as "_xHH".
std::string topic_to(const std::string& robot) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string topic = kToTopic;
  for (const char c : robot) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (is_plain)
      topic += c;
    else
      topic += {'_', 'x', kDigits[static_cast<unsigned char>(c) >> 4U], kDigits[c & 0xf]};
  }
  return topic;
}

}  // namespace

std::string encode_cdr(const TeamMessage& message) {
  CdrWriter out;
  out.text(message.from).text(message.to).u8(message.kind);
  return out.count(message.octets.size()).append(message.octets).take();
}

std::optional<TeamMessage> decode_team_message(std::string_view cdr) {
  static const RosChannel kChannel{"/radioslam/team", "radioslam_msgs/TeamMessage", MessageEncoding::kCdr};
  try {
    RosMessageReader in({kChannel, Stamp{}, cdr, "DDS"});
    TeamMessage message;
    message.from = in.text();
    message.to = in.text();
    message.kind = in.u8();
    const std::size_t octets = in.count(1);
    message.octets = in.take(octets);
    if (message.from.empty() || in.left() > kMostPadding) return std::nullopt;
    return message;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

TeamChannel::TeamChannel(DdsDomain& domain, std::string robot, Take take)
    : domain_(domain),
      robot_(std::move(robot)),
      take_(std::move(take)),
      digest_(domain, kDigestTopic, kType, best_effort()),
      all_(domain, kTeamTopic, kType, reliable()),
      digest_reader_(domain, kDigestTopic, kType, best_effort(), receiver()),
      all_reader_(domain, kTeamTopic, kType, reliable(), receiver()),
      own_reader_(domain, topic_to(robot_), kType, reliable(), receiver()) {}

DdsReader::Take TeamChannel::receiver() {
  return [this](const DdsReader::Sample& sample) {
    auto message = decode_team_message(sample.cdr);
    if (!message)
      ++not_understood_;
    else if (message->from == robot_)
      ++of_namesakes_;
    else if (message->to.empty() || message->to == robot_)
      take_(std::move(*message));
  };
}

TeamChannel::Link& TeamChannel::link_to(const std::string& robot) {
  Link& link = to_[robot];
  if (!link.writer) link.writer = std::make_unique<DdsWriter>(domain_, topic_to(robot), kType, reliable());
  return link;
}

bool TeamChannel::has_room(const std::string& robot) {
  Link& link = link_to(robot);
  if (link.written < kAtOnce) return true;
  if (!link.writer->is_acknowledged() && std::chrono::steady_clock::now() - link.since < kLongestWait)
    return false;
  link.written = 0;
  return true;
}

bool TeamChannel::send(const std::string& to, std::uint8_t kind, std::string_view octets, Delivery delivery) {
  Link* link = to.empty() ? nullptr : &link_to(to);
  DdsWriter& writer = link ? *link->writer : delivery == Delivery::kReliable ? all_ : digest_;
  if (writer.matched() == 0) return false;
  if (link && link->written++ == 0) link->since = std::chrono::steady_clock::now();
  return writer.write(encode_cdr({robot_, to, kind, std::string(octets)}));
}

std::uint64_t TeamChannel::lost() const {
  return digest_reader_.lost() + all_reader_.lost() + own_reader_.lost();
}

}  // namespace radioslam
