// Everything that an agent publishes, in a file.
#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/mcap_writer.hpp"
#include "radioslam/ros_node/ros_publisher.hpp"

namespace radioslam::cli {

/// Where the file cannot be written, the agent goes on without.
class McapSink : public RosSink {
 public:
  /// Refuses what McapWriter refuses.
  explicit McapSink(const std::filesystem::path& target) : writer_(target) {}

  bool wants(const std::string&) const override { return !failure_; }
  void take(const RosPublication& of) override {
    try {
      writer_.add(of.topic, of.type, of.definition, of.stamp, of.cdr);
    } catch (const InputError&) {
      failure_ = std::current_exception();
    }
  }
  /// Moves the file to its place. Throws what it could not be written for.
  void commit() {
    if (failure_) std::rethrow_exception(failure_);
    writer_.commit();
  }

 private:
  McapWriter writer_;
  std::exception_ptr failure_;
};

}  // namespace radioslam::cli
