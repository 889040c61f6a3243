// Any bytes are taken or refused, at a cost in proportion to their number, and what was taken makes a mission
// or is refused with one line.
#include <cstdint>
#include <stdexcept>
#include <string>

#include "radioslam/base/check.hpp"
#include "radioslam/records/mission_of_logs.hpp"
#include "radioslam/records/record_codec.hpp"
#include "radioslam/records/team_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  const std::string bytes(data, data + size);
  if (const auto record = decode_record(bytes))
    RADIOSLAM_CHECK(decode_record(encode(*record)).has_value(), "what was read can be written and read");
  // As a log of single records, whose checksums a fuzzer does not guess.
  RobotLog log{"a", {}};
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t length = 1 + static_cast<unsigned char>(bytes[at]);
    log.records.push_back(bytes.substr(at + 1, length));
    if (log.records.back().empty()) log.records.pop_back();
    at += 1 + length;
  }
  TeamLog team;
  team.accept(bytes);
  team.accept(log.bytes());
  for (std::size_t k = 0; k < log.records.size(); ++k) team.accept(RobotLog{"b", {log.records[k]}}.bytes());
  try {
    (void)mission_of(team);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
