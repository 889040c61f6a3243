#include "radioslam/ros_node/ros_publisher.hpp"

#include "radioslam/io/dds/dds_names.hpp"

namespace radioslam {

DdsSink::DdsSink(DdsDomain& domain, const std::vector<RosOutputTopic>& topics) {
  for (const RosOutputTopic& topic : topics) {
    DdsQos qos;
    if (topic.is_kept) {
      qos.durability = DdsDurability::kTransientLocal;
      qos.depth = 1;
    }
    qos.longest_wait_s = 0.01;  // whoever does not keep up with what is shown misses some
    writers_[topic.name] =
        std::make_unique<DdsWriter>(domain, dds_topic(topic.name), dds_type(topic.type), qos);
  }
}

bool DdsSink::wants(const std::string& topic) const {
  const auto writer = writers_.find(topic);
  return writer != writers_.end() && writer->second->matched() > 0;
}

void DdsSink::take(const RosPublication& publication) {
  const auto writer = writers_.find(publication.topic);
  if (writer != writers_.end()) static_cast<void>(writer->second->write(publication.cdr));
}

}  // namespace radioslam
