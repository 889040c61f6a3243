#include "radioslam/io/ros/ros_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/sqlite/sqlite.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

constexpr const char* kRefusal = "cannot be read as a rosbag2 database";

/// A file name escaped for a URI.
std::string escaped(const std::string& path) {
  std::string result;
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      constexpr const char* kHexadecimal = "0123456789abcdef";
      result += {'%', kHexadecimal[static_cast<unsigned char>(c) >> 4U], kHexadecimal[c & 0xf]};
    } else {
      result += c;
    }
  }
  return result;
}

/// Opens a database as immutable, so that no lock or journal file is created.
SqliteDatabase open_database(const std::filesystem::path& file) {
  const std::string uri = "file:" + escaped(std::filesystem::absolute(file).string()) + "?immutable=1";
  return {file.string(), kRefusal, uri, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI};
}

using DatabaseChannels = std::map<std::int64_t, RosChannel>;

/// The definitions of types, where the recorder wrote them.
std::map<std::string, std::string> read_definitions(const SqliteDatabase& database) {
  std::map<std::string, std::string> definitions;
  SkippedRecords absent;
  absent.attempt([&] {
    SqliteRows rows =
        database.prepare("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
    while (rows.step() == SQLITE_ROW)
      if (rows.text(1) == "ros2msg") definitions[short_type(rows.text(0))] = rows.text(2);
  });
  return definitions;
}

/// The topics whose messages are in CDR; other encodings are added to `foreign`.
DatabaseChannels read_topics(const SqliteDatabase& database, std::set<std::string>& foreign) {
  DatabaseChannels channels;
  const auto definitions = read_definitions(database);
  SqliteRows rows = database.prepare("SELECT id, name, type, serialization_format FROM topics");
  while (rows.next()) {
    const std::string encoding = rows.text(3);
    if (encoding != "cdr") {
      foreign.insert(encoding);
      continue;
    }
    const std::string type = short_type(rows.text(2));
    const auto definition = definitions.find(type);
    channels[rows.integer(0)] = {rows.text(1), type, MessageEncoding::kCdr,
                                 definition == definitions.end() ? "" : definition->second};
  }
  return channels;
}

constexpr const char* kAllMessages =
    "SELECT topic_id, timestamp, data, id FROM messages ORDER BY timestamp, id";
constexpr const char* kOneMessage = "SELECT topic_id, timestamp, data, id FROM messages WHERE id = ?";
/// An id behind the last message is indistinguishable from one on a damaged page.
constexpr std::int64_t kMaxFailuresInARow = 100'000;

/// Passes on the messages of a database.
class DatabaseReader {
 public:
  DatabaseReader(const SqliteDatabase& database, const RosVisitor& visitor)
      : name_(database.name()), database_(database), visitor_(visitor) {}

  std::vector<std::string> read() {
    channels_ = read_topics_despite_damage();
    std::vector<std::string> warnings;
    if (const auto damage = take_rows()) {
      take_readable();
      if (taken_.empty()) throw InputError(*damage);
      warnings.push_back(name_ + ": the database is damaged (" + damage->reason() + "); " +
                         std::to_string(taken_.size()) + " messages are read, at least " +
                         std::to_string(missing_) + " between them are lost");
    }
    if (messages_.count() > 0) warnings.push_back(messages_.warning(name_, "message"));
    for (const std::string& encoding : foreign_)
      warnings.push_back(name_ + ": messages encoded as '" + encoding + "' are left out");
    return warnings;
  }

 private:
  /// SQLite opens a file that is shorter than it should be in a mode for repairs only.
  DatabaseChannels read_topics_despite_damage() {
    SkippedRecords damage;
    auto channels = damage.attempt([&] { return read_topics(database_, foreign_); });
    if (channels) return *channels;
    sqlite3_exec(database_.get(), "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
    SkippedRecords same;
    channels = same.attempt([&] { return read_topics(database_, foreign_); });
    if (!channels) damage.throw_first();
    return *channels;
  }

  /// Takes all rows, in the order of time; returns the error of the first one that cannot be read.
  std::optional<InputError> take_rows() {
    SqliteRows rows = database_.prepare(kAllMessages);
    for (int result = rows.step(); result != SQLITE_DONE; result = rows.step()) {
      if (result != SQLITE_ROW) return database_.error();
      take(rows);
    }
    return std::nullopt;
  }

  /// Of a damaged database, takes the rows that are left, one by one in the order of their ids.
  void take_readable() {
    std::vector<std::int64_t> earlier = taken_;
    std::sort(earlier.begin(), earlier.end());
    SqliteRows row = database_.prepare(kOneMessage);
    std::int64_t failures = 0;
    for (std::int64_t id = first_id(); failures < kMaxFailuresInARow; ++id) {
      const bool is_taken = std::binary_search(earlier.begin(), earlier.end(), id);
      row.reset();
      row.bind(1, id);
      if (!is_taken && row.step() != SQLITE_ROW) {
        ++failures;
        continue;
      }
      missing_ += std::exchange(failures, 0);
      if (!is_taken) take(row);
    }
  }

  std::int64_t first_id() const {
    SqliteRows row = database_.prepare("SELECT min(id) FROM messages");
    return row.step() == SQLITE_ROW ? row.integer(0) : 1;
  }

  void take(const SqliteRows& row) {
    taken_.push_back(row.integer(3));
    pass_on(row);
  }

  void pass_on(const SqliteRows& row) {
    const auto channel = channels_.find(row.integer(0));
    if (channel == channels_.end()) return;
    const Stamp stamp{row.integer(1)};
    const std::string_view bytes = visitor_.reads(channel->second) ? row.bytes(2) : std::string_view{};
    if (!bytes.starts_with(kZstdMagic)) return visitor_.take({channel->second, stamp, bytes, name_});
    const auto unpacked = messages_.attempt(
        [&] { return decompress_zstd(name_ + ": a message of " + channel->second.topic, bytes); });
    if (unpacked) visitor_.take({channel->second, stamp, *unpacked, name_});
  }

  const std::string& name_;
  const SqliteDatabase& database_;
  const RosVisitor& visitor_;
  DatabaseChannels channels_;
  std::set<std::string> foreign_;
  std::vector<std::int64_t> taken_;  ///< ids
  std::int64_t missing_ = 0;         ///< ids between others that cannot be read
  SkippedRecords messages_;
};

}  // namespace

std::vector<std::string> visit_ros_database(const std::filesystem::path& file, const RosVisitor& visitor) {
  const SqliteDatabase database = open_database(file);
  auto warnings = DatabaseReader(database, visitor).read();
  if (std::filesystem::exists(file.string() + "-wal"))
    warnings.push_back(file.string() + "-wal: data that are only in this journal are not read");
  return warnings;
}

std::vector<std::string> visit_ros_database(const std::string& name, std::string_view bytes,
                                            const RosVisitor& visitor) {
  const SqliteDatabase database(name, kRefusal, bytes);
  return DatabaseReader(database, visitor).read();
}

}  // namespace radioslam
