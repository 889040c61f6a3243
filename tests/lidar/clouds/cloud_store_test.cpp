#include "radioslam/lidar/clouds/cloud_store.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

/// Of 1,000 points in the plane x = k.
ScanPyramid cloud_at(int k) {
  ScanPyramid cloud;
  for (int n = 0; n < 1000; ++n)
    cloud.all.push_back(
        {Eigen::Vector3f(static_cast<float>(k), static_cast<float>(n % 31), 0.03F * static_cast<float>(n)),
         Eigen::Matrix3f::Identity()});
  cloud.median_range_m = k;
  return cloud;
}

/// $TMPDIR where nothing can be written, while it lives.
class NoTemporaryFolder {
 public:
  NoTemporaryFolder() { ::setenv("TMPDIR", "/does/not/exist", 1); }
  ~NoTemporaryFolder() { ::unsetenv("TMPDIR"); }
};

class CloudStoreOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Mebibytes, CloudStoreOf, ::testing::Values(0, 1, 64));

/// With 0 and 1 MiB, most of them come from the file.
TEST_P(CloudStoreOf, GivesEveryThreadTheSameClouds) {
  std::vector<StoredCloud> clouds;
  {
    CloudStore store({GetParam()});
    for (int k = 0; k < 300; ++k) clouds.push_back(store.add(cloud_at(k)));
  }
  const auto expected = CloudStore().add(cloud_at(0)).read();
  set_thread_count(4);
  parallel_for(1000, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const StoredCloud& cloud = clouds[7 * k % clouds.size()];
      const auto read = cloud.read();
      ASSERT_EQ(read->all.size(), 1000U);
      ASSERT_EQ(cloud.points(), 1000U);
      EXPECT_EQ(read->all[500].position.x(), static_cast<float>(cloud.median_range_m()));
      EXPECT_EQ(read->all[500].position.tail<2>(), expected->all[500].position.tail<2>());
      EXPECT_EQ(read->all[500].covariance, expected->all[500].covariance);
    }
  });
  set_thread_count(0);
}

TEST(CloudStore, SaysWhereItCannotWrite) {
  const NoTemporaryFolder nowhere;
  try {
    CloudStore({0}).add(cloud_at(0));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/does/not/exist"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("clouds.memory_mib"), std::string::npos) << error.what();
  }
}

TEST(CloudStore, ReusesTheMemoryOfForgottenClouds) {
  const NoTemporaryFolder nowhere;
  CloudStore store({1});
  for (int k = 0; k < 1000; ++k) EXPECT_NO_THROW(store.add(cloud_at(k)));
}

TEST(StoredCloud, IsEmptyWithoutPoints) {
  const NoTemporaryFolder nowhere;
  EXPECT_TRUE(StoredCloud().empty());
  EXPECT_TRUE(StoredCloud().read()->all.empty());
  EXPECT_TRUE(CloudStore({0}).add({}).empty());
}

}  // namespace
}  // namespace radioslam
