#include "radioslam/io/ros/ros_database.hpp"

#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/text/text.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

constexpr const char* kTables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
    "INSERT INTO topics VALUES (3, '/a', 'std_msgs/msg/String', 'cdr'), (4, '/b', 'x/msg/Y', 'proto'), "
    "(5, '/unread', 'nav_msgs/msg/Odometry', 'cdr');";

std::filesystem::path make_database(const TemporaryFolder& folder, const std::string& statements) {
  const auto path = folder.path() / "odd name #1?.db3";
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  EXPECT_EQ(sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
  return path;
}

std::string hexadecimal(const std::string& bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string out;
  for (const char c : bytes) out += {kDigits[static_cast<unsigned char>(c) >> 4U], kDigits[c & 0xf]};
  return "x'" + out + "'";
}

TEST(RosDatabase, ReadsMessagesInTheOrderOfTime) {
  const TemporaryFolder folder;
  std::string packed(ZSTD_compressBound(5), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), "later", 5, 1));
  const auto path = make_database(folder, std::string(kTables) + "INSERT INTO messages VALUES (1, 3, 20, " +
                                              hexadecimal(packed) +
                                              "), (2, 3, 10, x'6869'), (3, 4, 5, x'00'), (4, 5, 30, x'00');");
  NotedMessages noted;
  const auto warnings = visit_ros_database(path, noted.visitor());
  EXPECT_EQ(noted.lines, (std::vector<std::string>{"/a std_msgs/String 10 hi", "/a std_msgs/String 20 later",
                                                   "/unread nav_msgs/Odometry 30 "}));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("'proto' are left out"), std::string::npos);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1U) << "nothing is written beside it";
}

/// A thousand messages of 100 bytes, and their index by time.
std::filesystem::path make_long_database(const TemporaryFolder& folder) {
  std::string rows;
  for (int k = 1; k <= 1000; ++k)
    rows += "INSERT INTO messages VALUES (NULL, 3, " + std::to_string(k) + ", zeroblob(100));";
  return make_database(folder,
                       kTables + ("CREATE INDEX t ON messages(timestamp); BEGIN;" + rows) + "COMMIT;");
}

TEST(RosDatabase, ReadsWhatIsLeftOfADamagedOne) {
  const TemporaryFolder cut, holed, zeros;
  const auto half = make_long_database(cut);
  std::filesystem::resize_file(half, std::filesystem::file_size(half) / 2);
  const auto hole = make_long_database(holed);
  std::fstream file(hole, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096 * 12);
  file << std::string(4096 * 3, '\0');
  file.close();
  for (const auto& path : {half, hole}) {
    NotedMessages noted;
    const auto warnings = visit_ros_database(path, noted.visitor());
    EXPECT_GT(noted.lines.size(), 200U);
    EXPECT_LT(noted.lines.size(), 1000U);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE(warnings[0].find("the database is damaged"), std::string::npos) << warnings[0];
    std::sort(noted.lines.begin(), noted.lines.end());
    EXPECT_EQ(std::unique(noted.lines.begin(), noted.lines.end()), noted.lines.end()) << "none is read twice";
  }
  const auto empty = make_long_database(zeros);
  const std::string whole(std::filesystem::file_size(empty) - 4096 * 3, '\0');
  std::fstream rest(empty, std::ios::in | std::ios::out | std::ios::binary);
  rest.seekp(4096 * 3);
  rest << whole;
  rest.close();
  NotedMessages noted;
  expect_refusal([&] { visit_ros_database(empty, noted.visitor()); }, 0,
                 "cannot be read as a rosbag2 database");
}

TEST(RosDatabase, ReadsTheSameFromMemory) {
  const TemporaryFolder folder;
  const auto path = make_long_database(folder);
  NotedMessages file, memory;
  visit_ros_database(path, file.visitor());
  visit_ros_database("x.db3.zstd", read_bytes(path), memory.visitor());
  EXPECT_EQ(file.lines, memory.lines);
}

TEST(RosDatabase, RefusesOtherTables) {
  const TemporaryFolder folder;
  NotedMessages noted;
  const auto other = make_database(folder, "CREATE TABLE x(y);");
  expect_refusal([&] { visit_ros_database(other, noted.visitor()); }, 0, "no such table: topics");
  // SQLite's error message for an invalid schema has two lines.
  const TemporaryFolder odd;
  const auto schema =
      make_database(odd,
                    "CREATE TABLE topics(id); PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = "
                    "'CREATE TABLE topics(id ' || char(96, 10) || '   q';");
  const std::string words = refusal([&] { visit_ros_database(schema, noted.visitor()); });
  EXPECT_NE(words.find("` q"), std::string::npos) << words;
  EXPECT_EQ(words.find('\n'), std::string::npos) << words;
}

}  // namespace
}  // namespace radioslam
