// A fuzzer with a clock and a scale: no message of up to 1 MB takes its receiver more than 50 ms, or more
// memory than ten times its bytes and 1 MB. An input is a kind, how often its second half is repeated, and
// two halves: so a few bytes make a large message.
#include <sanitizer/allocator_interface.h>

#include <algorithm>
#include <atomic>
#include <ctime>
#include <string>
#include <string_view>

#include "first_robot.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/base/wire.hpp"
#include "radioslam/io/rendezvous/robot_session.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostBytes = 1'000'000, kFreeBytes = 1'000'000, kGrowth = 10;
/// Sanitizers and -O1 take ten times as long.
constexpr double kMostSeconds = 0.05 * 10;

std::atomic<std::int64_t> held{0}, most{0};
void on_malloc(const volatile void*, std::size_t bytes) {
  held += static_cast<std::int64_t>(bytes);
  most = std::max(most.load(), held.load());
}
void on_free(const volatile void* pointer) {
  if (pointer != nullptr)
    held -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(pointer)));
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Body>
void check_cost(std::size_t bytes, const Body& body) {
  const std::int64_t before = held;
  most = before;
  const double begin = cpu_seconds();
  body();
  RADIOSLAM_CHECK(cpu_seconds() - begin < kMostSeconds, "a message takes its receiver little time");
  RADIOSLAM_CHECK(most - before < static_cast<std::int64_t>(kGrowth * bytes + kFreeBytes),
                  "a message takes its receiver memory in proportion to its bytes");
}

/// The content as one section of a message from the neighbour.
template <class Pose>
void hear_section(std::uint8_t kind, const std::string& content) {
  WireWriter out;
  out.append("RS");
  out.byte(kWireVersion);
  out.byte(Pose::kDim);
  for (const std::uint64_t number : {1U, 0U, 0U}) out.whole(number);
  out.byte(kind);
  out.whole(content.size());
  out.append(content);
  for (const auto& solver : solvers_of_first_robot<Pose>())
    check_cost(out.size(), [&] {
      if (auto message = decode<Pose>(out.bytes())) solver->round({std::move(*message)});
    });
}

void hear_line(const std::string& line) {
  RobotSession session("a", {});
  session.line(R"({"start": {"t_s": 0, "pose": null}})");
  check_cost(line.size(), [&] { session.line(line); });
}

void hear(std::uint8_t kind, const std::string& content) {
  if (kind >= 2 * kSectionKinds) return hear_line(content);
  if (kind % 2 == 0) return hear_section<SE2>(kind / 2, content);
  return hear_section<SE3>(kind / 2, content);
}

}  // namespace
}  // namespace radioslam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  static const int hooks = __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  RADIOSLAM_CHECK(hooks != 0, "the memory can be measured");
  if (size < 4) return 0;
  const std::string bytes(data + 4, data + size);
  const std::size_t first = std::min<std::size_t>(data[1], bytes.size());
  const std::string_view repeated = std::string_view(bytes).substr(first);
  std::string content = bytes.substr(0, first);
  const std::size_t times = 256U * data[2] + data[3];
  for (std::size_t k = 0; k <= times && content.size() + repeated.size() < kMostBytes && !repeated.empty();
       ++k)
    content += repeated;
  hear(data[0] % (2 * kSectionKinds + 1), content);
  return 0;
}
