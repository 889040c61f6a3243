#include "radioslam/study/wi_closure/place_settings.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(PlaceSettings, AreThoseOfTheThesis) {
  const PlaceParams original = place_params(PlaceSettings::kDisco, 10),
                    loosened = place_params(PlaceSettings::kLoosenedDisco, 10);
  EXPECT_EQ(original.rounds, 1);
  EXPECT_EQ(original.candidates, 1);
  EXPECT_EQ(original.max_descriptor_distance, 0.2);
  EXPECT_EQ(original.descriptors.context.rings, 64);
  EXPECT_EQ(original.descriptors.context.sectors, 60);
  EXPECT_EQ(original.descriptors.context.max_range_m, 10);
  EXPECT_EQ(original.descriptors.index.key, "ring");
  EXPECT_EQ(original.descriptors.index.nearest_keys, 50);
  EXPECT_EQ(loosened.candidates, 10);
  EXPECT_EQ(loosened.max_descriptor_distance, 1);
  EXPECT_EQ(place_params(PlaceSettings::kDefaults, 10).candidates, PlaceParams{}.candidates);
  EXPECT_EQ(consistency_params(PlaceSettings::kDefaults).covariance, "odometry");
  for (const auto settings : {PlaceSettings::kDisco, PlaceSettings::kLoosenedDisco}) {
    EXPECT_EQ(consistency_params(settings).covariance, "identity");
    EXPECT_EQ(consistency_params(settings).threshold, settings == PlaceSettings::kDisco ? 100 : 20);
    EXPECT_EQ(consistency_params(settings).min_matches, 5);
  }
  EXPECT_EQ(consistency_params(PlaceSettings::kDisco).threshold, 100);
  EXPECT_EQ(consistency_params(PlaceSettings::kLoosenedDisco).threshold, 20);
  EXPECT_TRUE(has_unit_weights(consistency_params(PlaceSettings::kDisco)));
  EXPECT_FALSE(has_unit_weights(consistency_params(PlaceSettings::kDefaults)));
}

}  // namespace
}  // namespace radioslam
