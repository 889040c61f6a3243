// Published pose graphs with their peculiarities.
#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "radioslam/io/graph/g2o.hpp"

namespace radioslam {
namespace {

struct KnownGraph {
  const char* name;
  std::size_t poses;
  std::size_t edges;
};

std::ostream& operator<<(std::ostream& out, const KnownGraph& known) { return out << known.name; }

class PublishedGraph : public testing::TestWithParam<KnownGraph> {};

template <class Pose>
void expect_sizes(const G2oGraph<Pose>& file, const KnownGraph& known) {
  EXPECT_EQ(file.graph.poses.size(), known.poses);
  EXPECT_EQ(file.graph.relative_poses.size(), known.edges);
  const std::string written = format_g2o(file);
  const auto again = std::get<G2oGraph<Pose>>(read_g2o(make_text("again", written)));
  EXPECT_EQ(again.pose_ids, file.pose_ids);
  for (std::size_t k = 0; k < known.edges; ++k)
    ASSERT_EQ(again.graph.relative_poses[k].information, file.graph.relative_poses[k].information);
}

TEST_P(PublishedGraph, IsReadWhole) {
  RADIOSLAM_RECORDED(path, std::filesystem::path("posegraphs") / GetParam().name);
  const AnyG2oGraph file = read_g2o(read_text(path));
  std::visit([](const auto& graph) { expect_sizes(graph, GetParam()); }, file);
}

INSTANTIATE_TEST_SUITE_P(
    Io, PublishedGraph,
    testing::Values(KnownGraph{"tinyGrid3D.g2o", 9, 11}, KnownGraph{"smallGrid3D.g2o", 125, 297},
                    KnownGraph{"parking-garage.g2o", 1661, 6275}, KnownGraph{"sphere2500.g2o", 2500, 4949},
                    KnownGraph{"sphere_bignoise_vertex3.g2o", 2200, 8647},
                    KnownGraph{"torus3D.g2o", 5000, 9048}, KnownGraph{"CSAIL.g2o", 1045, 1171},
                    KnownGraph{"input_INTEL_g2o.g2o", 1228, 1483},
                    KnownGraph{"input_M3500_g2o.g2o", 3500, 5453}, KnownGraph{"input_MITb_g2o.g2o", 808, 827},
                    KnownGraph{"kitti_00.g2o", 4541, 4676}, KnownGraph{"kitti_08.g2o", 4071, 4070},
                    KnownGraph{"kitti_09.g2o", 1591, 1592}, KnownGraph{"ais2klinik.g2o", 15115, 16727},
                    KnownGraph{"city10000.g2o", 10000, 20687}, KnownGraph{"sesync_intel.g2o", 1728, 2512},
                    KnownGraph{"sesync_manhattan.g2o", 3500, 5453}));

TEST(PublishedGraphs, CubicleIsRefusedOrRepaired) {
  RADIOSLAM_RECORDED(path, "posegraphs/cubicle.g2o");
  const Text text = read_text(path);
  expect_refusal([&] { read_g2o(text); }, 5753, "indefinite");
  const auto file = std::get<G2oGraph<SE3>>(read_g2o(text, RepairInformation::kYes));
  EXPECT_EQ(file.graph.relative_poses.size(), 16869u);
  EXPECT_EQ(file.repaired_informations, 5021u);
}

TEST(PublishedGraphs, TeamGraphsKeepTheir64BitIds) {
  RADIOSLAM_RECORDED(folder, "multirobot_pcm/test_data/pairwise_consistency_maximization/spoiled/simulation");
  const auto file = std::get<G2oGraph<SE3>>(read_g2o(read_text(folder / "example_2robots/0.g2o")));
  EXPECT_EQ(file.pose_ids.front(), std::uint64_t{'a'} << 56);
  EXPECT_FALSE(file.pose_has_value.back());
  expect_refusal([&] { read_g2o(read_text(folder / "example_2robots/1.g2o")); }, 16, "unknown tag '0410268'");
}

}  // namespace
}  // namespace radioslam
