#include "radioslam/records/record_codec.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <utility>

#include "radioslam/base/wire.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxName = 200, kMaxPaths = 64, kMaxBins = 4096, kMaxAmended = 256;
constexpr double kMaxMetres = 1e7;
constexpr double kFine_m = 1e-4, kFine_rad = 1e-5;
constexpr float kDecibelStep = 0.5F, kMostDecibels = 1000;
constexpr std::int64_t kMaxNanoseconds = std::int64_t{1} << 61;
constexpr double kRounding = 1e-6;  // what correlations lose, so that rounded covariances stay definite

bool is_planar(const SE3& T) {
  const SE3::Tangent xi = T.log();
  return xi[2] == 0 && xi[3] == 0 && xi[4] == 0 && T.translation().z() == 0;
}

/// Whether both axes of a tangent are of x, y and yaw.
bool are_in_plane(int i, int j) { return (i == 5 || i < 2) && (j == 5 || j < 2); }

/// Whether only x, y and yaw are correlated.
bool is_planar(const SE3::Jacobian& covariance) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      if (!are_in_plane(i, j) && covariance(i, j) != 0) return false;
  return true;
}

/// The bytes of an address in lower case with colons; nothing for any other text.
std::optional<std::array<std::uint8_t, 6>> mac_of(const std::string& text) {
  if (text.size() != 17) return std::nullopt;
  std::array<std::uint8_t, 6> bytes{};
  for (std::size_t k = 0; k < 17; ++k) {
    const char c = text[k];
    if (k % 3 == 2) {
      if (c != ':') return std::nullopt;
      continue;
    }
    const bool is_digit = c >= '0' && c <= '9';
    if (!is_digit && !(c >= 'a' && c <= 'f')) return std::nullopt;
    const int digit = is_digit ? c - '0' : c - 'a' + 10;
    bytes[k / 3] = static_cast<std::uint8_t>(bytes[k / 3] * 16 + digit);
  }
  return bytes;
}

/// A bit per number, the lowest of the first byte first, where that takes fewer bytes than a list of the
/// numbers and these increase; else nothing.
std::string bitmap_of(const std::vector<HeardAccessPoint>& readings) {
  std::size_t as_list = 0;
  for (std::size_t k = 0; k < readings.size(); ++k) {
    if (k > 0 && readings[k].number <= readings[k - 1].number) return {};
    for (std::uint32_t n = readings[k].number; n >= 0x80U; n >>= 7U) ++as_list;
    ++as_list;
  }
  const std::size_t bytes = readings.empty() ? 0 : readings.back().number / 8 + 1;
  if (bytes >= as_list) return {};
  std::string bitmap(bytes, '\0');
  for (const HeardAccessPoint& reading : readings) {
    char& byte = bitmap[reading.number / 8];
    byte = static_cast<char>(static_cast<unsigned char>(byte) | (1U << (reading.number % 8)));
  }
  return bitmap;
}

// One list of fields serves writing and reading.

class Writer {
 public:
  void operator()(bool value) { out_.byte(value ? 1 : 0); }
  void operator()(float value) { out_.f32(value); }
  void operator()(double value) { out_.f64(value); }
  /// In 32 bits.
  void real(double value) { out_.f32(static_cast<float>(value)); }
  void real(const std::optional<double>& value) {
    (*this)(value.has_value());
    if (value) real(*value);
  }
  void operator()(std::uint32_t value) { out_.whole(value); }
  void operator()(int value) { out_.byte(static_cast<std::uint8_t>(value)); }
  void operator()(Heading value) { out_.byte(static_cast<std::uint8_t>(value)); }
  void operator()(Stamp value) {
    out_.whole((static_cast<std::uint64_t>(value.ns) << 1U) ^ static_cast<std::uint64_t>(value.ns >> 63U));
  }
  void operator()(const std::string& text) {
    out_.whole(text.size());
    out_.append(text);
  }
  void operator()(const Eigen::Vector3d& vector) {
    const bool is_zero = vector.isZero(0);
    (*this)(is_zero);
    if (!is_zero)
      for (int k = 0; k < 3; ++k) out_.f64(vector[k]);
  }
  void operator()(const SE3& T) {
    const bool planar = is_planar(T);
    const Eigen::Vector3d t = T.translation(), r = T.log().tail<3>();
    (*this)(planar);
    for (int k = 0; k < (planar ? 2 : 3); ++k) out_.f32(static_cast<float>(t[k]));
    for (int k = planar ? 2 : 0; k < 3; ++k) out_.f32(static_cast<float>(r[k]));
  }
  /// A short motion, to a tenth of a millimetre and 10 microradians.
  void fine(const SE3& T) {
    const bool planar = is_planar(T);
    const Eigen::Vector3d t = T.translation(), r = T.log().tail<3>();
    (*this)(planar);
    for (int k = 0; k < (planar ? 2 : 3); ++k) (*this)(Stamp{std::llround(t[k] / kFine_m)});
    for (int k = planar ? 2 : 0; k < 3; ++k) (*this)(Stamp{std::llround(r[k] / kFine_rad)});
  }
  /// One that may be far from the origin.
  void exact(const SE3& T) {
    for (int k = 0; k < 3; ++k) out_.f64(T.translation()[k]);
    const Eigen::Vector3d r = T.log().tail<3>();
    for (int k = 0; k < 3; ++k) out_.f64(r[k]);
  }
  void exact(const std::optional<SE3>& T) {
    (*this)(T.has_value());
    if (T) exact(*T);
  }
  /// A bit for each, whether it is empty, then those that are not, two in a byte.
  void bins(const std::vector<std::uint8_t>& bins, std::size_t /*count*/, bool is_occupancy) {
    std::string full((bins.size() + 7) / 8, '\0');
    for (std::size_t k = 0; k < bins.size(); ++k)
      if (bins[k] != 0)
        full[k / 8] = static_cast<char>(static_cast<unsigned char>(full[k / 8]) | (1U << (k % 8)));
    out_.append(full);
    if (is_occupancy) return;
    std::string halves;
    bool is_second = false;
    for (const std::uint8_t bin : bins) {
      if (bin == 0) continue;
      if (!is_second) halves.push_back('\0');
      halves.back() =
          static_cast<char>(static_cast<unsigned char>(halves.back()) | (is_second ? bin << 4U : bin));
      is_second = !is_second;
    }
    out_.append(halves);
  }
  /// Standard deviations, then correlations.
  void operator()(const SE3::Jacobian& covariance) {
    const bool planar = is_planar(covariance);
    (*this)(planar);
    const SE3::Tangent sigma = covariance.diagonal().cwiseSqrt();
    for (int i = 0; i < 6; ++i) out_.f32(static_cast<float>(sigma[i]));
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j) {
        if (planar && !are_in_plane(i, j)) continue;
        out_.f32(static_cast<float>((1 - kRounding) * covariance(i, j) / (sigma[i] * sigma[j])));
      }
  }
  void decibels(float value) {
    out_.byte(static_cast<std::uint8_t>(std::clamp(std::lround(-value / kDecibelStep), 0L, 255L)));
  }
  /// A MAC address as six bytes.
  void bssid(const std::string& text) {
    const auto address = mac_of(text);
    (*this)(address.has_value());
    if (!address) return (*this)(text);
    for (const std::uint8_t byte : *address) out_.byte(byte);
  }
  template <class T>
  void operator()(const std::optional<T>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  template <class T, class Fields>
  void list(const std::vector<T>& values, std::size_t /*most*/, const Fields& fields) {
    out_.whole(values.size());
    for (const T& value : values) fields(*this, value);
  }
  void readings(const std::vector<HeardAccessPoint>& readings) {
    const std::string bitmap = bitmap_of(readings);
    out_.whole(bitmap.empty() ? 2 * readings.size() : 2 * bitmap.size() + 1);
    out_.append(bitmap);
    if (bitmap.empty())
      for (const HeardAccessPoint& reading : readings) (*this)(reading.number);
    for (const HeardAccessPoint& reading : readings) decibels(reading.rssi_dbm);
  }
  std::string take() { return out_.take(); }
  void kind(std::size_t k) { out_.byte(static_cast<std::uint8_t>(k)); }

 private:
  WireWriter out_;
};

std::string mac_text(WireReader& in) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (int k = 0; k < 6; ++k) {
    const unsigned byte = in.byte();
    if (k > 0) text += ':';
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

class Reader {
 public:
  explicit Reader(std::string_view bytes) : in_(bytes) {}

  void operator()(bool& value) {
    const std::uint8_t byte = in_.byte();
    if (byte > 1) in_.refuse();
    value = byte == 1;
  }
  void operator()(float& value) { value = in_.f32(); }
  void operator()(double& value) { value = in_.f64(); }
  void real(double& value) { value = static_cast<double>(in_.f32()); }
  void real(std::optional<double>& value) {
    optional(value, [this](double& of) { real(of); });
  }
  void operator()(std::uint32_t& value) { value = in_.whole32(); }
  void operator()(int& value) { value = in_.byte(); }
  void operator()(Heading& value) {
    bool is_absolute = false;
    (*this)(is_absolute);
    value = is_absolute ? Heading::kAbsolute : Heading::kRelative;
  }
  void operator()(Stamp& value) {
    const std::uint64_t zigzag = in_.whole();
    value.ns = static_cast<std::int64_t>(zigzag >> 1U) ^ -static_cast<std::int64_t>(zigzag & 1U);
  }
  void operator()(std::string& text) { text = std::string(in_.take(in_.count(1))); }
  void operator()(Eigen::Vector3d& vector) {
    bool is_zero = false;
    (*this)(is_zero);
    vector.setZero();
    if (!is_zero)
      for (int k = 0; k < 3; ++k) vector[k] = in_.f64();
  }
  void operator()(SE3& T) {
    pose(T, [this](double) { return static_cast<double>(in_.f32()); });
  }
  void fine(SE3& T) {
    pose(T, [this](double step) {
      Stamp count;
      (*this)(count);
      return step * static_cast<double>(count.ns);
    });
  }
  void exact(SE3& T) {
    std::array<double, 6> n{};
    for (double& number : n) number = in_.f64();
    set(T, {n[0], n[1], n[2]}, {n[3], n[4], n[5]});
  }
  void exact(std::optional<SE3>& T) {
    optional(T, [this](SE3& of) { exact(of); });
  }
  void bins(std::vector<std::uint8_t>& bins, std::size_t count, bool is_occupancy) {
    if (count > kMaxBins) return in_.refuse();
    const std::string_view full = in_.take((count + 7) / 8);
    if (!in_.good()) return;
    bins.resize(count);
    unsigned halves = 0, left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (((static_cast<unsigned char>(full[k / 8]) >> (k % 8)) & 1U) == 0) continue;
      if (!is_occupancy && left == 0) halves = in_.byte(), left = 2;
      bins[k] = is_occupancy ? 1 : static_cast<std::uint8_t>(halves & kMostBin);
      halves >>= 4U, left -= is_occupancy ? 0 : 1;
      if (bins[k] == 0) in_.refuse();
    }
    if (halves != 0) in_.refuse();
  }
  void operator()(SE3::Jacobian& covariance) {
    bool planar = false;
    (*this)(planar);
    SE3::Tangent sigma;
    for (int i = 0; i < 6; ++i) sigma[i] = static_cast<double>(in_.f32());
    if (!(sigma.minCoeff() > 1e-12) || !(sigma.maxCoeff() < 1e9)) in_.refuse();
    SE3::Jacobian correlation = SE3::Jacobian::Identity();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j) {
        if (planar && !are_in_plane(i, j)) continue;
        correlation(i, j) = correlation(j, i) = static_cast<double>(in_.f32());
      }
    if (!in_.good() || Eigen::LLT<SE3::Jacobian>(correlation).info() != Eigen::Success) return in_.refuse();
    covariance = sigma.asDiagonal() * correlation * sigma.asDiagonal();
  }
  void decibels(float& value) { value = -kDecibelStep * static_cast<float>(in_.byte()); }
  void bssid(std::string& text) {
    bool is_mac = false;
    (*this)(is_mac);
    if (!is_mac) return (*this)(text);
    text = mac_text(in_);
  }
  template <class T>
  void operator()(std::optional<T>& value) {
    optional(value, *this);
  }
  template <class T, class Fields>
  void list(std::vector<T>& values, std::size_t most, const Fields& fields) {
    const std::size_t count = in_.count(1);
    if (count > most) return in_.refuse();
    values.resize(count);
    for (T& value : values) fields(*this, value);
  }
  void readings(std::vector<HeardAccessPoint>& readings) {
    const std::uint64_t count_and_kind = in_.whole(), count = count_and_kind >> 1U;
    if ((count_and_kind & 1U) != 0) {
      const std::string_view bitmap = in_.take(count);
      for (std::size_t byte = 0; byte < bitmap.size() && readings.size() <= kMaxReadings; ++byte)
        for (unsigned bit = 0; bit < 8; ++bit)
          if (((static_cast<unsigned char>(bitmap[byte]) >> bit) & 1U) != 0)
            readings.push_back({static_cast<std::uint32_t>(8 * byte + bit)});
    } else {
      if (count > kMaxReadings) return in_.refuse();
      readings.resize(count);
      for (HeardAccessPoint& reading : readings) (*this)(reading.number);
    }
    if (readings.size() > kMaxReadings) return in_.refuse();
    for (HeardAccessPoint& reading : readings) decibels(reading.rssi_dbm);
  }
  bool is_done() const { return in_.good() && in_.empty(); }

 private:
  template <class T, class Read>
  void optional(std::optional<T>& value, Read&& read) {
    bool has_value = false;
    (*this)(has_value);
    value.reset();
    if (has_value) read(value.emplace());
  }
  template <class Number>
  void pose(SE3& T, const Number& number) {
    bool planar = false;
    (*this)(planar);
    Eigen::Vector3d t = Eigen::Vector3d::Zero(), r = Eigen::Vector3d::Zero();
    for (int k = 0; k < (planar ? 2 : 3); ++k) t[k] = number(kFine_m);
    for (int k = planar ? 2 : 0; k < 3; ++k) r[k] = number(kFine_rad);
    set(T, t, r);
  }
  void set(SE3& T, const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
    const double angle = rotation.norm();
    if (!(translation.cwiseAbs().maxCoeff() < kMaxMetres) || !(angle < 4)) in_.refuse();
    if (!in_.good()) return;
    T = SE3(translation, angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation / angle))
                                   : Eigen::Quaterniond::Identity());
  }

  WireReader in_;
};

template <class Visitor, class Noise>
void visit_noise(Visitor& visit, Noise& noise) {
  visit(noise.sigma_xy_per_sqrt_m), visit(noise.sigma_yaw_per_sqrt_m_rad), visit(noise.sigma_yaw_per_rad);
  visit(noise.sigma_z_per_sqrt_m), visit(noise.sigma_yaw_drift_per_m_rad), visit(noise.sigma_scale);
}
template <class Visitor, class At>
void visit_at(Visitor& visit, At& at) {
  visit(at.keyframe), visit(at.stamp), visit.fine(at.T_keyframe_body);
}
template <class Visitor, class Peer>
void visit_peer(Visitor& visit, Peer& peer) {
  visit(peer.is_anchor), visit(peer.name), visit(peer.antenna), visit(peer.lever_arm_m);
}

/// All fields of a record of any kind, const or not.
template <class Visitor, class OfKind>
void visit_fields(Visitor& visit, OfKind& record) {
  using Kind = std::remove_const_t<OfKind>;
  if constexpr (std::is_same_v<Kind, FactsRecord>) {
    visit(record.dimension), visit_noise(visit, record.noise), visit(record.heading);
    visit(record.sigma_heading_rad), visit.exact(record.initial_pose), visit(record.lidar_range_m);
    visit(record.lidar_view_rad), visit(record.fix_lever_m);
  } else if constexpr (std::is_same_v<Kind, AnchorRecord>) {
    visit(record.anchor.id), visit(record.anchor.position_m), visit(record.anchor.sigma_m);
  } else if constexpr (std::is_same_v<Kind, KeyframeRecord>) {
    visit(record.number), visit(record.stamp);
    record.number == 0 ? visit.exact(record.T_before_this) : visit(record.T_before_this);
    visit(record.covariance);
  } else if constexpr (std::is_same_v<Kind, RangeRecord>) {
    visit_at(visit, record.at), visit(record.antenna), visit(record.lever_arm_m);
    visit_peer(visit, record.other), visit(record.is_other_first), visit.real(record.range_m);
    visit.real(record.sigma_m);
  } else if constexpr (std::is_same_v<Kind, AnglesRecord>) {
    visit_at(visit, record.at), visit_peer(visit, record.transmitter);
    visit.list(record.paths, kMaxPaths, [](auto& of, auto& path) {
      of.real(path.azimuth_rad), of.real(path.elevation_rad), of.real(path.sigma_rad), of.real(path.power_db);
    });
  } else if constexpr (std::is_same_v<Kind, FixRecord>) {
    visit_at(visit, record.at), visit(record.position_m), visit.real(record.sigma_m);
  } else if constexpr (std::is_same_v<Kind, AccessPointRecord>) {
    visit(record.number), visit.bssid(record.bssid), visit(record.frequency_mhz);
  } else if constexpr (std::is_same_v<Kind, FingerprintRecord>) {
    visit_at(visit, record.at), visit.readings(record.readings);
  } else if constexpr (std::is_same_v<Kind, ClosureRecord>) {
    visit_at(visit, record.at), visit(record.other), visit(record.stamp_other), visit(record.T_i_j);
    visit(record.covariance), visit.real(record.inlier_ratio), visit.real(record.doubt);
  } else if constexpr (std::is_same_v<Kind, DescriptorRecord>) {
    visit(record.keyframe), visit(record.is_occupancy), visit(record.range_m), visit(record.step);
    visit(record.rings), visit(record.sectors);
    visit.bins(record.bins, std::size_t{record.rings} * record.sectors, record.is_occupancy);
  } else {
    visit(record.first);
    visit.list(record.steps, kMaxAmended,
               [](auto& of, auto& step) { of(step.T_before_this), of(step.covariance); });
  }
}

bool is_time(Stamp stamp) { return std::abs(stamp.ns) <= kMaxNanoseconds; }
bool is_sigma(double sigma) { return sigma > 0 && sigma < kMaxMetres; }
bool is_near(const Eigen::Vector3d& vector) { return vector.cwiseAbs().maxCoeff() < kMaxMetres; }
bool is_link_end(const std::string& antenna, const Eigen::Vector3d& lever_arm_m) {
  return (antenna.empty() || is_record_name(antenna)) && is_near(lever_arm_m);
}
bool is_peer(const LinkPeer& peer) {
  return is_record_name(peer.name) && is_link_end(peer.antenna, peer.lever_arm_m);
}

struct Validity {
  bool operator()(const FactsRecord& facts) const {
    const OdometryNoise& n = facts.noise;
    const double sigmas[] = {n.sigma_xy_per_sqrt_m,  n.sigma_yaw_per_sqrt_m_rad,  n.sigma_yaw_per_rad,
                             n.sigma_z_per_sqrt_m,   n.sigma_yaw_drift_per_m_rad, n.sigma_scale,
                             facts.sigma_heading_rad};
    return (facts.dimension == 2 || facts.dimension == 3) &&
           std::all_of(std::begin(sigmas), std::end(sigmas),
                       [](double s) { return s >= 0 && s < kMaxMetres; }) &&
           is_sigma(facts.lidar_range_m) && facts.lidar_view_rad > 0 &&
           facts.lidar_view_rad <= 2 * std::numbers::pi + 1e-9 && is_near(facts.fix_lever_m);
  }
  bool operator()(const AnchorRecord& record) const {
    const Anchor& anchor = record.anchor;
    return is_record_name(anchor.id) && anchor.sigma_m >= 0 && anchor.sigma_m < kMaxMetres &&
           (!anchor.position_m || is_near(*anchor.position_m));
  }
  bool operator()(const KeyframeRecord& keyframe) const { return is_time(keyframe.stamp); }
  bool operator()(const RangeRecord& range) const {
    return is_time(range.at.stamp) && is_link_end(range.antenna, range.lever_arm_m) && is_peer(range.other) &&
           range.range_m >= 0 && range.range_m < kMaxMetres && is_sigma(range.sigma_m);
  }
  bool operator()(const AnglesRecord& angles) const {
    return is_time(angles.at.stamp) && is_peer(angles.transmitter) && !angles.paths.empty() &&
           angles.paths.size() <= kMaxPaths &&
           std::all_of(angles.paths.begin(), angles.paths.end(), [](const AoaPath& path) {
             return std::abs(path.azimuth_rad) < 100 && std::abs(path.elevation_rad.value_or(0)) < 100 &&
                    is_sigma(path.sigma_rad) && std::abs(path.power_db) < 1e6;
           });
  }
  bool operator()(const FixRecord& fix) const {
    return is_time(fix.at.stamp) && is_near(fix.position_m) && is_sigma(fix.sigma_m);
  }
  bool operator()(const AccessPointRecord& heard) const {
    return is_record_name(heard.bssid) && std::abs(heard.frequency_mhz) < 1e6F;
  }
  bool operator()(const FingerprintRecord& fingerprint) const {
    return is_time(fingerprint.at.stamp) && fingerprint.readings.size() <= kMaxReadings &&
           std::all_of(fingerprint.readings.begin(), fingerprint.readings.end(),
                       [](const auto& reading) { return std::abs(reading.rssi_dbm) < kMostDecibels; });
  }
  bool operator()(const ClosureRecord& closure) const {
    const auto is_ratio = [](double x) { return x >= 0 && x <= 1; };
    return is_time(closure.at.stamp) && is_time(closure.stamp_other) && is_record_name(closure.other) &&
           is_ratio(closure.inlier_ratio.value_or(0)) && is_ratio(closure.doubt.value_or(0));
  }
  bool operator()(const DescriptorRecord& place) const {
    return place.rings > 0 && place.sectors > 0 && place.bins.size() <= kMaxBins &&
           place.bins.size() == std::size_t{place.rings} * place.sectors && is_sigma(place.range_m) &&
           is_sigma(place.step) &&
           std::all_of(place.bins.begin(), place.bins.end(), [](auto bin) { return bin <= kMostBin; });
  }
  bool operator()(const AmendmentRecord& amendment) const {
    return !amendment.steps.empty() && amendment.steps.size() <= kMaxAmended;
  }
};

template <std::size_t K = 0>
std::optional<Record> decode_kind(std::size_t kind, std::string_view bytes) {
  if constexpr (K == std::variant_size_v<Record>) {
    return std::nullopt;
  } else {
    if (kind != K) return decode_kind<K + 1>(kind, bytes);
    Reader in(bytes);
    std::variant_alternative_t<K, Record> record;
    visit_fields(in, record);
    if (!in.is_done()) return std::nullopt;
    return Record(std::move(record));
  }
}

}  // namespace

bool is_record_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxName && text.find("..") == std::string_view::npos &&
         std::none_of(text.begin(), text.end(), [](char c) {
           return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '/' || c == '\\' || c == ',' ||
                  c == '"';
         });
}

bool is_valid(const Record& record) { return std::visit(Validity{}, record); }

std::string encode(const Record& record) {
  Writer out;
  out.kind(record.index());
  std::visit([&](const auto& of_kind) { visit_fields(out, of_kind); }, record);
  return out.take();
}

std::optional<Record> decode_record(std::string_view bytes) {
  if (bytes.empty() || bytes.size() > kMaxRecordBytes) return std::nullopt;
  auto record = decode_kind(static_cast<unsigned char>(bytes.front()), bytes.substr(1));
  if (!record || !is_valid(*record)) return std::nullopt;
  return record;
}

}  // namespace radioslam
