// A recorded drive, cut in two.
#include <gtest/gtest.h>

#include <algorithm>

#include "io/recorded_data.hpp"
#include "pipeline/town_runs.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/sim/scenarios/kitti.hpp"

namespace radioslam {
namespace {

// The links are at the first robot's start, the matches 200 s later at its end: there the estimate is metres
// off, forty times the matches' sigma, and the optimizer corrects the trajectory only in many small steps.
TEST(RecordedDrive, TrueMatchesFarFromTheLinksAreTaken) {
  RADIOSLAM_RECORDED(folder, "kitti");
  const auto poses = [&](const char* source) {
    return read_kitti_poses(read_text((folder / source / "08.txt").string()));
  };
  KittiParams params;
  params.cut = 0.5;
  params.matches.matches_true = 40;
  params.matches.matches_false = 120;
  const auto [mission, truth] = simulate_kitti(params, {poses("gt_lidar"), poses("aloam_lidar")}, 9);
  const RunResult result = run_pipeline(mission, RunParams()).result;
  const auto taken = std::count_if(result.closures.begin(), result.closures.end(), [](const auto& closure) {
    return closure.kind == ClosureKind::kMatch && closure.status == ClosureStatus::kAccepted;
  });
  EXPECT_GE(taken, 36);
}

}  // namespace
}  // namespace radioslam
