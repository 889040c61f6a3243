#include "radioslam/io/wifi/radiotap.hpp"

#include <array>

#include "radioslam/io/text/byte_view.hpp"

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

}  // namespace

std::optional<Radiotap> read_radiotap(std::string_view packet) {
  constexpr std::size_t kMin = kFirstWord + kWord;
  if (packet.size() < kMin || packet[0] != 0) return std::nullopt;
  const std::size_t length = ByteView(packet, ByteOrder::kLittle).u16(2);
  if (length < kMin || length > packet.size()) return std::nullopt;
  return RadiotapReader(packet.substr(0, length)).read();
}

}  // namespace radioslam
