#include "radioslam/ros_node/ros_subscriptions.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "radioslam/io/dds/dds_names.hpp"

namespace radioslam {
namespace {

constexpr std::int32_t kDepth = 100, kTransformDepth = 1000;
constexpr std::size_t kMostListed = 5;

/// Whether its sensor measures all the time; radios hear nobody for a while.
bool is_continuous(RobotTopicKind kind) {
  return kind == RobotTopicKind::kOdometry || kind == RobotTopicKind::kScans ||
         kind == RobotTopicKind::kImu || kind == RobotTopicKind::kFix;
}

bool is_of(const DdsEndpoint& writer, const std::string& topic) {
  return !writer.is_own && writer.topic == dds_topic(topic);
}

/// Topics of these types that others publish, for messages.
std::string others_of_type(const std::vector<DdsEndpoint>& writers,
                           const std::vector<std::string_view>& types) {
  std::vector<std::string> topics;
  for (const DdsEndpoint& writer : writers)
    if (!writer.is_own &&
        std::find(types.begin(), types.end(), short_type(ros_type(writer.type))) != types.end())
      topics.push_back(ros_topic(writer.topic));
  std::sort(topics.begin(), topics.end());
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
  std::string list;
  for (std::size_t k = 0; k < std::min(topics.size(), kMostListed); ++k)
    list += (k > 0 ? ", " : "") + topics[k];
  return list;
}

}  // namespace

Stamp host_time() {
  return {std::chrono::duration_cast<std::chrono::nanoseconds>(
              std::chrono::system_clock::now().time_since_epoch())
              .count()};
}

RosSubscriptions::RosSubscriptions(DdsDomain& domain, const RobotTopics& topics, Clock clock, Take take)
    : domain_(domain), clock_(std::move(clock)), take_(std::move(take)) {
  for (std::size_t k = 0; k < topics.measured.size(); ++k) {
    const RobotTopic& topic = topics.measured[k];
    Subscription of;
    of.number = k;
    of.topic = topic.name;
    of.types = types_of(topic.kind);
    of.kind = topic.kind;
    of.is_stated = topic.is_stated;
    add(std::move(of));
  }
  Subscription transforms;
  transforms.number = RosArrival::kStaticTransforms;
  transforms.topic = topics.static_transforms;
  transforms.types = {"tf2_msgs/TFMessage"};
  transforms.is_watched = false;  // it says what it has to say once
  transforms.durability = DdsDurability::kTransientLocal;
  add(std::move(transforms));
}

void RosSubscriptions::add(Subscription subscription) {
  subscription.last_ns = std::make_unique<std::atomic<std::int64_t>>(0);
  subscriptions_.push_back(std::move(subscription));
}

void RosSubscriptions::look(Stamp now) {
  if (!begin_) begin_ = now;
  const auto writers = domain_.writers();
  for (Subscription& subscription : subscriptions_) {
    follow(subscription, writers);
    if (subscription.is_watched) watch(subscription, writers, now);
  }
  watch_motion(writers, now);
}

/// By the publishers' type if it can be read, and as reliably as the least reliable of them sends.
void RosSubscriptions::follow(Subscription& subscription, const std::vector<DdsEndpoint>& writers) {
  const auto& types = subscription.types;
  std::vector<std::pair<std::string, DdsReliability>> offered;
  for (const DdsEndpoint& writer : writers)
    if (is_of(writer, subscription.topic))
      offered.emplace_back(short_type(ros_type(writer.type)), writer.reliability);
  if (offered.empty()) return;
  const auto is_offered = [&](std::string_view type) {
    return std::any_of(offered.begin(), offered.end(), [&](const auto& of) { return of.first == type; });
  };
  std::string type = subscription.type;
  if (!is_offered(type)) {
    const auto found = std::find_if(types.begin(), types.end(), is_offered);
    if (found != types.end()) type = *found;
  }
  if (type.empty()) type = types.front();  // the mismatch is then said
  DdsReliability reliability = subscription.reliability;
  for (const auto& [of_writer, offers] : offered)
    if (of_writer == type) reliability = std::min(reliability, offers);
  if (subscription.reader && reliability == subscription.reliability && type == subscription.type) return;
  subscription.type = type;
  subscription.reliability = reliability;
  open(subscription);
}

void RosSubscriptions::open(Subscription& subscription) {
  DdsQos qos;
  qos.reliability = subscription.reliability;
  qos.durability = subscription.durability;
  qos.depth = subscription.durability == DdsDurability::kVolatile ? kDepth : kTransformDepth;
  const RosChannel channel{subscription.topic, subscription.type, MessageEncoding::kCdr};
  subscription.reader.reset();
  subscription.reader =
      std::make_unique<DdsReader>(domain_, dds_topic(subscription.topic), dds_type(subscription.type), qos,
                                  [this, channel, number = subscription.number,
                                   last_ns = subscription.last_ns.get()](const DdsReader::Sample& sample) {
                                    const Stamp now = host_time();
                                    *last_ns = now.ns;
                                    take_({number, channel, now, clock_(), std::string(sample.cdr)});
                                  });
}

void RosSubscriptions::watch(const Subscription& subscription, const std::vector<DdsEndpoint>& writers,
                             Stamp now) {
  const Stamp last{*subscription.last_ns};
  const bool has_sent = last.ns != 0;
  const double quiet_s = is_continuous(subscription.kind) ? kQuiet_s : kRadioQuiet_s;
  if (seconds_between(has_sent ? last : *begin_, now) < quiet_s) return;
  const bool is_published = std::any_of(writers.begin(), writers.end(), [&](const DdsEndpoint& writer) {
    return is_of(writer, subscription.topic);
  });
  const std::string begin = "topic " + subscription.topic + ": nothing has come for " +
                            std::to_string(static_cast<int>(quiet_s)) + " s; ";
  if (has_sent)
    return notes_.say(begin + (is_published ? "it is published, has its sensor stopped?"
                                            : "nobody publishes it any more, has its driver ended?"));
  if (is_published)
    return notes_.say(begin +
                      "it is published, but nothing has ever come: does its driver get data, and is "
                      "its type and QoS what this robot reads?");
  if (!subscription.is_stated) return;
  const std::string others = others_of_type(writers, subscription.types);
  notes_.say(begin + "nobody publishes it" +
             (others.empty() ? ", and nothing of its type: is its driver started, with the same "
                               "ROS_DOMAIN_ID, and reachable?"
                             : "; of its type there is " + others + ", a namespace or a remap may differ"));
}

/// A robot needs odometry or scans; it says where it has looked for them.
void RosSubscriptions::watch_motion(const std::vector<DdsEndpoint>& writers, Stamp now) {
  if (seconds_between(*begin_, now) < kQuiet_s) return;
  std::string looked;
  std::vector<std::string_view> types;
  for (const Subscription& of : subscriptions_) {
    if (!of.is_watched || (of.kind != RobotTopicKind::kOdometry && of.kind != RobotTopicKind::kScans))
      continue;
    if (*of.last_ns != 0 || of.is_stated) return;  // else said for itself
    looked += (looked.empty() ? "" : ", ") + of.topic;
    types.insert(types.end(), of.types.begin(), of.types.end());
  }
  const std::string others = others_of_type(writers, types);
  notes_.say("gets neither odometry nor scans, for which it looks at " + looked +
             (others.empty() ? "; nobody publishes any: are the drivers started, with the same "
                               "ROS_DOMAIN_ID, and reachable?"
                             : "; there is " + others + ", which --topic KIND=NAME takes"));
}

}  // namespace radioslam
