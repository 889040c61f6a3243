#include "radioslam/places/loops/kept_submaps.hpp"

#include <algorithm>

namespace radioslam {
namespace {

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

}  // namespace

std::shared_ptr<const Submap> KeptSubmaps::around(std::size_t k, const std::function<Submap()>& make) {
  std::shared_ptr<Place> place;
  {
    const std::lock_guard lock(mutex_);
    std::shared_ptr<Place>& kept = places_[k];
    if (!kept) kept = std::make_shared<Place>();
    kept->last_use = ++uses_;
    place = kept;
  }
  std::call_once(place->is_made, [&] {
    place->submap = std::make_shared<const Submap>(make());
    const std::lock_guard lock(mutex_);
    place->bytes = place->submap->bytes();
    bytes_ += place->bytes;
    forget_beyond_bound();
  });
  return place->submap;
}

void KeptSubmaps::forget_beyond_bound() {
  while (bytes_ > kMostBytes) {
    const auto oldest = std::min_element(places_.begin(), places_.end(), [](const auto& a, const auto& b) {
      const auto rank = [](const Place& place) { return std::pair(place.bytes == 0, place.last_use); };
      return rank(*a.second) < rank(*b.second);
    });
    bytes_ -= oldest->second->bytes;
    places_.erase(oldest);
  }
}

}  // namespace radioslam
