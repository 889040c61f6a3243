#include "radioslam/ros_node/ros_clock.hpp"

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {
namespace {

DdsQos as_clocks_are_read() {
  DdsQos qos;
  qos.reliability = DdsReliability::kBestEffort;
  qos.depth = 1;
  return qos;
}

}  // namespace

RosClock::RosClock(DdsDomain& domain, const std::string& topic)
    : reader_(domain, dds_topic(topic), dds_type("rosgraph_msgs/msg/Clock"), as_clocks_are_read(),
              [this, channel = RosChannel{topic, "rosgraph_msgs/Clock"}](const DdsReader::Sample& sample) {
                try {
                  RosMessageReader in({channel, Stamp{}, sample.cdr, "the wire"});
                  const std::int64_t seconds = in.i32();
                  const Stamp now{seconds * kNanosecondsPerSecond + in.u32()};
                  if (now.ns > 0) now_ns_ = now.ns;
                } catch (const InputError&) {  // no time
                }
              }) {}

}  // namespace radioslam
