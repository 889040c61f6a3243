#include "radioslam/io/dds/dds_endpoint.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

DdsEndpoint odometry(bool is_own) {
  DdsEndpoint endpoint;
  endpoint.topic = "rt/odom";
  endpoint.type = "nav_msgs::msg::dds_::Odometry_";
  endpoint.is_own = is_own;
  return endpoint;
}

class DdsMismatch : public testing::Test {
 protected:
  DdsEndpoint writer_ = odometry(false), reader_ = odometry(true);
};

TEST_F(DdsMismatch, NothingToSayWhereSamplesPass) {
  EXPECT_EQ(mismatch(writer_, reader_), "");
  writer_.reliability = DdsReliability::kReliable;
  writer_.durability = DdsDurability::kTransientLocal;
  writer_.deadline_ns = 1'000'000;
  EXPECT_EQ(mismatch(writer_, reader_), "") << "more is offered than asked for";
}

TEST_F(DdsMismatch, OtherTopicsAndStrangersAmongThemselvesAreNobodysBusiness) {
  writer_.type = "x";
  reader_.is_own = false;
  EXPECT_EQ(mismatch(writer_, reader_), "");
  reader_ = odometry(true);
  reader_.topic = "rt/odometry";
  EXPECT_EQ(mismatch(writer_, reader_), "");
}

TEST_F(DdsMismatch, NamesBothTypes) {
  writer_.type = "geometry_msgs::msg::dds_::PoseStamped_";
  EXPECT_EQ(
      mismatch(writer_, reader_),
      "topic /odom: a publisher sends geometry_msgs/msg/PoseStamped, this robot reads nav_msgs/msg/Odometry; "
      "nothing passes");
  std::swap(writer_.is_own, reader_.is_own);
  EXPECT_EQ(mismatch(writer_, reader_),
            "topic /odom: this robot sends geometry_msgs/msg/PoseStamped, a subscriber reads "
            "nav_msgs/msg/Odometry; "
            "nothing passes");
}

TEST_F(DdsMismatch, NamesEachPolicyWithWhatIsOfferedAndAskedFor) {
  reader_.reliability = DdsReliability::kReliable;
  EXPECT_EQ(mismatch(writer_, reader_),
            "topic /odom: reliability: a publisher offers best effort, this robot asks for reliable; nothing "
            "passes");
  reader_ = odometry(true);
  reader_.durability = DdsDurability::kTransientLocal;
  reader_.deadline_ns = 100'000'000;
  EXPECT_EQ(mismatch(writer_, reader_),
            "topic /odom: durability: a publisher offers volatile, this robot asks for transient local; "
            "deadline: a "
            "publisher offers none, this robot asks for 100 ms; nothing passes");
}

TEST_F(DdsMismatch, ARepresentationTheReaderDoesNotKnow) {
  writer_.representations = {2};
  reader_.representations = {0};
  EXPECT_NE(mismatch(writer_, reader_).find("data representation: a publisher offers XCDR 2"),
            std::string::npos);
  reader_.representations = {0, 2};
  EXPECT_EQ(mismatch(writer_, reader_), "");
}

}  // namespace
}  // namespace radioslam
