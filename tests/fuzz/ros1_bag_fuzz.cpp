#include "radioslam/io/ros/ros1_bag.hpp"
#include "ros_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return radioslam::fuzz_recording(data, size, radioslam::visit_ros1_bag);
}
