// What two fingerprints heard both.
#pragma once

#include "radioslam/radio/fingerprint.hpp"

namespace radioslam {

/// Calls both(a, b) with the two entries of every access point that both hear, in their order.
template <class Both>
void walk_shared(const Fingerprint& a, const Fingerprint& b, Both&& both) {
  auto i = a.entries.begin();
  auto j = b.entries.begin();
  while (i != a.entries.end() && j != b.entries.end()) {
    if (i->access_point < j->access_point) {
      ++i;
    } else if (j->access_point < i->access_point) {
      ++j;
    } else {
      both(*i++, *j++);
    }
  }
}

}  // namespace radioslam
