// Numbering of antenna pairs between which ranges were measured, independent of their order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace radioslam {

class AntennaPairs {
 public:
  /// Appends each new pair to `names`.
  explicit AntennaPairs(std::vector<std::pair<std::string, std::string>>& names) : names_(names) {}

  std::size_t index_of(const std::string& i, const std::string& j) {
    const auto [entry, added] = indices_.try_emplace(std::minmax(i, j), names_.size());
    if (added) names_.push_back(entry->first);
    return entry->second;
  }

 private:
  std::vector<std::pair<std::string, std::string>>& names_;
  std::map<std::pair<std::string, std::string>, std::size_t> indices_;
};

}  // namespace radioslam
