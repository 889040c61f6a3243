// Iteration over the access points that two fingerprints share.
#pragma once

#include "radioslam/radio/fingerprints/fingerprint.hpp"

namespace radioslam {

/// Calls both(a, b) with the two entries of every shared access point, in order.
template <class Both>
void for_each_shared(const Fingerprint& a, const Fingerprint& b, Both&& both) {
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
