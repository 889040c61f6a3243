// What a robot's journal keeps at once (io/journal/journal.hpp): all of it or nothing.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace radioslam {

struct JournalChange {
  /// A stretch of another robot's records, or of an earlier life of this one.
  struct Kept {
    std::string robot;
    std::uint32_t life = 0;
    std::uint64_t first = 0;
    std::vector<std::string> records;
  };

  std::vector<std::string> forgotten;  ///< robots, all of whose records go before any are added, but own ones
  std::vector<Kept> kept;              ///< numbers that are known must have the same contents
  std::optional<std::uint32_t> life = {};  ///< the robot's next one; own records of the last go
  std::uint64_t first_own = 0;         ///< number of the first of `own`
  std::vector<std::string> own;        ///< as `kept`, and without a gap
  std::map<std::string, std::string> state;  ///< replaces the bytes of these keys

  bool empty() const { return forgotten.empty() && kept.empty() && own.empty() && state.empty() && !life; }
};

}  // namespace radioslam
