#include <string>

#include "first_robot.hpp"
#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

template <class Pose>
void hear(const Message<Pose>& message) {
  const auto solvers = solvers_of_first_robot<Pose>();
  for (const auto& solver : solvers)
    for (int round = 0; round < 3; ++round)
      for (const auto& answer : solver->round({message}))
        RADIOSLAM_CHECK(answer.to == 1, "a robot speaks to those it shares factors with");
}

template <class Pose>
void read(std::string_view bytes) {
  const auto message = decode<Pose>(bytes);
  if (!message) return;
  RADIOSLAM_CHECK(decode<Pose>(encode(*message)).has_value(), "what was read can be written and read");
  hear(*message);
}

}  // namespace
}  // namespace radioslam

/// Any bytes are a message or none, and no message harms the robot that hears it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(data, data + size);
  radioslam::read<radioslam::SE2>(bytes);
  radioslam::read<radioslam::SE3>(bytes);
  return 0;
}
