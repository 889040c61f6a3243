#include "radioslam/places/loops/kept_submaps.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostKept = 128;  // some megabytes each; then it starts anew

}  // namespace

std::shared_ptr<const Submap> KeptSubmaps::around(std::size_t k, const std::function<Submap()>& make) {
  std::shared_ptr<Place> place;
  {
    const std::lock_guard lock(mutex_);
    if (places_.size() == kMostKept && !places_.contains(k)) places_.clear();
    std::shared_ptr<Place>& kept = places_[k];
    if (!kept) kept = std::make_shared<Place>();
    place = kept;
  }
  std::call_once(place->is_made, [&] { place->submap = std::make_shared<const Submap>(make()); });
  return place->submap;
}

}  // namespace radioslam
