#include "radioslam/study/wi_closure/place_settings.hpp"

namespace radioslam {
namespace {

constexpr int kDiscoRings = 64, kDiscoSectors = 60, kDiscoNearestKeys = 50;
constexpr double kDiscoDistance = 0.2, kLoosenedDistance = 1;
constexpr int kDiscoCandidates = 1, kLoosenedCandidates = 10;
constexpr double kDiscoThreshold = 100, kLoosenedThreshold = 20;
constexpr int kDiscoMinMatches = 5;

}  // namespace

PlaceParams place_params(PlaceSettings settings, double lidar_range_m) {
  PlaceParams params;
  if (settings == PlaceSettings::kDefaults) return params;
  const bool loosened = settings == PlaceSettings::kLoosenedDisco;
  params.rounds = 1;
  params.candidates = loosened ? kLoosenedCandidates : kDiscoCandidates;
  params.max_descriptor_distance = loosened ? kLoosenedDistance : kDiscoDistance;
  params.descriptors.context.rings = kDiscoRings;
  params.descriptors.context.sectors = kDiscoSectors;
  params.descriptors.context.max_range_m = lidar_range_m;
  params.descriptors.index.key = "ring";
  params.descriptors.index.nearest_keys = kDiscoNearestKeys;
  return params;
}

ConsistencyParams consistency_params(PlaceSettings settings) {
  ConsistencyParams params;
  if (settings == PlaceSettings::kDefaults) return params;
  params.covariance = "identity";
  params.threshold = settings == PlaceSettings::kLoosenedDisco ? kLoosenedThreshold : kDiscoThreshold;
  params.min_matches = kDiscoMinMatches;
  return params;
}

const char* word_for(PlaceSettings settings) {
  switch (settings) {
    case PlaceSettings::kDefaults:
      return "defaults";
    case PlaceSettings::kDisco:
      return "DiSCo-SLAM";
    case PlaceSettings::kLoosenedDisco:
      return "loosened";
  }
  return "";
}

}  // namespace radioslam
