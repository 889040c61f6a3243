// Bookkeeping of tolerant readers: records that were skipped, and the shape of record to keep.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
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
  /// What `read` returns, or nothing if it throws InputError, which is added.
  template <class Read>
  auto attempt(Read read) -> std::optional<decltype(read())> {
    try {
      return read();
    } catch (const InputError& error) {
      add(error);
      return std::nullopt;
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

// Rows of a log in the order of their times: the longest strictly increasing subsequence of their stamps.

/// Indices of the most rows, in their order, whose times strictly increase; what a log keeps if a few rows
/// were stamped early, late or twice. Of rows with the same time, the first. O(n log n).
std::vector<std::size_t> rows_in_time_order(std::span<const Stamp> stamps);

}  // namespace radioslam
