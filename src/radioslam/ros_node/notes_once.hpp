// What the user should know, no line twice.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace radioslam {

class NotesOnce {
 public:
  void say(const std::string& line) {
    if (known_.size() < kMost && known_.insert(line).second) pending_.push_back(line);
  }
  /// `detail` differs from time to time, and is said with the first of these lines.
  void say(const std::string& line, const std::string& detail) {
    if (known_.size() < kMost && known_.insert(line).second) pending_.push_back(line + detail);
  }
  /// Since the last call.
  std::vector<std::string> take() { return std::exchange(pending_, {}); }

 private:
  static constexpr std::size_t kMost = 1000;  // names come from others

  std::set<std::string> known_;
  std::vector<std::string> pending_;
};

}  // namespace radioslam
