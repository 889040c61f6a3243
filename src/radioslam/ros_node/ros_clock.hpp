// The time of a simulation or of a recording that is played: rosgraph_msgs/Clock.
#pragma once

#include <atomic>
#include <string>

#include "radioslam/io/dds/dds_topic.hpp"

namespace radioslam {

class RosClock {
 public:
  /// Keeps a reference to the domain.
  RosClock(DdsDomain& domain, const std::string& topic);

  /// As the last message has it; zero before the first. By any thread.
  Stamp now() const { return {now_ns_}; }
  bool has_begun() const { return now_ns_ != 0; }

 private:
  std::atomic<std::int64_t> now_ns_ = 0;
  DdsReader reader_;  // last, as it calls back
};

}  // namespace radioslam
