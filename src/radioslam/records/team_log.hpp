// The records of a team, as bytes that other machines can read, keep and pass on.
//
// A robot's records are said in chunks of at most 256 and 60 kB:
//   "RSL2", name, life, number of the first record, count, bytes of each record, checksum (CRC-32)
// A log file is any sequence of chunks, of any robots. A log is a set: chunks may come in any order, repeated
// or overlapping, and what is missing is known by its numbers. `life` says which recording of the robot it
// is: two recordings do not mix.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/records/record.hpp"

namespace radioslam {

/// One robot's log, by the robot itself.
struct RobotLog {
  std::string robot;
  std::vector<std::string> records;  ///< encoded

  /// Which recording it is: a checksum of all records.
  std::uint32_t life() const;

  /// Its records from `first` up to before `end`, in chunks.
  std::string bytes(std::size_t first = 0, std::size_t end = std::numeric_limits<std::size_t>::max()) const;
};

/// What became of bytes that came from elsewhere.
struct Acceptance {
  std::size_t records = 0, repeated = 0;
  std::vector<std::string> refusals;  ///< what was left out and why, at most 8; then only counted
  std::size_t refused = 0;            ///< pieces of the bytes

  bool is_whole() const { return refused == 0; }
};

/// One robot's records, as far as they are known.
struct KnownLog {
  std::uint32_t life = 0;
  std::map<std::uint64_t, std::string> records;  ///< encoded, by their numbers

  /// First and last number of every stretch that is missing before the last known record.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps() const;
  /// Chunks of the records from `first` up to before `end`, all of them known, of at most so many bytes, and
  /// the number of the first record that is left. At least one record, if there is any.
  std::pair<std::string, std::uint64_t> bytes(const std::string& robot, std::uint64_t first,
                                              std::uint64_t end, std::size_t most_bytes) const;
};

class TeamLog {
 public:
  /// Takes any bytes. What is damaged, not understood or contradicts what is known is left out, chunk by
  /// chunk. Time linear in the bytes but for a logarithm of the records known, memory at most ten times
  /// theirs.
  Acceptance accept(std::string_view bytes);
  /// Takes the whole log of a robot from the robot itself, unchecked.
  void add(const RobotLog& own);
  /// As if nothing of the robot had been known: another recording can be taken.
  void forget(const std::string& robot) { robots_.erase(robot); }

  /// By the robots' names.
  const std::map<std::string, KnownLog>& robots() const { return robots_; }

 private:
  std::map<std::string, KnownLog> robots_;
};

}  // namespace radioslam
