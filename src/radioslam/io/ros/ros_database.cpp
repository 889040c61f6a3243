#include "radioslam/io/ros/ros_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/skipped_records.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// SQLite's error message, in one line.
InputError database_error(const std::string& name, sqlite3* database) {
  std::string reason = sqlite3_errmsg(database);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  reason.erase(std::unique(reason.begin(), reason.end(), both_blank), reason.end());
  return InputError(name, 0, "cannot be read as a rosbag2 database: " + reason);
}

[[noreturn]] void fail_with_database(const std::string& name, sqlite3* database) {
  throw database_error(name, database);
}

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
Database open_database(const std::filesystem::path& file) {
  sqlite3* opened = nullptr;
  const std::string uri = "file:" + escaped(std::filesystem::absolute(file).string()) + "?immutable=1";
  const int result = sqlite3_open_v2(uri.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database(opened, &sqlite3_close);
  if (result != SQLITE_OK) fail_with_database(file.string(), opened);
  return database;
}

/// Opens the bytes of a database, which must outlive it.
Database open_bytes(const std::string& name, std::string_view bytes) {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open(":memory:", &opened);
  Database database(opened, &sqlite3_close);
  if (result != SQLITE_OK) fail_with_database(name, opened);
  auto* data = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));  // read-only below
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(opened, "main", data, size, size, SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    fail_with_database(name, opened);
  return database;
}

Statement prepare(const std::string& name, sqlite3* database, const char* query) {
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(database, query, -1, &prepared, nullptr) != SQLITE_OK)
    fail_with_database(name, database);
  return {prepared, &sqlite3_finalize};
}

/// Advances to the next row; false after the last one.
bool next_row(const std::string& name, sqlite3* database, sqlite3_stmt* statement) {
  const int result = sqlite3_step(statement);
  if (result != SQLITE_ROW && result != SQLITE_DONE) fail_with_database(name, database);
  return result == SQLITE_ROW;
}

std::string text_at(sqlite3_stmt* row, int column) {
  const unsigned char* text = sqlite3_column_text(row, column);
  return text == nullptr ? std::string{} : std::string(reinterpret_cast<const char*>(text));
}

/// Valid until the next row.
std::string_view bytes_at(sqlite3_stmt* row, int column) {
  const void* bytes = sqlite3_column_blob(row, column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
  return bytes == nullptr ? std::string_view{} : std::string_view(static_cast<const char*>(bytes), size);
}

using DatabaseChannels = std::map<std::int64_t, RosChannel>;

/// The definitions of types, where the recorder wrote them.
std::map<std::string, std::string> read_definitions(sqlite3* database) {
  std::map<std::string, std::string> definitions;
  sqlite3_stmt* prepared = nullptr;
  constexpr const char* kQuery =
      "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions";
  if (sqlite3_prepare_v2(database, kQuery, -1, &prepared, nullptr) != SQLITE_OK) return definitions;
  const Statement rows(prepared, &sqlite3_finalize);
  while (sqlite3_step(rows.get()) == SQLITE_ROW)
    if (text_at(rows.get(), 1) == "ros2msg")
      definitions[short_type(text_at(rows.get(), 0))] = text_at(rows.get(), 2);
  return definitions;
}

/// The topics whose messages are in CDR; other encodings are added to `foreign`.
DatabaseChannels read_topics(const std::string& name, sqlite3* database, std::set<std::string>& foreign) {
  DatabaseChannels channels;
  const auto definitions = read_definitions(database);
  const Statement rows = prepare(name, database, "SELECT id, name, type, serialization_format FROM topics");
  while (next_row(name, database, rows.get())) {
    const std::string encoding = text_at(rows.get(), 3);
    if (encoding != "cdr") {
      foreign.insert(encoding);
      continue;
    }
    const std::string type = short_type(text_at(rows.get(), 2));
    const auto definition = definitions.find(type);
    channels[sqlite3_column_int64(rows.get(), 0)] = {
        text_at(rows.get(), 1), type, MessageEncoding::kCdr,
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
  DatabaseReader(const std::string& name, sqlite3* database, const RosVisitor& visitor)
      : name_(name), database_(database), visitor_(visitor) {}

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
    auto channels = damage.attempt([&] { return read_topics(name_, database_, foreign_); });
    if (channels) return *channels;
    sqlite3_exec(database_, "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
    SkippedRecords same;
    channels = same.attempt([&] { return read_topics(name_, database_, foreign_); });
    if (!channels) damage.throw_first();
    return *channels;
  }

  /// Takes all rows, in the order of time; returns the error of the first one that cannot be read.
  std::optional<InputError> take_rows() {
    const Statement rows = prepare(name_, database_, kAllMessages);
    for (int result = sqlite3_step(rows.get()); result != SQLITE_DONE; result = sqlite3_step(rows.get())) {
      if (result != SQLITE_ROW) return database_error(name_, database_);
      take(rows.get());
    }
    return std::nullopt;
  }

  /// Of a damaged database, takes the rows that are left, one by one in the order of their ids.
  void take_readable() {
    std::vector<std::int64_t> earlier = taken_;
    std::sort(earlier.begin(), earlier.end());
    const Statement row = prepare(name_, database_, kOneMessage);
    std::int64_t failures = 0;
    for (std::int64_t id = first_id(); failures < kMaxFailuresInARow; ++id) {
      const bool is_taken = std::binary_search(earlier.begin(), earlier.end(), id);
      sqlite3_reset(row.get());
      sqlite3_bind_int64(row.get(), 1, id);
      if (!is_taken && sqlite3_step(row.get()) != SQLITE_ROW) {
        ++failures;
        continue;
      }
      missing_ += std::exchange(failures, 0);
      if (!is_taken) take(row.get());
    }
  }

  std::int64_t first_id() const {
    const Statement row = prepare(name_, database_, "SELECT min(id) FROM messages");
    return sqlite3_step(row.get()) == SQLITE_ROW ? sqlite3_column_int64(row.get(), 0) : 1;
  }

  void take(sqlite3_stmt* row) {
    taken_.push_back(sqlite3_column_int64(row, 3));
    pass_on(row);
  }

  void pass_on(sqlite3_stmt* row) {
    const auto channel = channels_.find(sqlite3_column_int64(row, 0));
    if (channel == channels_.end()) return;
    const Stamp stamp{sqlite3_column_int64(row, 1)};
    const std::string_view bytes = visitor_.reads(channel->second) ? bytes_at(row, 2) : std::string_view{};
    if (!bytes.starts_with(kZstdMagic)) return visitor_.take({channel->second, stamp, bytes, name_});
    const auto unpacked = messages_.attempt(
        [&] { return decompress_zstd(name_ + ": a message of " + channel->second.topic, bytes); });
    if (unpacked) visitor_.take({channel->second, stamp, *unpacked, name_});
  }

  const std::string& name_;
  sqlite3* database_;
  const RosVisitor& visitor_;
  DatabaseChannels channels_;
  std::set<std::string> foreign_;
  std::vector<std::int64_t> taken_;  ///< ids
  std::int64_t missing_ = 0;         ///< ids between others that cannot be read
  SkippedRecords messages_;
};

}  // namespace

std::vector<std::string> visit_ros_database(const std::filesystem::path& file, const RosVisitor& visitor) {
  const std::string name = file.string();
  const Database database = open_database(file);
  auto warnings = DatabaseReader(name, database.get(), visitor).read();
  if (std::filesystem::exists(name + "-wal"))
    warnings.push_back(name + "-wal: data that are only in this journal are not read");
  return warnings;
}

std::vector<std::string> visit_ros_database(const std::string& name, std::string_view bytes,
                                            const RosVisitor& visitor) {
  const Database database = open_bytes(name, bytes);
  return DatabaseReader(name, database.get(), visitor).read();
}

}  // namespace radioslam
