// The policy of importers of other tools' files: which records are left out, and when a file is refused.
//
// A bad record (also a bad file of several, a scan whose time cannot be read) is left out, counted, and named
// in a note with file and line of the first one. Rows that are stamped out of order by at most
// kLargestDisorder_s are sorted. Control characters and encodings cost at most the record that has them
// (read_tool_output). A file is refused where it cannot be trusted as a whole: nothing in it can be used, or
// more records are bad than good. Mission files are not read with this policy: there every record counts.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/stamp.hpp"

namespace radioslam {

/// Counts the records of a file that were refused, and keeps the error of the first one.
class SkippedRecords {
 public:
  void add(const InputError& error) {
    if (!first_) first_ = error;
    ++count_;
  }
  /// What `read` returns, or nothing (false of a `read` without result) if it throws InputError, which is
  /// added.
  template <class Read>
  auto attempt(Read&& read) {
    using Result = decltype(read());
    try {
      if constexpr (std::is_void_v<Result>) {
        read();
        return true;
      } else {
        return std::optional<Result>(read());
      }
    } catch (const InputError& error) {
      add(error);
      if constexpr (std::is_void_v<Result>)
        return false;
      else
        return std::optional<Result>();
    }
  }
  std::size_t count() const { return count_; }
  /// Throws the first error, if any; for files without a single usable record.
  void throw_first() const {
    if (first_) throw InputError(*first_);
  }
  /// "x.csv: 3 lines are left out; the first: x.csv:7: the list of values is not closed"; `part` is "line".
  std::string warning(const std::string& name, const std::string& part) const {
    return name + ": " + std::to_string(count_) + " " + part + (count_ == 1 ? " is" : "s are") +
           " left out; the first: " + first_->what();
  }
  /// Throws the first error if more records were refused than `used`; otherwise adds the warning, if any.
  void conclude(const std::string& name, const std::string& part, std::size_t used,
                std::vector<std::string>& warnings) const {
    if (count_ > used) throw_first();
    if (count_ > 0) warnings.push_back(warning(name, part));
  }

 private:
  std::optional<InputError> first_;
  std::size_t count_ = 0;
};

/// Counts the measured values per shape of packets; a capture keeps the packets of one shape only.
template <class Shape>
class MeasuredShapes {
 public:
  void add(const Shape& shape, std::size_t values) { values_[shape] += values; }
  bool empty() const { return values_.empty(); }
  /// The shape with the most values; the first in order among equals.
  const Shape& most_frequent() const {
    auto best = values_.begin();
    for (auto it = values_.begin(); it != values_.end(); ++it)
      if (it->second > best->second) best = it;
    return best->first;
  }

 private:
  std::map<Shape, std::size_t> values_;
};

// Rows of a log in the order of their times.

/// Indices of the most rows, in their order, whose times strictly increase; what a log keeps if a few rows
/// were stamped early, late or twice. Of rows with the same time, the first. O(n log n).
std::vector<std::size_t> rows_in_time_order(std::span<const Stamp> stamps);

/// Loggers with several threads write rows some milliseconds late; a clock that jumps errs by more.
inline constexpr double kLargestDisorder_s = 1;

/// Indices of rows sorted by time, and of those left out.
struct SortedRows {
  std::vector<std::size_t> kept;     ///< times do not decrease; equal ones in the order of the file
  std::vector<std::size_t> outside;  ///< earlier or later than their neighbours by more than the disorder
  std::size_t moved = 0;             ///< kept rows that were not in order
};
/// Sorts rows that are out of order by at most kLargestDisorder_s. The others are those that differ by more
/// from the neighbouring rows of rows_in_time_order.
SortedRows sort_rows_by_time(std::span<const Stamp> stamps);

/// Sorts records by `stamp_of`; those outside are counted as `refusal(index)`, an InputError. Returns how
/// many were moved.
template <class Record, class StampOf, class Refusal>
std::size_t sort_records(std::vector<Record>& records, const StampOf& stamp_of, const Refusal& refusal,
                         SkippedRecords& skipped) {
  std::vector<Stamp> stamps;
  for (const Record& record : records) stamps.push_back(stamp_of(record));
  const SortedRows rows = sort_rows_by_time(stamps);
  for (const std::size_t row : rows.outside) skipped.add(refusal(row));
  if (rows.moved == 0 && rows.outside.empty()) return 0;
  std::vector<Record> sorted;
  for (const std::size_t row : rows.kept) sorted.push_back(std::move(records[row]));
  records = std::move(sorted);
  return rows.moved;
}

}  // namespace radioslam
