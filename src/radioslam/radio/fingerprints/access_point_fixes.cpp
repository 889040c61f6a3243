#include "radioslam/radio/fingerprints/access_point_fixes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Values of the power at 1 m and of the exponent that are tried, and their steps in standard deviations of
/// the priors.
constexpr int kPowers = 7, kExponents = 3;
constexpr double kPowerStep = 0.6, kExponentStep = 1;
constexpr double kDecibelsPerNeper = 4.342944819032518;  // 10 / ln 10
/// Fingerprints whose evidence on the model counts as that of one: errors of the model are correlated.
constexpr double kFingerprintsAsOne = 4;
constexpr double kMinDetection = 0.5;  ///< rarer readings are biased to high power
constexpr double kWeakRatio = 0.05;    ///< quantile of all readings that serves as the detection threshold

/// A detected known access point.
struct KnownReading {
  std::size_t known = 0;
  double rss_dbm = 0;
};

/// A fingerprint and the known access points in it.
struct KnownFingerprint {
  std::size_t robot = 0;
  Stamp stamp;
  std::vector<KnownReading> readings;
  std::vector<std::size_t> present;  ///< these, and those detected too rarely
};

/// What all fingerprints have in common.
struct Scene {
  const std::vector<KnownAccessPoint>& known;
  const AccessPointFixParams& params;
  const AccessPointParams& model;
  double floor_dbm = 0;  ///< detection threshold
  std::vector<Eigen::Vector2d> places;
};

/// Sums over all places, of one fingerprint and one model.
struct PlaceSums {
  double log_evidence = 0;
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_m2 = Eigen::Matrix2d::Zero();
};

/// Where a fingerprint was taken.
struct Fix {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  double sigma_m = std::numeric_limits<double>::infinity();
};

/// The models, from the lowest power and exponent on, and the logarithms of their priors.
struct Models {
  std::vector<PathLoss> models;
  std::vector<double> log_priors;

  explicit Models(const AccessPointParams& of) {
    for (int p = 0; p < kPowers; ++p)
      for (int n = 0; n < kExponents; ++n) {
        const double power = (p - kPowers / 2) * kPowerStep, exponent = (n - kExponents / 2) * kExponentStep;
        models.push_back({of.prior_power_dbm + power * of.prior_sigma_power_db,
                          of.prior_exponent + exponent * of.prior_sigma_exponent});
        log_priors.push_back(-(power * power + exponent * exponent) / 2);
      }
  }
};

/// The power of a known access point at a place, and its standard deviation.
struct Prediction {
  double power_dbm = 0, sigma_db = 1;
};

Prediction prediction(const Scene& scene, const PathLoss& model, std::size_t known,
                      const Eigen::Vector2d& place) {
  const KnownAccessPoint& point = scene.known[known];
  const double distance_m = std::hypot((place - point.position_m).norm(), scene.model.height_m);
  const double by_position_db = kDecibelsPerNeper * model.exponent * point.sigma_m / distance_m;
  return {model.power_dbm(distance_m), std::hypot(scene.params.known_sigma_db, by_position_db)};
}

/// Twice Huber's loss.
double huber(double residual, double scale) {
  const double r = std::abs(residual);
  return r <= scale ? r * r : 2 * scale * r - scale * scale;
}

/// Cost of not detecting an access point, at most that of a reading at the loss's scale: it may be off.
double undetected_cost(const Scene& scene, const Prediction& at) {
  const double sigmas = (scene.floor_dbm - at.power_dbm) / at.sigma_db;
  const double probability = 0.5 * std::erfc(-sigmas / std::sqrt(2.0));
  const double most = scene.model.loss_sigmas * scene.model.loss_sigmas;
  return std::min(most, -2 * std::log(std::max(probability, std::numeric_limits<double>::min())));
}

/// The costs of one model at all places: those of every access point if it is not detected, and their sums.
struct ModelTable {
  std::vector<Prediction> predictions;  ///< places x known
  std::vector<double> undetected;       ///< the same
  std::vector<double> all_undetected;   ///< per place

  ModelTable(const Scene& scene, const PathLoss& model) : all_undetected(scene.places.size()) {
    for (std::size_t p = 0; p < scene.places.size(); ++p)
      for (std::size_t k = 0; k < scene.known.size(); ++k) {
        predictions.push_back(prediction(scene, model, k, scene.places[p]));
        undetected.push_back(undetected_cost(scene, predictions.back()));
        all_undetected[p] += undetected.back();
      }
  }
};

double reading_cost(const Scene& scene, const ModelTable& table, const KnownReading& reading,
                    std::size_t place) {
  const Prediction& at = table.predictions[place * scene.known.size() + reading.known];
  return huber((reading.rss_dbm - at.power_dbm) / at.sigma_db, scene.model.loss_sigmas);
}

/// -2 log of the likelihood of every place, up to a constant.
std::vector<double> costs_of(const Scene& scene, const ModelTable& table,
                             const KnownFingerprint& fingerprint) {
  std::vector<double> costs = table.all_undetected;
  for (std::size_t p = 0; p < costs.size(); ++p) {
    for (const std::size_t k : fingerprint.present) costs[p] -= table.undetected[p * scene.known.size() + k];
    for (const KnownReading& reading : fingerprint.readings)
      costs[p] += reading_cost(scene, table, reading, p);
  }
  return costs;
}

PlaceSums sums_over(const Scene& scene, const ModelTable& table, const KnownFingerprint& fingerprint) {
  const std::vector<double> costs = costs_of(scene, table, fingerprint);
  const double least = *std::min_element(costs.begin(), costs.end());
  PlaceSums sums;
  double weights = 0;
  for (std::size_t p = 0; p < costs.size(); ++p) {
    const double weight = std::exp((least - costs[p]) / 2);
    weights += weight;
    sums.mean_m += weight * scene.places[p];
    sums.second_m2 += weight * scene.places[p] * scene.places[p].transpose();
  }
  sums.log_evidence = std::log(weights) - least / 2;
  sums.mean_m /= weights;
  sums.second_m2 /= weights;
  return sums;
}

/// The mixture over the models.
Fix mixed(const std::vector<PlaceSums>& sums, const std::vector<double>& weights) {
  Fix fix;
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t m = 0; m < sums.size(); ++m) {
    fix.mean_m += weights[m] * sums[m].mean_m;
    second += weights[m] * sums[m].second_m2;
  }
  const Eigen::Matrix2d covariance = second - fix.mean_m * fix.mean_m.transpose();
  const double half_trace = covariance.trace() / 2;
  const double root = std::sqrt(std::max(0.0, half_trace * half_trace - covariance.determinant()));
  fix.sigma_m = std::sqrt(std::max(0.0, half_trace + root));
  return fix;
}

/// Probabilities from logarithms.
std::vector<double> normalised(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  std::vector<double> weights;
  double sum = 0;
  for (const double log : logs) sum += weights.emplace_back(std::exp(log - most));
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Evenly spaced places in a rectangle around the access points.
std::vector<Eigen::Vector2d> places_around(const std::vector<KnownAccessPoint>& known,
                                           const AccessPointFixParams& params) {
  Eigen::Vector2d low = known.front().position_m, high = low;
  for (const KnownAccessPoint& point : known) {
    low = low.cwiseMin(point.position_m);
    high = high.cwiseMax(point.position_m);
  }
  low.array() -= params.known_margin_m;
  high.array() += params.known_margin_m;
  const Eigen::Vector2d cell = (high - low) / params.known_cells;
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < params.known_cells; ++i)
    for (int j = 0; j < params.known_cells; ++j)
      places.emplace_back(low + Eigen::Vector2d(i + 0.5, j + 0.5).cwiseProduct(cell));
  return places;
}

double floor_of(const std::vector<std::vector<PlacedFingerprint>>& fingerprints) {
  std::vector<double> all;
  for (const auto& robot : fingerprints)
    for (const PlacedFingerprint& placed : robot)
      for (const FingerprintEntry& entry : placed.fingerprint.entries)
        all.push_back(static_cast<double>(entry.rss_dbm));
  if (all.empty()) return RssAlongPath{}.floor_dbm;
  const auto weak = all.begin() + static_cast<std::ptrdiff_t>(kWeakRatio * static_cast<double>(all.size()));
  std::nth_element(all.begin(), weak, all.end());
  return *weak;
}

/// Per stretch of path, the fingerprint with the most known access points.
std::vector<KnownFingerprint> fingerprints_with(
    const std::vector<KnownAccessPoint>& known, const Mission& mission,
    const std::vector<std::vector<PlacedFingerprint>>& fingerprints, const AccessPointFixParams& params) {
  std::vector<std::optional<std::size_t>> number(mission.access_points.size());
  for (std::size_t k = 0; k < known.size(); ++k) number[known[k].access_point.index()] = k;
  std::vector<KnownFingerprint> chosen;
  for (std::size_t robot = 0; robot < fingerprints.size(); ++robot) {
    if (!mission.robots[robot].fixes.empty()) continue;
    double stretch = -1;
    for (const PlacedFingerprint& placed : fingerprints[robot]) {
      KnownFingerprint fingerprint{robot, placed.fingerprint.stamp, {}, {}};
      for (const FingerprintEntry& entry : placed.fingerprint.entries) {
        const auto k = number[entry.access_point.index()];
        if (!k) continue;
        fingerprint.present.push_back(*k);
        if (static_cast<double>(entry.detection_rate) >= kMinDetection)
          fingerprint.readings.push_back({*k, static_cast<double>(entry.rss_dbm)});
      }
      if (fingerprint.readings.size() < static_cast<std::size_t>(params.known_at_once)) continue;
      const double of_path = std::floor(placed.travelled_m / params.known_spacing_m);
      if (of_path != stretch)
        chosen.push_back(std::move(fingerprint));
      else if (fingerprint.readings.size() > chosen.back().readings.size())
        chosen.back() = std::move(fingerprint);
      stretch = of_path;
    }
  }
  return chosen;
}

/// Fixes of all fingerprints, and the mean of the models by their evidence.
struct LocatedFingerprints {
  std::vector<Fix> fixes;
  PathLoss model{0, 0};
};

LocatedFingerprints locate_all(const Scene& scene, const std::vector<KnownFingerprint>& fingerprints) {
  const Models all(scene.model);
  std::vector<std::vector<PlaceSums>> sums(fingerprints.size());
  std::vector<double> logs = all.log_priors;
  for (std::size_t m = 0; m < all.models.size(); ++m) {
    const ModelTable table(scene, all.models[m]);
    parallel_for(sums.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) sums[k].push_back(sums_over(scene, table, fingerprints[k]));
    });
    for (const std::vector<PlaceSums>& of_one : sums) logs[m] += of_one[m].log_evidence / kFingerprintsAsOne;
  }
  const std::vector<double> weights = normalised(logs);
  LocatedFingerprints located;
  for (const std::vector<PlaceSums>& of_one : sums) located.fixes.push_back(mixed(of_one, weights));
  for (std::size_t m = 0; m < weights.size(); ++m) {
    located.model.power_at_1m_dbm += weights[m] * all.models[m].power_at_1m_dbm;
    located.model.exponent += weights[m] * all.models[m].exponent;
  }
  return located;
}

/// What moves a fix, to first order: by known access point, how the power there depends on the place and the
/// place on the power received; zero for those that are not in the fingerprint.
struct FixErrors {
  Eigen::Vector2d place_m;
  Eigen::Matrix2Xd slopes, gains;
};

FixErrors fix_errors(const Scene& scene, const PathLoss& model, const KnownFingerprint& fingerprint,
                     const Fix& fix) {
  const auto count = static_cast<Eigen::Index>(scene.known.size());
  FixErrors errors{fix.mean_m, Eigen::Matrix2Xd::Zero(2, count), Eigen::Matrix2Xd::Zero(2, count)};
  const double widest_m = scene.params.known_max_sigma_m;
  Eigen::Matrix2d information = Eigen::Matrix2d::Identity() / (widest_m * widest_m);
  for (const KnownReading& reading : fingerprint.readings) {
    const auto k = static_cast<Eigen::Index>(reading.known);
    const Eigen::Vector2d away = fix.mean_m - scene.known[reading.known].position_m;
    const double square = away.squaredNorm() + scene.model.height_m * scene.model.height_m;
    const double sigma_db = prediction(scene, model, reading.known, fix.mean_m).sigma_db;
    errors.slopes.col(k) = -kDecibelsPerNeper * model.exponent / square * away;
    errors.gains.col(k) = errors.slopes.col(k) / (sigma_db * sigma_db);
    information += errors.gains.col(k) * errors.slopes.col(k).transpose();
  }
  errors.gains = inverse(information) * errors.gains;
  return errors;
}

/// Variances of a reading's error, which add up to known_sigma_db squared.
struct ReadingVariances {
  double fading, shadowing, transmitter;

  ReadingVariances(double all, const AccessPointParams& model)
      : fading(std::min(all, model.sigma_fading_db * model.sigma_fading_db)),
        shadowing(std::min(all - fading, model.sigma_shadowing_db * model.sigma_shadowing_db)),
        transmitter(all - fading - shadowing) {}
};

/// Trace of the covariance between two fixes, or of one with itself.
double shared_variance(const Scene& scene, const ReadingVariances& of, const FixErrors& a,
                       const FixErrors& b) {
  const double near = std::exp(-(a.place_m - b.place_m).norm() / scene.model.shadowing_length_m);
  const double alike = of.transmitter + near * of.shadowing + (&a == &b ? of.fading : 0);
  double trace = 0;
  for (std::size_t known = 0; known < scene.known.size(); ++known) {
    const auto k = static_cast<Eigen::Index>(known);
    const double sigma_m = scene.known[known].sigma_m;
    const double by_position = a.slopes.col(k).dot(b.slopes.col(k)) * sigma_m * sigma_m;
    trace += a.gains.col(k).dot(b.gains.col(k)) * (alike + by_position);
  }
  return trace;
}

/// Number of fixes that count as one with each: its correlations with all of them, where these are positive.
std::vector<double> counts_as_one(const Scene& scene, const std::vector<FixErrors>& errors) {
  const ReadingVariances of(scene.params.known_sigma_db * scene.params.known_sigma_db, scene.model);
  std::vector<double> own, counts(errors.size(), 0);
  for (const FixErrors& fix : errors) own.push_back(shared_variance(scene, of, fix, fix));
  parallel_for(errors.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t j = 0; j < errors.size(); ++j)
        counts[i] +=
            std::max(0.0, shared_variance(scene, of, errors[i], errors[j]) / std::sqrt(own[i] * own[j]));
  });
  return counts;
}

}  // namespace

AccessPointFixes fixes_by_access_points(const Mission& mission,
                                        const std::vector<std::vector<PlacedFingerprint>>& all,
                                        const AccessPointFixParams& params, const AccessPointParams& model) {
  AccessPointFixes result{known_access_points(mission), {}};
  result.robots.resize(mission.robots.size());
  const auto least = static_cast<std::size_t>(params.known_at_once);
  if (!params.use_known || mission.dimension != 2 || result.known.size() < least) return result;
  const auto fingerprints = fingerprints_with(result.known, mission, all, params);
  if (fingerprints.empty()) return result;
  const Scene scene{result.known, params, model, floor_of(all), places_around(result.known, params)};
  const auto [fixes, mean_model] = locate_all(scene, fingerprints);
  std::vector<std::size_t> used;
  std::vector<FixErrors> errors;
  for (std::size_t k = 0; k < fixes.size(); ++k)
    if (fixes[k].sigma_m <= params.known_max_sigma_m) {
      used.push_back(k);
      errors.push_back(fix_errors(scene, mean_model, fingerprints[k], fixes[k]));
    }
  const std::vector<double> counts = counts_as_one(scene, errors);
  for (std::size_t n = 0; n < used.size(); ++n) {
    const Fix& fix = fixes[used[n]];
    const KnownFingerprint& of = fingerprints[used[n]];
    result.robots[of.robot].push_back(
        {of.stamp, {fix.mean_m.x(), fix.mean_m.y(), 0}, std::sqrt(std::max(1.0, counts[n])) * fix.sigma_m});
  }
  return result;
}

}  // namespace radioslam
