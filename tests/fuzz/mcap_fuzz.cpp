#include "radioslam/io/ros/mcap.hpp"
#include "ros_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return radioslam::fuzz_recording(data, size, radioslam::visit_mcap);
}
