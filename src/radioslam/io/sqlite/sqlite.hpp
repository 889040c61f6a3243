// SQLite databases, read and written by plain statements. Each error is an InputError of one line:
//   "<name>: <refusal>: <SQLite's message>"
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "radioslam/base/input_error.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace radioslam {

/// The rows of a statement; none for one that returns nothing. Must not outlive its database.
class SqliteRows;

class SqliteDatabase {
 public:
  /// Opens a file by its path or a URI with SQLite's flags (SQLITE_OPEN_...).
  SqliteDatabase(std::string name, std::string refusal, const std::string& path_or_uri, int flags);
  /// The bytes of a database, only to be read; they must outlive it.
  SqliteDatabase(std::string name, std::string refusal, std::string_view bytes);

  SqliteRows prepare(const char* statement) const;
  void execute(const char* statement) const;
  /// Of a statement with one row and one column.
  std::int64_t integer(const char* query) const;

  /// What went wrong in the last call.
  InputError error() const;
  /// Of this database, for another reason, in one line.
  InputError error(std::string reason) const;
  sqlite3* get() const { return database_.get(); }
  const std::string& name() const { return name_; }

 private:
  void open(const std::string& path_or_uri, int flags);

  std::string name_, refusal_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

class SqliteRows {
 public:
  SqliteRows(const SqliteDatabase& database, const char* statement);

  /// Advances to the next row; false after the last one.
  bool next();
  /// As `next`, with SQLite's result in place of an error.
  int step();
  /// Back to the beginning, for the next parameters.
  void reset();

  /// Parameters count from 1. Bytes must stay until the statement is reset.
  void bind(int parameter, std::int64_t value);
  void bind_text(int parameter, std::string_view text);
  void bind_bytes(int parameter, std::string_view bytes);

  /// Columns count from 0. Bytes are valid until the next row.
  std::int64_t integer(int column) const;
  std::string text(int column) const;
  std::string_view bytes(int column) const;

 private:
  const SqliteDatabase* database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

}  // namespace radioslam
