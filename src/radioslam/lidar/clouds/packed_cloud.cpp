#include "radioslam/lidar/clouds/packed_cloud.hpp"

#include <zstd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr int kCompression = 1;  // zstd's fastest: higher ones gain next to nothing on these bytes
constexpr float kStep_m = 1.0F / 256;
constexpr float kMostSteps = std::numeric_limits<std::int16_t>::max();
constexpr float kLeastVariance = 1e-8F, kVarianceSteps = 10;  // steps per factor of e; up to 1,000
constexpr float kMostComponent = 1 / std::numbers::sqrt2_v<float>, kMostAxisStep = 127;
constexpr unsigned kIsSource = 1, kIsFew = 2, kShapeBits = 2;
constexpr std::size_t kPlanes = 14;  // bytes of a point before compression

struct Header {
  double median_range_m, source_ratio, few_ratio;
  float step_m;
  std::uint32_t points;
};

/// 0 is a zero, of a normal that is known or that there is none of.
std::uint8_t code_of_variance(float variance) {
  if (!(variance > 0)) return 0;
  return static_cast<std::uint8_t>(
      std::clamp(1 + std::lround(kVarianceSteps * std::log(variance / kLeastVariance)), 1L, 255L));
}

float variance_of(std::uint8_t code) {
  static const std::array<float, 256> kVariances = [] {
    std::array<float, 256> variances{};
    for (std::size_t k = 1; k < variances.size(); ++k)
      variances[k] = kLeastVariance * std::exp(static_cast<float>(k - 1) / kVarianceSteps);
    return variances;
  }();
  return kVariances[code];
}

/// The rotation that turns an axis the least to be along `direction` or against it.
Eigen::Quaternionf turn_of(const Eigen::Vector3f& axis, const Eigen::Vector3f& direction) {
  const float along = axis.dot(direction);
  return Eigen::Quaternionf::FromTwoVectors(axis, along < 0 ? Eigen::Vector3f(-direction) : direction);
}

/// Of the same axes, in any direction each, that with the largest real part, which then need not be kept.
Eigen::Quaternionf with_largest_real_part(const Eigen::Quaternionf& q) {
  const std::array<Eigen::Quaternionf, 4> same{q, q * Eigen::Quaternionf(0, 1, 0, 0),
                                               q * Eigen::Quaternionf(0, 0, 1, 0),
                                               q * Eigen::Quaternionf(0, 0, 0, 1)};
  Eigen::Quaternionf best = *std::max_element(same.begin(), same.end(), [](const auto& a, const auto& b) {
    return std::abs(a.w()) < std::abs(b.w());
  });
  if (best.w() < 0) best.coeffs() = -best.coeffs();
  return best;
}

/// Axes that several variances leave open are chosen such that they compress well.
struct PackedCovariance {
  std::array<std::uint8_t, 3> variances{}, axes{};

  explicit PackedCovariance(const Eigen::Matrix3f& covariance) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
    eigen.computeDirect(covariance);
    for (int k = 0; k < 3; ++k)
      variances[static_cast<std::size_t>(k)] =
          std::max<std::uint8_t>(1, code_of_variance(eigen.eigenvalues()(k)));
    Eigen::Matrix3f vectors = eigen.eigenvectors();
    if (vectors.determinant() < 0) vectors.col(0) = -vectors.col(0);
    const bool is_disc = variances[1] == variances[2], is_needle = variances[0] == variances[1];
    Eigen::Quaternionf q = Eigen::Quaternionf::Identity();
    if (is_disc && !is_needle)
      q = turn_of(Eigen::Vector3f::UnitX(), vectors.col(0));
    else if (is_needle && !is_disc)
      q = turn_of(Eigen::Vector3f::UnitZ(), vectors.col(2));
    else if (!is_disc)
      q = with_largest_real_part(Eigen::Quaternionf(vectors).normalized());
    for (int k = 0; k < 3; ++k) {
      const float steps = std::round(kMostAxisStep / kMostComponent * q.vec()(k));
      axes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(
          static_cast<std::int8_t>(std::clamp(steps, -kMostAxisStep, kMostAxisStep)));
    }
  }

  PackedCovariance() = default;

  Eigen::Matrix3f covariance() const {
    Eigen::Vector3f imaginary, spread;
    for (int k = 0; k < 3; ++k) {
      const auto n = static_cast<std::size_t>(k);
      imaginary(k) = kMostComponent / kMostAxisStep * static_cast<float>(static_cast<std::int8_t>(axes[n]));
      spread(k) = variance_of(variances[n]);
    }
    Eigen::Quaternionf q;
    q.vec() = imaginary;
    q.w() = std::sqrt(std::max(0.0F, 1 - imaginary.squaredNorm()));
    const Eigen::Matrix3f R = q.normalized().toRotationMatrix();
    return R * spread.asDiagonal() * R.transpose();
  }
};

/// A step in which 16 bits reach all points.
float step_of(const std::vector<Surfel>& surfels) {
  float farthest_m = 0;
  for (const Surfel& surfel : surfels)
    farthest_m = std::max(farthest_m, surfel.position.cwiseAbs().maxCoeff());
  RADIOSLAM_CHECK(std::isfinite(farthest_m), "points are finite");
  float step_m = kStep_m;
  while (kMostSteps * step_m < farthest_m) step_m *= 2;
  return step_m;
}

/// Per point of `all`, whether it is the next of `some`; all of them must be found.
void mark(const std::vector<Surfel>& all, const std::vector<Surfel>& some, unsigned as,
          std::vector<unsigned>& marks) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < all.size() && next < some.size(); ++k)
    if (all[k].position == some[next].position) {
      marks[k] |= as;
      ++next;
    }
  RADIOSLAM_CHECK(next == some.size(), "sparse points are among all, in their order");
}

/// The bytes of all points, those of one kind together and compressed apart: each kind has its own
/// frequencies.
class Planes {
 public:
  explicit Planes(std::size_t points) : points_(points), bytes_(kPlanes * points) {}

  std::uint8_t get(std::size_t plane, std::size_t k) const {
    return static_cast<std::uint8_t>(bytes_[plane * points_ + k]);
  }
  void set(std::size_t plane, std::size_t k, std::uint8_t byte) {
    bytes_[plane * points_ + k] = static_cast<char>(byte);
  }

  void compress_to(std::string& result) const {
    static thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> kContext{ZSTD_createCCtx(),
                                                                                            &ZSTD_freeCCtx};
    std::string frame(ZSTD_compressBound(points_), '\0');
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
      const std::size_t size = ZSTD_compressCCtx(kContext.get(), frame.data(), frame.size(),
                                                 bytes_.data() + plane * points_, points_, kCompression);
      RADIOSLAM_CHECK(!ZSTD_isError(size), "bytes are compressed into as many as they may take");
      result.append(frame, 0, size);
    }
  }
  /// Whether the frames are those of all points.
  bool decompress(std::string_view frames) {
    return ZSTD_decompress(bytes_.data(), bytes_.size(), frames.data(), frames.size()) == bytes_.size();
  }

 private:
  std::size_t points_;
  std::vector<char> bytes_;
};

/// Differences of successive numbers, small ones of either sign near zero.
class Differences {
 public:
  std::uint16_t to(std::int16_t value) {
    const auto off = static_cast<std::int16_t>(value - last_);
    last_ = value;
    return static_cast<std::uint16_t>((static_cast<unsigned>(off) << 1U) ^ (off < 0 ? ~0U : 0U));
  }
  std::int16_t by(std::uint16_t off) {
    last_ = static_cast<std::int16_t>(last_ + static_cast<std::int16_t>((off >> 1U) ^ (off & 1U ? ~0U : 0U)));
    return last_;
  }

 private:
  std::int16_t last_ = 0;
};

}  // namespace

std::string packed(const ScanPyramid& cloud) {
  const std::vector<Surfel>& all = cloud.all;
  const Header header{cloud.median_range_m, cloud.source.effective_sample_ratio,
                      cloud.few.effective_sample_ratio, step_of(all), static_cast<std::uint32_t>(all.size())};
  Planes planes(all.size());
  std::vector<unsigned> marks(all.size(), 0);
  mark(all, cloud.source.surfels, kIsSource, marks);
  mark(all, cloud.few.surfels, kIsFew, marks);
  std::array<Differences, 3> differences;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const PackedCovariance covariance(all[k].covariance);
    for (std::size_t a = 0; a < 3; ++a) {
      const float steps = std::round(all[k].position(static_cast<int>(a)) / header.step_m);
      const std::uint16_t off = differences[a].to(static_cast<std::int16_t>(steps));
      planes.set(2 * a, k, static_cast<std::uint8_t>(off & 0xFFU));
      planes.set(2 * a + 1, k, static_cast<std::uint8_t>(off >> 8U));
      planes.set(6 + a, k, covariance.variances[a]);
      planes.set(9 + a, k, covariance.axes[a]);
    }
    planes.set(12, k, code_of_variance(all[k].tilt_rad2));
    planes.set(13, k,
               static_cast<std::uint8_t>(marks[k] << kShapeBits | static_cast<unsigned>(all[k].shape)));
  }
  std::string bytes(sizeof(Header), '\0');
  std::memcpy(bytes.data(), &header, sizeof(Header));
  planes.compress_to(bytes);
  bytes.shrink_to_fit();
  return bytes;
}

namespace {

std::optional<ScanPyramid> cloud_of(std::string_view bytes, std::size_t most_points) {
  Header header{};
  if (bytes.size() < sizeof(Header)) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof(Header));
  const auto is_ratio = [](double ratio) { return ratio >= 0 && ratio <= 1; };
  if (header.points > most_points || !(header.step_m >= kStep_m && header.step_m <= 1) ||
      !(header.median_range_m >= 0 && header.median_range_m < 1e6) ||
      !is_ratio(static_cast<double>(header.source_ratio)) || !is_ratio(static_cast<double>(header.few_ratio)))
    return std::nullopt;
  Planes planes(header.points);
  if (!planes.decompress(bytes.substr(sizeof(Header)))) return std::nullopt;
  ScanPyramid cloud;
  cloud.median_range_m = header.median_range_m;
  cloud.source.effective_sample_ratio = header.source_ratio;
  cloud.few.effective_sample_ratio = header.few_ratio;
  cloud.all.resize(header.points);
  std::array<Differences, 3> differences;
  for (std::size_t k = 0; k < cloud.all.size(); ++k) {
    Surfel& surfel = cloud.all[k];
    PackedCovariance covariance;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto off = static_cast<std::uint16_t>(planes.get(2 * a, k) | planes.get(2 * a + 1, k) << 8U);
      surfel.position(static_cast<int>(a)) = header.step_m * static_cast<float>(differences[a].by(off));
      covariance.variances[a] = planes.get(6 + a, k);
      covariance.axes[a] = planes.get(9 + a, k);
    }
    surfel.covariance = covariance.covariance();
    surfel.tilt_rad2 = variance_of(planes.get(12, k));
    const unsigned marks = planes.get(13, k) >> kShapeBits;
    surfel.shape = static_cast<SurfelShape>(planes.get(13, k) & ((1U << kShapeBits) - 1));
    if (marks & kIsSource) cloud.source.surfels.push_back(surfel);
    if (marks & kIsFew) cloud.few.surfels.push_back(surfel);
  }
  return cloud;
}

}  // namespace

ScanPyramid unpacked(std::string_view bytes) {
  auto cloud = cloud_of(bytes, std::numeric_limits<std::uint32_t>::max());
  RADIOSLAM_CHECK(cloud.has_value(), "what was packed is unpacked whole");
  return *std::move(cloud);
}

std::optional<ScanPyramid> unpacked_from_elsewhere(std::string_view bytes) {
  constexpr std::size_t kMostPoints = 65536;
  return cloud_of(bytes, kMostPoints);
}

}  // namespace radioslam
