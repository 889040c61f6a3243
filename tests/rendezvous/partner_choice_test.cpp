#include "radioslam/rendezvous/partner_choice.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(PartnerChoice, DiscrepancyIsTheShareOfTheSignalThatIsMissing) {
  EXPECT_DOUBLE_EQ(service_discrepancy(25, 10, 1), 0.6);
  EXPECT_DOUBLE_EQ(service_discrepancy(25, 10, 2), 1.2);
  EXPECT_DOUBLE_EQ(service_discrepancy(25, 30, 1), 0);
  EXPECT_DOUBLE_EQ(service_discrepancy(25, -7, 1), 1);  // less than no signal counts as none
}

TEST(PartnerChoice, FollowsTheCallerItHearsBestAndOfEqualsTheOneInGreaterNeed) {
  EXPECT_EQ(best_caller({{"a", 20, 15}, {"b", 22, 11}}), "b");
  EXPECT_EQ(best_caller({{"a", 20, 15}, {"b", 20, 18}}), "b");
  EXPECT_EQ(best_caller({}), std::nullopt);
}

TEST(PartnerChoice, TakesTheSmallestDiscrepancyAndOfEqualsTheLowerError) {
  EXPECT_EQ(best_partner({{"a", 12, 1}, {"b", 20, 9}}, 25, 1), "b");
  // Beyond q all links are equal.
  EXPECT_EQ(best_partner({{"a", 40, 5}, {"b", 26, 2}}, 25, 1), "b");
}

TEST(PartnerChoice, MeetingALandmarkGainsTwiceWhatMeetingAnotherLostRobotDoesPerMetreTravelled) {
  EXPECT_DOUBLE_EQ(expected_gain(8, 0), 8);  // one has travelled
  EXPECT_DOUBLE_EQ(expected_gain(8, 8), 8);  // both have
  EXPECT_DOUBLE_EQ(expected_gain(0, 0), 0);
}

}  // namespace
}  // namespace radioslam
