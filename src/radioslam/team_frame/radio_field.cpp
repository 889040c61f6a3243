#include "radioslam/team_frame/radio_field.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/similarity_sums.hpp"

namespace radioslam {
namespace {

constexpr int kMinFingerprints = 3;    // with an access point, for it to be used
constexpr double kNearest_m2 = 1e-4;   // added to squared distances: the far term has a kink at zero
constexpr double kRounding = 1e-9;     // added to S's diagonal before it is factorised
constexpr double kNominalLoss = 0.12;  // phones at one place: e^-0.24 of what one has in common with itself
constexpr Eigen::Index kBlock = 64;    // columns per task, independent of the number of threads

/// Calls body(first, count) for blocks of the columns [0, columns).
template <class Body>
void for_blocks(Eigen::Index columns, Body&& body) {
  const auto blocks = static_cast<std::size_t>((columns + kBlock - 1) / kBlock);
  parallel_for(blocks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Eigen::Index first = static_cast<Eigen::Index>(b) * kBlock;
      body(first, std::min(kBlock, columns - first));
    }
  });
}

/// The terms of one pair's covariance.
struct Terms {
  double distance_m = 0, apart_s = 0;
  double far = 0, near = 0, everywhere = 0;
  double robot = 0, drift = 0;
  double sum() const { return far + near + everywhere + robot + drift; }
};

/// The kernel's parameters, exponentiated once per evaluation.
struct Parameters {
  double far, far_length, near, near_length, noise, robot, everywhere, drift, drift_time;
  std::vector<double> losses;

  explicit Parameters(const FieldModel& model) : Parameters(model.kernel) {
    for (const double log_loss : model.log_losses) losses.push_back(std::exp(log_loss));
  }
  explicit Parameters(const FieldKernel& k)
      : far(k[FieldKernel::kFar]),
        far_length(k[FieldKernel::kFarLength]),
        near(k[FieldKernel::kNear]),
        near_length(k[FieldKernel::kNearLength]),
        noise(k[FieldKernel::kNoise]),
        robot(k[FieldKernel::kRobot]),
        everywhere(k[FieldKernel::kEverywhere]),
        drift(k[FieldKernel::kDrift]),
        drift_time(k[FieldKernel::kDriftTime]) {}

  Terms terms(const FieldNode& a, const FieldNode& b, double squared_m2) const {
    Terms t;
    t.distance_m = std::sqrt(squared_m2 + kNearest_m2);
    t.far = far * std::exp(-t.distance_m / far_length);
    t.near = near * std::exp(-t.distance_m * t.distance_m / (2 * near_length * near_length));
    t.everywhere = everywhere;
    if (a.robot != b.robot) {
      const double shared = std::exp(-losses[a.robot] - losses[b.robot]);
      t.far *= shared;
      t.near *= shared;
      t.everywhere *= shared;
      return t;
    }
    t.apart_s = std::abs(seconds_between(a.stamp, b.stamp));
    t.robot = robot;
    t.drift = drift * std::exp(-t.apart_s / drift_time);
    return t;
  }
};

}  // namespace

FieldKernel FieldKernel::nominal() {
  FieldKernel kernel;
  kernel.log << 0.3, 40, 0.3, 15, 0.05, 0.05, 0.01, 0.1, 20;
  for (double& value : kernel.log) value = std::log(value);  // Eigen's would depend on the vector's alignment
  return kernel;
}

FieldModel FieldModel::nominal(std::size_t robots) {
  return {FieldKernel::nominal(),
          Eigen::VectorXd::Constant(static_cast<Eigen::Index>(robots), std::log(kNominalLoss))};
}

double FieldKernel::operator[](Index i) const { return std::exp(log[i]); }

RadioField::RadioField(std::vector<FieldNode> nodes, const Eigen::MatrixXd& heard, double channels)
    : nodes_(std::move(nodes)), heard_(heard), channels_(channels) {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  RADIOSLAM_CHECK(heard.rows() == n, "a row per node");
  if (heard.cols() <= n) return;
  Eigen::MatrixXd s = heard * heard.transpose();
  s.diagonal().array() += kRounding;
  heard_ = s.llt().matrixL();  // same S with as few columns as nodes
}

Eigen::MatrixXd RadioField::covariance(const Eigen::Matrix2Xd& places, const FieldModel& model) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  const Parameters p(model);
  Eigen::MatrixXd k(n, n);
  for_blocks(n, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index j = first; j < first + count; ++j) {
      for (Eigen::Index i = 0; i < n; ++i)
        k(i, j) = p.terms(node(i), node(j), (places.col(i) - places.col(j)).squaredNorm()).sum();
      k(j, j) += p.noise;
    }
  });
  return k;
}

/// Sums dcost/dK dK/d(position, parameter) over all pairs, column by column, columns in order.
void RadioField::add_slopes(const Eigen::Matrix2Xd& places, const FieldModel& model,
                            const Eigen::MatrixXd& by_covariance, FieldCost& cost) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  const Parameters p(model);
  Eigen::Matrix<double, FieldKernel::kCount, Eigen::Dynamic> by_kernel =
      Eigen::Matrix<double, FieldKernel::kCount, Eigen::Dynamic>::Zero(FieldKernel::kCount, n);
  Eigen::VectorXd by_loss = Eigen::VectorXd::Zero(n);
  for_blocks(n, [&](Eigen::Index first, Eigen::Index count) {
    for (Eigen::Index j = first; j < first + count; ++j) {
      auto sum = by_kernel.col(j);
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Vector2d apart = places.col(j) - places.col(i);
        const Terms t = p.terms(node(i), node(j), apart.squaredNorm());
        const double g = by_covariance(i, j), d = t.distance_m, l2 = p.near_length * p.near_length;
        if (node(i).robot != node(j).robot)
          by_loss[j] -= 2 * g * (t.far + t.near + t.everywhere) * p.losses[node(j).robot];
        sum[FieldKernel::kFar] += g * t.far;
        sum[FieldKernel::kFarLength] += g * t.far * d / p.far_length;
        sum[FieldKernel::kNear] += g * t.near;
        sum[FieldKernel::kNearLength] += g * t.near * d * d / l2;
        sum[FieldKernel::kEverywhere] += g * t.everywhere;
        sum[FieldKernel::kRobot] += g * t.robot;
        sum[FieldKernel::kDrift] += g * t.drift;
        sum[FieldKernel::kDriftTime] += g * t.drift * t.apart_s / p.drift_time;
        cost.by_position.col(j) -= 2 * g * (t.far / (p.far_length * d) + t.near / l2) * apart;
      }
      sum[FieldKernel::kNoise] += by_covariance(j, j) * p.noise;
    }
  });
  for (Eigen::Index j = 0; j < n; ++j) {  // Eigen's rowwise sum would depend on the vector's alignment
    cost.by_kernel += by_kernel.col(j);
    cost.by_loss[static_cast<Eigen::Index>(node(j).robot)] += by_loss[j];
  }
}

FieldCost RadioField::cost(const Eigen::Matrix2Xd& places, const FieldModel& model) const {
  const auto n = static_cast<Eigen::Index>(nodes_.size());
  FieldCost cost{std::numeric_limits<double>::infinity(), Eigen::Matrix2Xd::Zero(2, n),
                 FieldKernel::Vector::Zero(), Eigen::VectorXd::Zero(model.log_losses.size())};
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance(places, model));
  if (factor.info() != Eigen::Success) return cost;
  Eigen::MatrixXd inverse(n, n), explained(n, heard_.cols()), by_covariance(n, n);
  for_blocks(n, [&](Eigen::Index first, Eigen::Index count) {
    inverse.middleCols(first, count) = factor.solve(Eigen::MatrixXd::Identity(n, n).middleCols(first, count));
  });
  for_blocks(heard_.cols(), [&](Eigen::Index first, Eigen::Index count) {
    explained.middleCols(first, count) = inverse * heard_.middleCols(first, count);
  });
  for_blocks(n, [&](Eigen::Index first, Eigen::Index count) {
    by_covariance.middleCols(first, count) =
        channels_ / 2 *
        (inverse.middleCols(first, count) - explained * explained.middleRows(first, count).transpose());
  });
  const double log_determinant = 2 * factor.matrixLLT().diagonal().array().log().sum();
  cost.value = channels_ / 2 * (log_determinant + heard_.cwiseProduct(explained).sum());
  add_slopes(places, model, by_covariance, cost);
  return cost;
}

double RadioField::conditional_cost(const std::vector<Eigen::Index>& nodes, const Eigen::Matrix2Xd& moved,
                                    const std::vector<Eigen::Index>& others, const Eigen::Matrix2Xd& places,
                                    const FieldModel& model) const {
  const Parameters p(model);
  std::vector<Eigen::Index> all = nodes;
  all.insert(all.end(), others.begin(), others.end());
  const auto m = static_cast<Eigen::Index>(nodes.size()), n = static_cast<Eigen::Index>(all.size());
  Eigen::Matrix2Xd at(2, n);
  at.leftCols(m) = moved;
  at.rightCols(n - m) = places(Eigen::all, others);
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i)
      k(i, j) = k(j, i) =
          p.terms(node(all[static_cast<std::size_t>(i)]), node(all[static_cast<std::size_t>(j)]),
                  (at.col(i) - at.col(j)).squaredNorm())
              .sum();
    k(j, j) += p.noise;
  }
  const Eigen::LLT<Eigen::MatrixXd> given(k.bottomRightCorner(n - m, n - m));
  const Eigen::MatrixXd weights = given.solve(k.bottomLeftCorner(n - m, m));
  const Eigen::LLT<Eigen::MatrixXd> left(k.topLeftCorner(m, m) - k.topRightCorner(m, n - m) * weights);
  if (given.info() != Eigen::Success || left.info() != Eigen::Success)
    return std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd unexplained =
      heard_(nodes, Eigen::all) - weights.transpose() * heard_(others, Eigen::all);
  const Eigen::MatrixXd s = unexplained * unexplained.transpose();
  return channels_ / 2 * (2 * left.matrixLLT().diagonal().array().log().sum() + left.solve(s).trace());
}

Eigen::MatrixXd fingerprint_powers(const std::vector<const Fingerprint*>& fingerprints, double exponent) {
  std::map<AccessPointIndex, int> count;
  for (const Fingerprint* fingerprint : fingerprints)
    for (const auto& entry : fingerprint->entries) ++count[entry.access_point];
  std::map<AccessPointIndex, Eigen::Index> column;
  for (const auto& [access_point, fingerprints_with] : count)
    if (fingerprints_with >= kMinFingerprints)
      column.emplace(access_point, static_cast<Eigen::Index>(column.size()));
  Eigen::MatrixXd heard = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(fingerprints.size()),
                                                static_cast<Eigen::Index>(column.size()));
  for (std::size_t i = 0; i < fingerprints.size(); ++i)
    for (const auto& entry : fingerprints[i]->entries)
      if (const auto place = column.find(entry.access_point); place != column.end())
        heard(static_cast<Eigen::Index>(i), place->second) =
            std::pow(shifted_rss_db(entry.rss_dbm), exponent);
  for (Eigen::Index i = 0; i < heard.rows(); ++i)
    if (const double norm = heard.row(i).norm(); norm > 0) heard.row(i) /= norm;
  return heard;
}

}  // namespace radioslam
