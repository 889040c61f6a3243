#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "radioslam/base/check.hpp"
#include "radioslam/io/rendezvous/robot_session.hpp"

namespace radioslam {
namespace {

/// Robots remember what they hear, so that every further line costs more.
constexpr int kMostLines = 64;

bool is_error(const std::vector<std::string>& answer) {
  return answer.size() == 1 && nlohmann::json::parse(answer[0]).contains("error");
}

void check(const std::vector<std::string>& answer) {
  for (const std::string& line : answer) {
    RADIOSLAM_CHECK(line.find('\n') == std::string::npos, "an answer is a line");
    RADIOSLAM_CHECK(nlohmann::json::parse(line).is_object(), "an answer is an object");
  }
}

void drive(std::string_view bytes) {
  RobotSession session("a", {});
  for (int k = 0; k < kMostLines && !bytes.empty(); ++k) {
    const std::string_view line = bytes.substr(0, bytes.find('\n'));
    bytes.remove_prefix(std::min(bytes.size(), line.size() + 1));
    const bool finished = session.finished();
    const auto answer = session.line(line);
    check(answer);
    RADIOSLAM_CHECK(!finished || answer.empty() || is_error(answer), "after the end nothing is done");
  }
  check(session.end());
}

}  // namespace
}  // namespace radioslam

/// Any lines are answered, in any order.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(data, data + size);
  radioslam::drive(bytes);
  return 0;
}
