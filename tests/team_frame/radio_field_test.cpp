#include "radioslam/team_frame/radio_field.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr Eigen::Index kNodes = 14;
constexpr double kChannels = 7;

std::vector<FieldNode> field_nodes() {
  std::vector<FieldNode> nodes;
  for (Eigen::Index i = 0; i < kNodes; ++i)
    nodes.push_back({static_cast<std::size_t>(i / 5), Stamp{static_cast<std::int64_t>(i) * 3'000'000'000}});
  return nodes;
}

Eigen::MatrixXd random_rows(Rng& rng, Eigen::Index columns) {
  Eigen::MatrixXd heard =
      Eigen::MatrixXd::NullaryExpr(kNodes, columns, [&] { return std::abs(rng.normal()); });
  heard.rowwise().normalize();
  return heard;
}

Eigen::Matrix2Xd random_places(Rng& rng) {
  return Eigen::Matrix2Xd::NullaryExpr(2, kNodes, [&] { return rng.uniform(-30, 30); });
}

/// The header's formula, term by term.
double cost_by_formula(const Eigen::Matrix2Xd& x, const FieldModel& model, const Eigen::MatrixXd& heard) {
  const FieldKernel& k = model.kernel;
  const auto nodes = field_nodes();
  Eigen::MatrixXd covariance(kNodes, kNodes);
  for (Eigen::Index i = 0; i < kNodes; ++i)
    for (Eigen::Index j = 0; j < kNodes; ++j) {
      const FieldNode &a = nodes[static_cast<std::size_t>(i)], &b = nodes[static_cast<std::size_t>(j)];
      const double d = std::sqrt((x.col(i) - x.col(j)).squaredNorm() + 1e-4);
      double& c = covariance(i, j);
      c = k[FieldKernel::kFar] * std::exp(-d / k[FieldKernel::kFarLength]) +
          k[FieldKernel::kNear] * std::exp(-d * d / 2 / std::pow(k[FieldKernel::kNearLength], 2)) +
          k[FieldKernel::kEverywhere];
      if (a.robot != b.robot)
        c *= std::exp(-std::exp(model.log_losses[static_cast<Eigen::Index>(a.robot)]) -
                      std::exp(model.log_losses[static_cast<Eigen::Index>(b.robot)]));
      if (a.robot == b.robot)
        c += k[FieldKernel::kRobot] +
             k[FieldKernel::kDrift] *
                 std::exp(-3 * std::abs(static_cast<double>(i - j)) / k[FieldKernel::kDriftTime]);
      if (i == j) c += k[FieldKernel::kNoise];
    }
  return kChannels / 2 *
         (std::log(covariance.determinant()) + (covariance.inverse() * heard * heard.transpose()).trace());
}

FieldModel some_model() {
  FieldModel model = FieldModel::nominal(3);
  model.log_losses << -3, -0.5, -1;
  return model;
}

class RadioFieldOfColumns : public testing::TestWithParam<Eigen::Index> {};

TEST_P(RadioFieldOfColumns, CostsWhatTheFormulaSays) {
  Rng rng(3);
  const Eigen::MatrixXd heard = random_rows(rng, GetParam());
  const Eigen::Matrix2Xd places = random_places(rng);
  const RadioField field(field_nodes(), heard, kChannels);
  const FieldModel model = some_model();
  EXPECT_NEAR(field.cost(places, model).value, cost_by_formula(places, model, heard), 1e-5);
}

TEST_P(RadioFieldOfColumns, SlopesAreThoseOfTheCost) {
  constexpr double kStep = 1e-5;
  Rng rng(4);
  const RadioField field(field_nodes(), random_rows(rng, GetParam()), kChannels);
  const Eigen::Matrix2Xd places = random_places(rng);
  const FieldModel model = some_model();
  const FieldCost cost = field.cost(places, model);
  const auto numerical = [&](const auto& step) { return (step(kStep) - step(-kStep)) / (2 * kStep); };
  for (Eigen::Index i = 0; i < kNodes; ++i)
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      EXPECT_NEAR(cost.by_position(axis, i), numerical([&](double h) {
                    Eigen::Matrix2Xd moved = places;
                    moved(axis, i) += h;
                    return field.cost(moved, model).value;
                  }),
                  1e-5);
  for (Eigen::Index p = 0; p < FieldKernel::kCount; ++p)
    EXPECT_NEAR(cost.by_kernel[p], numerical([&](double h) {
                  FieldModel other = model;
                  other.kernel.log[p] += h;
                  return field.cost(places, other).value;
                }),
                1e-5);
  for (Eigen::Index r = 0; r < model.log_losses.size(); ++r)
    EXPECT_NEAR(cost.by_loss[r], numerical([&](double h) {
                  FieldModel other = model;
                  other.log_losses[r] += h;
                  return field.cost(places, other).value;
                }),
                1e-5);
}

/// The chain rule of probabilities.
TEST_P(RadioFieldOfColumns, ConditionalCostIsWhatTheNodesAddToTheCost) {
  Rng rng(6);
  const Eigen::MatrixXd heard = random_rows(rng, GetParam());
  const Eigen::Matrix2Xd places = random_places(rng);
  const FieldModel model = some_model();
  const std::vector<Eigen::Index> others{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, nodes{10, 11, 12, 13};
  auto of_others = field_nodes();
  of_others.resize(others.size());
  const double without =
      RadioField(of_others, heard.topRows(10), kChannels).cost(places.leftCols(10), model).value;
  const RadioField field(field_nodes(), heard, kChannels);
  EXPECT_NEAR(field.conditional_cost(nodes, places.rightCols(4), others, places, model),
              field.cost(places, model).value - without, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(AccessPoints, RadioFieldOfColumns, testing::Values(6, 40));

TEST(RadioField, DoesNotDependOnThreads) {
  Rng rng(5);
  const RadioField field(field_nodes(), random_rows(rng, 40), kChannels);
  const Eigen::Matrix2Xd places = random_places(rng);
  set_thread_count(1);
  const FieldCost one = field.cost(places, some_model());
  set_thread_count(3);
  const FieldCost three = field.cost(places, some_model());
  set_thread_count(0);
  EXPECT_EQ(one.value, three.value);
  EXPECT_EQ(one.by_position, three.by_position);
  EXPECT_EQ(one.by_kernel, three.by_kernel);
  EXPECT_EQ(one.by_loss, three.by_loss);
}

Fingerprint fingerprint(const std::vector<std::pair<std::size_t, float>>& heard) {
  Fingerprint result;
  for (const auto& [access_point, rss_dbm] : heard)
    result.entries.push_back({AccessPointIndex(access_point), rss_dbm, 1});
  return result;
}

TEST(FingerprintPowers, RaisesWhatIsAboveSilenceAndForgetsRareAccessPoints) {
  const Fingerprint a = fingerprint({{0, -97}, {1, -96}, {7, -40}}), b = fingerprint({{0, -60}, {1, -110}}),
                    c = fingerprint({{0, -90}, {1, -90}}), nothing;
  const Eigen::MatrixXd heard = fingerprint_powers({&a, &b, &c, &nothing}, 1);
  ASSERT_EQ(heard.cols(), 2);
  EXPECT_NEAR(heard(0, 0), 0.6, 1e-12);  // 3 and 4 dB above -100: the unit vector (0.6, 0.8)
  EXPECT_NEAR(heard(0, 1), 0.8, 1e-12);
  EXPECT_NEAR(heard(1, 0), 1, 1e-12);  // below the detection threshold counts as undetected
  EXPECT_NEAR(heard(2, 0), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(heard.row(3).norm(), 0);
}

}  // namespace
}  // namespace radioslam
