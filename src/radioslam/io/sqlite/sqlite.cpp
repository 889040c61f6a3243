#include "radioslam/io/sqlite/sqlite.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace radioslam {

SqliteDatabase::SqliteDatabase(std::string name, std::string refusal, const std::string& path_or_uri,
                               int flags)
    : name_(std::move(name)), refusal_(std::move(refusal)), database_(nullptr, &sqlite3_close) {
  open(path_or_uri, flags);
}

SqliteDatabase::SqliteDatabase(std::string name, std::string refusal, std::string_view bytes)
    : name_(std::move(name)), refusal_(std::move(refusal)), database_(nullptr, &sqlite3_close) {
  open(":memory:", SQLITE_OPEN_READWRITE);
  auto* data = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));  // read-only below
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(get(), "main", data, size, size, SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    throw error();
}

void SqliteDatabase::open(const std::string& path_or_uri, int flags) {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open_v2(path_or_uri.c_str(), &opened, flags, nullptr);
  database_.reset(opened);
  if (result != SQLITE_OK) throw error();
}

SqliteRows SqliteDatabase::prepare(const char* statement) const { return {*this, statement}; }

void SqliteDatabase::execute(const char* statement) const {
  if (sqlite3_exec(get(), statement, nullptr, nullptr, nullptr) != SQLITE_OK) throw error();
}

std::int64_t SqliteDatabase::integer(const char* query) const {
  SqliteRows rows = prepare(query);
  return rows.next() ? rows.integer(0) : 0;
}

InputError SqliteDatabase::error() const {
  const int code = sqlite3_errcode(get());
  if (code == SQLITE_BUSY) return error(refusal_ + ": it is in use by another process");
  const int system = code == SQLITE_CANTOPEN ? sqlite3_system_errno(get()) : 0;
  const std::string why = system == 0 ? "" : " (" + std::generic_category().message(system) + ")";
  return error(refusal_ + ": " + sqlite3_errmsg(get()) + why);
}

InputError SqliteDatabase::error(std::string reason) const {
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  reason.erase(std::unique(reason.begin(), reason.end(), both_blank), reason.end());
  return InputError(name_, 0, reason);
}

SqliteRows::SqliteRows(const SqliteDatabase& database, const char* statement)
    : database_(&database), statement_(nullptr, &sqlite3_finalize) {
  sqlite3_stmt* prepared = nullptr;
  const int result = sqlite3_prepare_v2(database.get(), statement, -1, &prepared, nullptr);
  statement_.reset(prepared);
  if (result != SQLITE_OK) throw database.error();
}

bool SqliteRows::next() {
  const int result = step();
  if (result != SQLITE_ROW && result != SQLITE_DONE) throw database_->error();
  return result == SQLITE_ROW;
}

int SqliteRows::step() { return sqlite3_step(statement_.get()); }

void SqliteRows::reset() { sqlite3_reset(statement_.get()); }

void SqliteRows::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter, value);
}

void SqliteRows::bind_text(int parameter, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), parameter, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
}

void SqliteRows::bind_bytes(int parameter, std::string_view bytes) {
  // No bytes are a value as well, a null pointer would be none.
  sqlite3_bind_blob64(statement_.get(), parameter, bytes.empty() ? "" : bytes.data(), bytes.size(),
                      SQLITE_STATIC);
}

std::int64_t SqliteRows::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

std::string SqliteRows::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  return text == nullptr ? std::string{} : std::string(reinterpret_cast<const char*>(text));
}

std::string_view SqliteRows::bytes(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
  return bytes == nullptr ? std::string_view{} : std::string_view(static_cast<const char*>(bytes), size);
}

}  // namespace radioslam
