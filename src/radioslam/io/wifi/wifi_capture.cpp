#include "radioslam/io/wifi/wifi_capture.hpp"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/mac_address.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kWord = 4, kFirstWord = 4;
constexpr unsigned kFlags = 1, kTunedChannel = 3, kSignal = 5;
constexpr unsigned kAgainBit = 29, kVendorBit = 30, kMoreBit = 31;
constexpr unsigned kBadChecksumBit = 6;
constexpr std::size_t kVendorHeader = 6, kVendorLengthAt = 4, kVendorAlignment = 2;

struct FieldSize {
  std::size_t bytes, alignment;
};

/// Fields 0 to 27 as defined by radiotap.org; from field 28 on the encoding differs.
constexpr std::array<FieldSize, 28> kFieldSizes{{{8, 8},  {1, 1},  {1, 1},  {4, 2},  {2, 2}, {1, 1}, {1, 1},
                                                 {2, 2},  {2, 2},  {2, 2},  {1, 1},  {1, 1}, {1, 1}, {1, 1},
                                                 {2, 2},  {2, 2},  {1, 1},  {1, 1},  {8, 4}, {3, 1}, {8, 4},
                                                 {12, 2}, {12, 8}, {12, 2}, {12, 2}, {6, 2}, {1, 1}, {4, 2}}};

/// Iterates over the fields.
class RadiotapReader {
 public:
  RadiotapReader(std::string_view header) : header_(header, ByteOrder::kLittle) {
    result_.length = header.size();
  }

  std::optional<Radiotap> read() {
    if (!find_fields()) return std::nullopt;
    for (std::size_t word = 0; word < words_ && !ended_; ++word)
      if (!read_word(present(word))) return std::nullopt;
    return result_;
  }

 private:
  std::uint32_t present(std::size_t word) const { return header_.u32(kFirstWord + kWord * word); }
  static bool has(std::uint32_t word, unsigned bit) { return (word >> bit & 1U) != 0; }

  bool find_fields() {
    do {
      at_ = kFirstWord + kWord * ++words_;
      if (at_ > header_.size()) return false;
    } while (has(present(words_ - 1), kMoreBit));
    return true;
  }

  bool read_word(std::uint32_t word) {
    if (is_vendors_) return turn_page(word);
    for (unsigned field = 0; field < kAgainBit; ++field) {
      if (!has(word, field)) continue;
      ended_ = field >= kFieldSizes.size();
      if (ended_) return true;
      if (!take(kFieldSizes[field].bytes, kFieldSizes[field].alignment)) return false;
      use(field, at_ - kFieldSizes[field].bytes);
    }
    return turn_page(word);
  }

  /// Interprets the flags of the next word.
  bool turn_page(std::uint32_t word) {
    const bool again = has(word, kAgainBit), vendor = has(word, kVendorBit);
    if (vendor && !skip_vendor()) return false;
    ended_ = !again && !vendor && !is_vendors_;  // further fields of the same kind are undefined
    if (again || vendor) is_vendors_ = vendor;
    return true;
  }

  bool take(std::size_t bytes, std::size_t alignment) {
    at_ = (at_ + alignment - 1) / alignment * alignment + bytes;
    return at_ <= header_.size();
  }

  bool skip_vendor() {
    if (!take(kVendorHeader, kVendorAlignment)) return false;
    at_ += header_.u16(at_ - kVendorHeader + kVendorLengthAt);
    return at_ <= header_.size();
  }

  void use(unsigned field, std::size_t at) {
    if (field == kFlags) result_.bad_checksum = result_.bad_checksum || has(header_.u8(at), kBadChecksumBit);
    if (field == kTunedChannel && !result_.frequency_mhz) result_.frequency_mhz = header_.u16(at);
    if (field == kSignal && !result_.signal_dbm) result_.signal_dbm = header_.i8(at);
  }

  ByteView header_;
  Radiotap result_;
  std::size_t words_ = 0, at_ = 0;
  bool is_vendors_ = false, ended_ = false;
};

constexpr const char* kMalformed = "packets are truncated or malformed, and left out";
constexpr const char* kWrongChecksum = "frames have a wrong checksum and are left out";
constexpr const char* kLevelless = "frames have no level and are left out";
constexpr const char* kUntimely = "packets have an implausible time and are left out";

// IEEE 802.11: frame control, duration, then up to three addresses.
constexpr std::size_t kMinFrame = 10, kSecondAddress = 10, kThirdAddress = 16, kAddressBytes = 6;
enum FrameType : unsigned { kManagement = 0, kControl = 1, kData = 2 };
constexpr unsigned kProbeResponse = 5, kBeacon80211 = 8;
/// Control frames with a transmitter's address: trigger, beamforming poll, NDP announcement, block
/// acknowledgement and its request, power save poll, request to send.
constexpr std::array<unsigned, 7> kControlWithSender{2, 4, 5, 8, 9, 10, 11};

using FilePointer = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
using CapturePointer = std::unique_ptr<pcap_t, void (*)(pcap_t*)>;

/// Offset of the address to which a frame is attributed; nothing for frames that are not used.
std::optional<std::size_t> place_of_sender(unsigned type, unsigned subtype, bool every_frame) {
  if (type == kManagement && (subtype == kBeacon80211 || subtype == kProbeResponse))
    return every_frame ? kSecondAddress : kThirdAddress;
  if (!every_frame) return std::nullopt;
  const bool has_sender =
      type == kManagement || type == kData ||
      (type == kControl && std::count(kControlWithSender.begin(), kControlWithSender.end(), subtype) > 0);
  return has_sender ? std::optional(kSecondAddress) : std::nullopt;
}

/// Converts packets to rows.
class CaptureRows {
 public:
  explicit CaptureRows(const WifiCaptureParams& params) : params_(params) {}

  void add(Stamp stamp, std::string_view packet) {
    const auto header = read_radiotap(packet);
    if (!header) {
      ++log_.counts[kMalformed];
      return;
    }
    if (header->bad_checksum) {
      ++log_.counts[kWrongChecksum];
      return;
    }
    add_frame(stamp, *header, packet.substr(header->length));
  }
  WifiLog take() { return std::move(log_); }

 private:
  void add_frame(Stamp stamp, const Radiotap& header, std::string_view frame) {
    if (frame.size() < kMinFrame) {
      ++log_.counts[kMalformed];
      return;
    }
    const ByteView bytes(frame, ByteOrder::kLittle);
    const unsigned control = bytes.u8(0);
    const auto sender = place_of_sender(control >> 2U & 3U, control >> 4U, params_.every_frame);
    if ((control & 3U) != 0 || !sender) return;
    if (frame.size() < *sender + kAddressBytes) {
      ++log_.counts[kMalformed];
    } else if (!header.signal_dbm) {
      ++log_.counts[kLevelless];
    } else if (std::abs(stamp.seconds()) > kLatestTime_s) {
      ++log_.counts[kUntimely];
    } else {
      log_.rows.push_back(
          {on_clock_ahead_by(params_.clock_offset_s, stamp), format_mac_address(bytes.mac_address(*sender)),
           static_cast<float>(header.frequency_mhz.value_or(0)), static_cast<float>(*header.signal_dbm)});
    }
  }

  WifiCaptureParams params_;
  WifiLog log_;
};

std::string at_byte(std::int64_t byte, const std::string& reason) {
  return "at byte " + std::to_string(byte) + ": " + reason;
}

/// If libpcap opens the file, it takes ownership of it.
CapturePointer open_capture(const std::string& name, FilePointer file) {
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  CapturePointer capture(
      pcap_fopen_offline_with_tstamp_precision(file.get(), PCAP_TSTAMP_PRECISION_NANO, reason.data()),
      &pcap_close);
  if (!capture) throw InputError(name, 0, at_byte(std::ftell(file.get()), reason.data()));
  static_cast<void>(file.release());
  if (const int link = pcap_datalink(capture.get()); link != DLT_IEEE802_11_RADIO) {
    const char* words = pcap_datalink_val_to_description(link);
    throw InputError(name, 0,
                     "its packets are of link type " + std::to_string(link) + " (" +
                         (words == nullptr ? "unknown" : words) +
                         "); radiotap headers, link type 127, are needed");
  }
  return capture;
}

/// Nothing for times before 1970, which arise because libpcap reads the file's unsigned seconds as signed.
std::optional<Stamp> time_of_packet(const pcap_pkthdr& header) {
  if (header.ts.tv_sec < 0 || static_cast<double>(header.ts.tv_sec) > kLatestTime_s ||
      header.ts.tv_usec < 0 || header.ts.tv_usec >= kNanosecondsPerSecond)
    return std::nullopt;
  return Stamp{header.ts.tv_sec * kNanosecondsPerSecond +
               header.ts.tv_usec};  // the fraction is in nanoseconds, as requested on opening
}

WifiLog read_capture(const std::string& name, FilePointer file, const WifiCaptureParams& params) {
  const CapturePointer capture = open_capture(name, std::move(file));
  CaptureRows rows(params);
  std::size_t untimely = 0;
  pcap_pkthdr* header = nullptr;
  const unsigned char* bytes = nullptr;
  int status = pcap_next_ex(capture.get(), &header, &bytes);
  for (; status == 1; status = pcap_next_ex(capture.get(), &header, &bytes)) {
    const std::string_view packet(reinterpret_cast<const char*>(bytes), header->caplen);
    const auto stamp = time_of_packet(*header);
    if (stamp)
      rows.add(*stamp, packet);
    else
      ++untimely;
  }
  WifiLog log = rows.take();
  if (untimely > 0) log.counts[kUntimely] += untimely;
  if (status != PCAP_ERROR) return log;
  const std::string reason = at_byte(std::ftell(pcap_file(capture.get())), pcap_geterr(capture.get()));
  if (reason.find("truncated") == std::string::npos) throw InputError(name, 0, reason);
  log.warnings.push_back(name + ": " + reason + "; the packets before it are read");
  return log;
}

/// Averages each radio's levels over a scan into one row, stamped with the scan's first frame.
std::vector<WifiRow> in_scans(std::vector<WifiRow> rows, double scan_s) {
  std::vector<WifiRow> scans;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const WifiRow& a, const WifiRow& b) { return a.stamp < b.stamp; });
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    const Stamp start = rows[begin].stamp;
    std::map<std::pair<std::string, float>, std::pair<double, int>> sums;
    for (; end < rows.size() && seconds_between(start, rows[end].stamp) < scan_s; ++end) {
      auto& [sum_dbm, frames] = sums[{rows[end].bssid, rows[end].frequency_mhz}];
      sum_dbm += static_cast<double>(rows[end].rssi_dbm);
      ++frames;
    }
    for (const auto& [radio, sum] : sums)
      scans.push_back({start, radio.first, radio.second, static_cast<float>(sum.first / sum.second)});
  }
  return scans;
}

WifiLog read_scans(const std::string& name, FilePointer file, const WifiCaptureParams& params) {
  WifiLog log = read_capture(name, std::move(file), params);
  if (params.scan_s > 0) log.rows = in_scans(std::move(log.rows), params.scan_s);
  return log;
}

}  // namespace

std::optional<Radiotap> read_radiotap(std::string_view packet) {
  constexpr std::size_t kMin = kFirstWord + kWord;
  if (packet.size() < kMin || packet[0] != 0) return std::nullopt;
  const std::size_t length = ByteView(packet, ByteOrder::kLittle).u16(2);
  if (length < kMin || length > packet.size()) return std::nullopt;
  return RadiotapReader(packet.substr(0, length)).read();
}

WifiLog read_wifi_capture(const std::filesystem::path& path, const WifiCaptureParams& params) {
  if (std::filesystem::is_directory(path)) throw InputError(path.string(), 0, "is a folder, not a file");
  FilePointer file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(path.string(), 0, std::string("cannot be opened: ") + std::strerror(errno));
  return read_scans(path.string(), std::move(file), params);
}

WifiLog read_wifi_capture(const std::string& name, std::string_view bytes, const WifiCaptureParams& params) {
  if (bytes.empty()) throw InputError(name, 0, "the file is empty");
  std::string copy(bytes);  // fmemopen requires non-constant bytes
  FilePointer file(::fmemopen(copy.data(), copy.size(), "rb"), &std::fclose);
  if (!file) throw InputError(name, 0, std::string("cannot be read: ") + std::strerror(errno));
  return read_scans(name, std::move(file), params);
}

}  // namespace radioslam
