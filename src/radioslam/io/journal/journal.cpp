#include "radioslam/io/journal/journal.hpp"

#include <sqlite3.h>
#include <zlib.h>

#include <algorithm>

#include "radioslam/base/little_endian.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kVersion = 1;
constexpr std::int64_t kApplication = 0x52534c4a;  // "RSLJ"

constexpr const char* kTables =
    "CREATE TABLE journal(robot TEXT NOT NULL, life INTEGER NOT NULL, crc INTEGER NOT NULL);"
    "CREATE TABLE records(robot TEXT NOT NULL, life INTEGER NOT NULL, number INTEGER NOT NULL,"
    " bytes BLOB NOT NULL, crc INTEGER NOT NULL, PRIMARY KEY(robot, life, number)) WITHOUT ROWID;"
    "CREATE TABLE state(key TEXT PRIMARY KEY, bytes BLOB NOT NULL, crc INTEGER NOT NULL);";
constexpr const char* kAllRecords =
    "SELECT robot, life, number, bytes, crc FROM records ORDER BY robot, life, number";

/// CRC-32 of a row: of its name, numbers and bytes.
std::int64_t row_checksum(std::string_view name, std::uint32_t life, std::uint64_t number,
                          std::string_view bytes) {
  std::string head(name);
  append_little_endian(head, life, sizeof(life));
  append_little_endian(head, number, sizeof(number));
  const auto add = [](uLong crc, std::string_view part) {
    return part.empty() ? crc : ::crc32_z(crc, reinterpret_cast<const Bytef*>(part.data()), part.size());
  };
  return static_cast<std::int64_t>(add(add(0, head), bytes));
}

std::uint32_t life_at(const SqliteRows& row, int column) {
  return static_cast<std::uint32_t>(row.integer(column));
}
std::uint64_t number_at(const SqliteRows& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

/// Is rolled back unless committed.
class Transaction {
 public:
  explicit Transaction(const SqliteDatabase& database) : database_(database) {
    database.execute("BEGIN IMMEDIATE");
  }
  ~Transaction() {
    const bool is_open = sqlite3_get_autocommit(database_.get()) == 0;  // some errors end it by themselves
    if (is_open) sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() const { database_.execute("COMMIT"); }

 private:
  const SqliteDatabase& database_;
};

}  // namespace

Journal::Journal(const std::filesystem::path& file, const std::string& robot, std::uint32_t life_if_new)
    : database_(file.string(), "the journal cannot be used", std::filesystem::absolute(file).string(),
                SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE),
      robot_(robot) {
  // Before the first read: the lock is kept from then on, and needs no file of shared memory.
  database_.execute("PRAGMA locking_mode = EXCLUSIVE");
  database_.execute("PRAGMA synchronous = FULL");
  const bool has_tables = database_.integer("SELECT count(*) FROM sqlite_master") > 0;
  const std::int64_t application = database_.integer("PRAGMA application_id");
  is_new_ = !has_tables && application == 0;
  if (!is_new_ && application != kApplication)
    refuse("this is no journal, but a database for something else");
  if (is_new_) create(robot, life_if_new);
  check_kind(robot);
  check_contents();
}

void Journal::create(const std::string& robot, std::uint32_t life) {
  database_.execute("PRAGMA journal_mode = WAL");
  const Transaction transaction(database_);
  database_.execute(kTables);
  database_.execute(("PRAGMA application_id = " + std::to_string(kApplication)).c_str());
  database_.execute(("PRAGMA user_version = " + std::to_string(kVersion)).c_str());
  SqliteRows owner = database_.prepare("INSERT INTO journal VALUES(?, ?, ?)");
  owner.bind_text(1, robot);
  owner.bind(2, life);
  owner.bind(3, row_checksum(robot, life, 0, {}));
  owner.next();
  transaction.commit();
}

void Journal::check_kind(const std::string& robot) {
  const std::int64_t version = database_.integer("PRAGMA user_version");
  if (version != kVersion)
    refuse("the journal has version " + std::to_string(version) + ", this program uses version " +
           std::to_string(kVersion));
  SqliteRows damage = database_.prepare("PRAGMA quick_check(1)");
  if (damage.next() && damage.text(0) != "ok") refuse("the journal is damaged: " + damage.text(0));
  SqliteRows owner = database_.prepare("SELECT robot, life, crc FROM journal");
  const bool is_owned = owner.next();
  if (is_owned) life_ = life_at(owner, 1);
  if (!is_owned || row_checksum(owner.text(0), life_, 0, {}) != owner.integer(2))
    refuse("the journal is damaged: whose it is cannot be read");
  if (owner.text(0) != robot) refuse("this is the journal of robot " + owner.text(0) + ", not of " + robot);
}

void Journal::check_contents() {
  SqliteRows rows = database_.prepare(kAllRecords);
  while (rows.next()) {
    const std::string robot = rows.text(0);
    const std::uint64_t number = number_at(rows, 2);
    if (row_checksum(robot, life_at(rows, 1), number, rows.bytes(3)) != rows.integer(4))
      refuse("the journal is damaged: record " + std::to_string(number) + " of robot " + robot +
             " is not what was written");
    if (robot != robot_ || life_at(rows, 1) != life_) continue;
    if (number != own_records_)
      refuse("the journal is damaged: record " + std::to_string(own_records_) + " is missing");
    ++own_records_;
  }
  SqliteRows state = database_.prepare("SELECT key, bytes, crc FROM state");
  while (state.next())
    if (row_checksum(state.text(0), 0, 0, state.bytes(1)) != state.integer(2))
      refuse("the journal is damaged: the state '" + state.text(0) + "' is not what was written");
}

std::vector<std::pair<std::string, KnownLog>> Journal::logs() const {
  std::vector<std::pair<std::string, KnownLog>> logs;
  SqliteRows rows = database_.prepare(kAllRecords);
  while (rows.next()) {
    std::string robot = rows.text(0);
    const std::uint32_t life = life_at(rows, 1);
    if (logs.empty() || logs.back().first != robot || logs.back().second.life != life)
      logs.emplace_back(std::move(robot), KnownLog{life, {}});
    auto& records = logs.back().second.records;
    records.emplace_hint(records.end(), number_at(rows, 2), std::string(rows.bytes(3)));
  }
  return logs;
}

std::optional<std::string> Journal::state(std::string_view key) const {
  SqliteRows rows = database_.prepare("SELECT bytes FROM state WHERE key = ?");
  rows.bind_text(1, key);
  if (!rows.next()) return std::nullopt;
  return std::string(rows.bytes(0));
}

void Journal::commit(const JournalChange& change) {
  const std::uint32_t life = change.life.value_or(life_);
  const std::uint64_t own_before = change.life ? 0 : own_records_;
  const Transaction transaction(database_);
  for (const std::string& robot : change.forgotten) forget(robot);
  if (change.life) begin_life(life);
  for (const JournalChange::Kept& kept : change.kept) keep(kept, life, own_before);
  if (change.first_own > own_before)
    refuse("record " + std::to_string(change.first_own) + " would leave a gap behind the " +
           std::to_string(own_before) + " that are known");
  const std::uint64_t own_records = std::max(own_before, change.first_own + change.own.size());
  keep({robot_, life, change.first_own, change.own}, life, own_records);
  for (const auto& [key, bytes] : change.state) set_state(key, bytes);
  transaction.commit();
  life_ = life;
  own_records_ = own_records;
}

void Journal::begin_life(std::uint32_t life) {
  if (life <= life_) refuse("life " + std::to_string(life) + " does not follow " + std::to_string(life_));
  SqliteRows removal = database_.prepare("DELETE FROM records WHERE robot = ? AND life = ?");
  removal.bind_text(1, robot_);
  removal.bind(2, life_);
  removal.next();
  SqliteRows owner = database_.prepare("UPDATE journal SET life = ?, crc = ?");
  owner.bind(1, life);
  owner.bind(2, row_checksum(robot_, life, 0, {}));
  owner.next();
}

void Journal::forget(const std::string& robot) {
  SqliteRows removal =
      database_.prepare("DELETE FROM records WHERE robot = ? AND NOT (robot = ? AND life = ?)");
  removal.bind_text(1, robot);
  removal.bind_text(2, robot_);
  removal.bind(3, life_);
  removal.next();
}

void Journal::keep(const JournalChange::Kept& kept, std::uint32_t life, std::uint64_t own_records) {
  const bool is_own = kept.robot == robot_ && kept.life == life;
  SqliteRows row = database_.prepare("INSERT OR IGNORE INTO records VALUES(?, ?, ?, ?, ?)");
  SqliteRows known =
      database_.prepare("SELECT bytes FROM records WHERE robot = ? AND life = ? AND number = ?");
  for (SqliteRows* rows : {&row, &known}) {
    rows->bind_text(1, kept.robot);
    rows->bind(2, kept.life);
  }
  std::uint64_t number = kept.first;
  for (const std::string& record : kept.records) {
    const std::string name = "record " + std::to_string(number) + " of robot " + kept.robot;
    if (is_own && number >= own_records) refuse(name + " is its own, but not from it");
    row.reset();
    row.bind(3, static_cast<std::int64_t>(number));
    row.bind_bytes(4, record);
    row.bind(5, row_checksum(kept.robot, kept.life, number, record));
    row.next();
    if (sqlite3_changes(database_.get()) == 0) {
      known.reset();
      known.bind(3, static_cast<std::int64_t>(number));
      if (!known.next() || known.bytes(0) != record) refuse(name + " is known with other contents");
    }
    ++number;
  }
}

void Journal::set_state(const std::string& key, const std::string& bytes) {
  SqliteRows row = database_.prepare("INSERT OR REPLACE INTO state VALUES(?, ?, ?)");
  row.bind_text(1, key);
  row.bind_bytes(2, bytes);
  row.bind(3, row_checksum(key, 0, 0, bytes));
  row.next();
}

void Journal::refuse(const std::string& reason) const { throw database_.error(reason); }

}  // namespace radioslam
