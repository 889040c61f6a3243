#include <gtest/gtest.h>

#include "cli/process.hpp"
#include "radioslam/cli/parameter_sets.hpp"

namespace radioslam::cli {
namespace {

TEST(ParametersPage, OfTheDocumentationIsCurrent) {
  EXPECT_TRUE(read_file(RADIOSLAM_PARAMETERS_PAGE) == parameters_page())
      << RADIOSLAM_PARAMETERS_PAGE << " is not current: scripts/parameters_page.sh writes it";
}

TEST(ParametersPage, BasicParametersComeFirst) {
  const std::string page = parameters_page();
  const auto basic = page.find("| `keyframe.distance_m` | 1 m |");
  const auto section = page.find("### keyframe\n");
  ASSERT_NE(basic, std::string::npos);
  ASSERT_NE(section, std::string::npos);
  EXPECT_LT(basic, section);
  EXPECT_NE(page.find("| `keyframe.distance_m` | 1 m |", section), std::string::npos);
  EXPECT_LT(page.find("## run\n"), page.find("## simulate carpark\n"));
}

}  // namespace
}  // namespace radioslam::cli
