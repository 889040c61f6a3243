// What a robot must still know after it was switched off: its own records, those of others as far as it has
// received them, and what else it needs to go on. One SQLite database (3.40) per robot:
//   journal(robot, life, crc)                 whose it is; life: drawn when it was created
//   records(robot, life, number, bytes, crc)  key (robot, life, number), without rowid
//   state(key, bytes, crc)
// with a CRC-32 of each row, since a damaged record would be one with two contents.
// A robot sends a record only after it is committed here, so that no (robot, life, number) ever has two
// contents. For that, commits are synchronous (WAL, synchronous = FULL: one fsync each). With NORMAL, a power
// failure could take back commits whose records others have already; their numbers would be given again.
// A journal that is lost, or so damaged that it is refused, is replaced by a new one with another life.
// What no file can show, a copy from an earlier day or a disk that lies about fsync, others can: a robot of
// whose current life others have more records than its journal must start a new one.
//
// Every refusal is an InputError of one line that names the file; nothing of a refused change is kept, and a
// refused journal is left as it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radioslam/io/sqlite/sqlite.hpp"
#include "radioslam/records/journal_change.hpp"
#include "radioslam/records/team_log.hpp"

namespace radioslam {

class Journal {
 public:
  /// Opens a robot's journal and holds it until the end; where there is none, creates it with the life given.
  /// Refuses a journal of another robot or version, in use or damaged, and a file that is none. Reads the
  /// whole file to check it.
  Journal(const std::filesystem::path& file, const std::string& robot, std::uint32_t life_if_new);

  std::uint32_t life() const { return life_; }
  bool is_new() const { return is_new_; }
  /// The number of own records, which is that of the next one.
  std::uint64_t own_records() const { return own_records_; }

  /// All logs with records, by robot and life.
  std::vector<std::pair<std::string, KnownLog>> logs() const;
  std::optional<std::string> state(std::string_view key) const;

  /// The change is on the disk when this returns. Refuses a record that is known with other contents, and own
  /// ones behind a gap; and fails where the disk is full or cannot be written. Goes on after either.
  void commit(const JournalChange& change);

 private:
  void check_kind(const std::string& robot);
  void check_contents();
  void create(const std::string& robot, std::uint32_t life);
  void forget(const std::string& robot);
  void begin_life(std::uint32_t life);
  void keep(const JournalChange::Kept& kept, std::uint32_t life, std::uint64_t own_records);
  void set_state(const std::string& key, const std::string& bytes);
  [[noreturn]] void refuse(const std::string& reason) const;

  SqliteDatabase database_;
  std::string robot_;
  std::uint32_t life_ = 0;
  std::uint64_t own_records_ = 0;
  bool is_new_ = false;
};

}  // namespace radioslam
