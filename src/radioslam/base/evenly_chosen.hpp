// A share of a list, evenly spaced.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace radioslam {

/// At most `count` of the items, the first among them, in their order.
template <class T>
std::vector<T> evenly_chosen(std::vector<T> of, std::size_t count) {
  if (of.size() <= count) return of;
  std::vector<T> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(std::move(of[k * of.size() / count]));
  return chosen;
}

}  // namespace radioslam
