#include "radioslam/io/dds/dds_endpoint.hpp"

#include <algorithm>

#include "radioslam/io/dds/dds_names.hpp"

namespace radioslam {
namespace {

constexpr const char* kReliabilities[] = {"best effort", "reliable"};
constexpr const char* kDurabilities[] = {"volatile", "transient local", "transient", "persistent"};
constexpr const char* kLivelinesses[] = {"automatic", "by participant", "by topic"};
constexpr const char* kOwnerships[] = {"shared", "exclusive"};
constexpr const char* kOrders[] = {"by reception", "by source"};

/// What a writer offers and a reader asks for.
struct Policy {
  std::string name, offered, requested;
};

template <class Kind>
Policy policy(const char* name, const char* const* words, Kind offered, Kind requested) {
  return {name, words[static_cast<std::size_t>(offered)], words[static_cast<std::size_t>(requested)]};
}

std::string duration(std::int64_t duration_ns) {
  if (duration_ns == DdsEndpoint::kNever_ns) return "none";
  return std::to_string(duration_ns / 1'000'000) + " ms";
}

/// Only the representation a writer prefers is sent.
std::int16_t sent(const DdsEndpoint& writer) {
  return writer.representations.empty() ? std::int16_t{0} : writer.representations.front();
}

bool reads(const DdsEndpoint& reader, std::int16_t representation) {
  const auto& known = reader.representations;
  return known.empty() ? representation == 0
                       : std::find(known.begin(), known.end(), representation) != known.end();
}

/// The policies of which the writer offers less than the reader asks for.
std::vector<Policy> unmet(const DdsEndpoint& writer, const DdsEndpoint& reader) {
  std::vector<Policy> found;
  if (writer.reliability < reader.reliability)
    found.push_back(policy("reliability", kReliabilities, writer.reliability, reader.reliability));
  if (writer.durability < reader.durability)
    found.push_back(policy("durability", kDurabilities, writer.durability, reader.durability));
  if (writer.liveliness < reader.liveliness)
    found.push_back(policy("liveliness", kLivelinesses, writer.liveliness, reader.liveliness));
  if (writer.ownership != reader.ownership)
    found.push_back(policy("ownership", kOwnerships, writer.ownership, reader.ownership));
  if (writer.order < reader.order)
    found.push_back(policy("destination order", kOrders, writer.order, reader.order));
  if (writer.deadline_ns > reader.deadline_ns)
    found.push_back({"deadline", duration(writer.deadline_ns), duration(reader.deadline_ns)});
  if (writer.lease_ns > reader.lease_ns)
    found.push_back({"lease of liveliness", duration(writer.lease_ns), duration(reader.lease_ns)});
  if (!reads(reader, sent(writer)))
    found.push_back({"data representation", "XCDR " + std::to_string(sent(writer)), "another one"});
  return found;
}

}  // namespace

std::string mismatch(const DdsEndpoint& writer, const DdsEndpoint& reader) {
  if (writer.topic != reader.topic || writer.is_own == reader.is_own) return {};
  const std::string begin = "topic " + ros_topic(writer.topic) + ": ";
  const std::string publisher = writer.is_own ? "this robot" : "a publisher";
  const std::string subscriber = reader.is_own ? "this robot" : "a subscriber";
  if (writer.type != reader.type)
    return begin + publisher + " sends " + ros_type(writer.type) + ", " + subscriber + " reads " +
           ros_type(reader.type) + "; nothing passes";
  std::string reasons;
  for (const Policy& policy : unmet(writer, reader))
    reasons += (reasons.empty() ? "" : "; ") + policy.name + ": " + publisher + " offers " + policy.offered +
               ", " + subscriber + " asks for " + policy.requested;
  return reasons.empty() ? reasons : begin + reasons + "; nothing passes";
}

}  // namespace radioslam
