// The logs that a robot knows: its own as it grows, and those it heard, from the robots themselves or from
// third ones (records/). It says which records it has, and is sent what it lacks.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/records/team_log.hpp"
#include "radioslam/rendezvous/angle_evidence.hpp"
#include "radioslam/rendezvous/read_log.hpp"
#include "radioslam/rendezvous/robot_message.hpp"

namespace radioslam {

/// A sighting both of whose ends are known: robot `j` from pose `sighting->keyframe` of robot `i`.
struct SightingBetween {
  const std::string* i = nullptr;
  const std::string* j = nullptr;
  std::uint32_t keyframe_j = 0;
  const Sighting* sighting = nullptr;
};

class RobotLogs {
 public:
  /// A robot that begins at a time, where it is in the common frame if that is known. Begun again a second
  /// later, it is another recording, for which the others drop the one before.
  RobotLogs(std::string robot, Stamp start, const std::optional<SE2>& pose, const AngleCheckParams& angles);

  /// The robot's own next record; one that is not plausible is left out.
  void say(const Record& record);
  /// The robot has said all it measured until a time.
  void is_whole_until(Stamp now);
  /// Any bytes that another robot sent as records.
  void accept(std::string_view bytes);
  /// What another robot says of the logs that it knows.
  void note(const std::map<std::string, LogVersion>& known);

  /// What this robot knows, itself included.
  std::map<std::string, LogVersion> versions(double now_s) const;
  /// Records of a robot from a number on, as far as they are known without a gap and fit into so many bytes,
  /// and the number of the first one that is left.
  std::pair<std::string, std::uint64_t> records(const std::string& robot, std::uint64_t first,
                                                std::size_t most_bytes) const;
  /// This robot's and the known ones that sightings lead to from another, the nearest first, without its own.
  std::vector<std::string> around(const std::string& robot, int hops) const;

  const std::string& robot() const { return robot_; }
  const std::map<std::string, ReadLog>& all() const { return read_; }
  const ReadLog& own() const { return read_.at(robot_); }
  /// Whether `between` may give another answer than before.
  bool has_news() const { return has_news_; }
  /// Rises with every change of what `between` answers.
  std::size_t changes() const { return changes_; }
  /// The sightings both of whose ends are known, by the names of those who saw.
  std::vector<SightingBetween> between();

 private:
  void read(const std::string& robot, const KnownLog& log);
  void reconsider(const std::string& robot, const Record& record);
  AngleEvidence evidence_of(const std::string& i, const ReadLog& of_i, const Sighting& sighting,
                            const ReadLog& of_j, std::uint32_t keyframe_j) const;

  std::string robot_;
  AngleCheckParams angles_;
  KnownLog own_;
  TeamLog heard_;  ///< also of what calls itself this robot, which is not read
  std::map<std::string, ReadLog> read_;
  std::map<std::string, LogVersion> said_;  ///< until when logs are whole that are not yet known as far
  std::map<std::string, std::set<std::string>> links_;  ///< who saw whom, both ways
  bool has_news_ = true;
  std::size_t changes_ = 0;
  std::size_t open_ = 0;  ///< sightings of which an end was not known
};

}  // namespace radioslam
