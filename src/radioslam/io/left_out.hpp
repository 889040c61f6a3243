// What a tolerant reader left out, and what it chose to keep.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "radioslam/base/input_error.hpp"

namespace radioslam {

/// Counts the parts of a file that were refused one by one, and remembers why the first was.
class LeftOut {
 public:
  void add(const InputError& error) {
    if (!first_) first_ = error;
    ++count_;
  }
  std::size_t count() const { return count_; }
  /// Of a file with nothing in it that can be used: throws the first refusal, if there was one.
  void throw_first() const {
    if (first_) throw InputError(*first_);
  }
  /// "x.csv: 3 lines are left out; the first: x.csv:7: the list of values has no end"
  std::string warning(const std::string& name, const std::string& parts) const {
    return name + ": " + std::to_string(count_) + " " + parts + " left out; the first: " + first_->what();
  }

 private:
  std::optional<InputError> first_;
  std::size_t count_ = 0;
};

/// How many values were measured in every shape that packets have; a capture keeps one shape.
template <class Shape>
class MeasuredShapes {
 public:
  void add(const Shape& shape, std::size_t values) { values_[shape] += values; }
  bool empty() const { return values_.empty(); }
  /// The shape with most values, the first in order among equals.
  const Shape& most_measured() const {
    auto best = values_.begin();
    for (auto it = values_.begin(); it != values_.end(); ++it)
      if (it->second > best->second) best = it;
    return best->first;
  }

 private:
  std::map<Shape, std::size_t> values_;
};

}  // namespace radioslam
