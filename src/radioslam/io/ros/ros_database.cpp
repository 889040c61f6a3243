#include "radioslam/io/ros/ros_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// Throws SQLite's error message, in one line.
[[noreturn]] void fail_with_database(const std::string& name, sqlite3* database) {
  std::string reason = sqlite3_errmsg(database);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  reason.erase(std::unique(reason.begin(), reason.end(), both_blank), reason.end());
  throw InputError(name, 0, "cannot be read as a rosbag2 database: " + reason);
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

/// The topics whose messages are in CDR; other encodings are added to `foreign`.
DatabaseChannels read_topics(const std::string& name, sqlite3* database, std::set<std::string>& foreign) {
  DatabaseChannels channels;
  const Statement rows = prepare(name, database, "SELECT id, name, type, serialization_format FROM topics");
  while (next_row(name, database, rows.get())) {
    const std::string encoding = text_at(rows.get(), 3);
    if (encoding != "cdr")
      foreign.insert(encoding);
    else
      channels[sqlite3_column_int64(rows.get(), 0)] = {
          text_at(rows.get(), 1), short_type(text_at(rows.get(), 2)), MessageEncoding::kCdr};
  }
  return channels;
}

void take_row(const std::string& name, sqlite3_stmt* row, const RosChannel& channel,
              const RosVisitor& visitor) {
  const Stamp stamp{sqlite3_column_int64(row, 1)};
  const std::string_view bytes = visitor.reads(channel) ? bytes_at(row, 2) : std::string_view{};
  if (!bytes.starts_with(kZstdMagic)) return visitor.take({channel, stamp, bytes, name});
  const std::string unpacked = decompress_zstd(name + ": a message of " + channel.topic, bytes);
  visitor.take({channel, stamp, unpacked, name});
}

}  // namespace

std::vector<std::string> visit_ros_database(const std::filesystem::path& file, const RosVisitor& visitor) {
  const std::string name = file.string();
  const Database database = open_database(file);
  std::set<std::string> foreign;
  const DatabaseChannels channels = read_topics(name, database.get(), foreign);
  const Statement rows =
      prepare(name, database.get(), "SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  while (next_row(name, database.get(), rows.get()))
    if (const auto channel = channels.find(sqlite3_column_int64(rows.get(), 0)); channel != channels.end())
      take_row(name, rows.get(), channel->second, visitor);
  std::vector<std::string> warnings;
  if (std::filesystem::exists(name + "-wal"))
    warnings.push_back(name + "-wal: data that are only in this journal are not read");
  for (const std::string& encoding : foreign)
    warnings.push_back(name + ": messages encoded as '" + encoding + "' are left out");
  return warnings;
}

}  // namespace radioslam
