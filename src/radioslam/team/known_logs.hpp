// The logs that an agent knows: its own, and those of others as far as it was sent them.
//
// Anyone may pass on anyone's records. What a robot says of itself counts: where that contradicts what others
// passed on, these are not believed about that robot any more. A robot's newer life replaces the older one
// when it says so itself, or when nobody has heard it.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/records/journal_change.hpp"
#include "radioslam/records/log_chunks.hpp"
#include "radioslam/records/team_log.hpp"
#include "radioslam/team/messages.hpp"

namespace radioslam {

class KnownLogs {
 public:
  /// `dimension`: of the mission; logs of another one are refused. `kept`: by robot and life, from the
  /// robot's journal.
  KnownLogs(std::string self, int dimension, std::uint32_t life,
            const std::vector<std::pair<std::string, KnownLog>>& kept);

  /// The robot's own next record.
  void say(std::string record);
  /// Whether others have records of this robot's life, or of a later one, that its journal has not: it is an
  /// older copy.
  bool is_behind(const LogExtent& own) const;
  /// Says all its records again as those of another life.
  void begin_life(std::uint32_t life);
  /// Bytes that `sender` sent as records. Returns what was refused, in words, and how often.
  std::map<std::string, std::size_t> accept(const std::string& sender, std::string_view chunks);

  /// Without gaps; of the robot itself, what is kept.
  const std::map<std::string, LogExtent>& extents() const { return extents_; }
  const KnownLog& log(const std::string& robot) const {
    return robot == self_ ? own_ : team_.robots().at(robot);
  }
  /// Without gaps, too.
  std::vector<RobotLog> whole() const;
  /// First and last number of the stretches before `end` that are not known, at most 64.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> missing(const std::string& robot,
                                                               std::uint64_t end) const;

  /// What the journal does not have yet; kept when it says so.
  JournalChange change() const;
  void note_kept();

  /// Robots whose logs were replaced since the last call.
  std::set<std::string> take_replaced() { return std::exchange(replaced_, {}); }

 private:
  using Refusals = std::map<std::string, std::size_t>;

  void accept(const std::string& sender, const LogChunk& chunk, Refusals& refusals);
  void check_own(const LogChunk& chunk, Refusals& refusals) const;
  bool make_room(bool is_own);
  bool is_of_other_dimension(const LogChunk& chunk) const;
  void replace(const std::string& robot);
  void extend(const std::string& robot);

  std::string self_;
  int dimension_;
  KnownLog own_;
  std::vector<std::uint32_t> own_checksums_{0};  ///< of so many records
  bool is_new_life_ = false;                     ///< that the journal does not have
  TeamLog team_;
  std::map<std::string, LogExtent> extents_;  ///< of others: as known; of the robot itself: as kept
  std::map<std::string, std::uint64_t> kept_;
  std::set<std::string> forgotten_, replaced_, heard_;  ///< the last: robots that have spoken for themselves
  std::map<std::string, std::set<std::string>> passed_on_, not_believed_;  ///< by robot: who
};

}  // namespace radioslam
