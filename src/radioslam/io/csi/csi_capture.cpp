#include "radioslam/io/csi/csi_capture.hpp"

#include <algorithm>
#include <array>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/csi/esp32_csi.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/csi/nexmon_csi.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/pcap.hpp"

namespace radioslam {
namespace {

bool is_matlab(std::string_view bytes) {
  return bytes.starts_with("MATLAB 5.0 MAT-file") || bytes.starts_with("MATLAB 7.3 MAT-file");
}

bool is_pcapng(std::string_view bytes) { return bytes.starts_with("\x0a\x0d\x0d\x0a"); }

/// FeitCSI: a header of 272 bytes, then as many bytes as it states: four per antenna, stream and subcarrier.
bool is_feitcsi(std::string_view bytes) {
  constexpr std::size_t kHeader = 272, kBytesPerValue = 4, kMaxAntennas = 4, kMaxSubcarriers = 2048;
  if (bytes.size() < kHeader) return false;
  const ByteView view(bytes, ByteOrder::kLittle);
  const std::size_t antennas = view.u8(46), streams = view.u8(47), subcarriers = view.u32(52);
  return antennas >= 1 && antennas <= kMaxAntennas && streams >= 1 && streams <= kMaxAntennas &&
         subcarriers >= 1 && subcarriers <= kMaxSubcarriers &&
         view.u32(0) == kBytesPerValue * antennas * streams * subcarriers;
}

/// The Atheros CSI Tool's record: u16 length, u64 time, u16 bytes of CSI, ..., at byte 18 tones, antennas and
/// streams; two values of ten bits per tone, antenna and stream.
bool is_atheros(std::string_view bytes) {
  constexpr std::size_t kHeader = 27, kMaxAntennas = 3, kBitsPerValue = 20;
  if (bytes.size() < kHeader) return false;
  const auto is_of = [&](ByteOrder order) {
    const ByteView view(bytes, order);
    const std::size_t tones = view.u8(18), antennas = view.u8(19), streams = view.u8(20);
    return (tones == 56 || tones == 114) && antennas >= 1 && antennas <= kMaxAntennas && streams >= 1 &&
           streams <= kMaxAntennas &&
           view.u16(10) * std::size_t{8} == kBitsPerValue * tones * antennas * streams;
  };
  return is_of(ByteOrder::kLittle) || is_of(ByteOrder::kBig);
}

/// Whether one of the consecutive records has the card's code.
bool is_intel5300(std::string_view bytes) {
  constexpr std::uint8_t kChannelCode = 187;
  const ByteView view(bytes, ByteOrder::kBig);
  for (std::size_t at = 0; at + 3 <= bytes.size(); at += 2 + std::size_t{view.u16(at)})
    if (view.u8(at + 2) == kChannelCode) return true;
  return false;
}

struct CsiFileKind {
  std::string_view name;
  bool (*recognises)(std::string_view bytes);
  CsiCapture (*read)(const std::string& name, std::string_view bytes);  ///< null: not supported
};

/// The first kind that recognises a file is used, so the most specific ones come first.
constexpr std::array kFileKinds{
    CsiFileKind{"a MATLAB file", is_matlab, nullptr},
    CsiFileKind{"a pcapng file (`editcap -F pcap` makes a pcap file of it)", is_pcapng, nullptr},
    CsiFileKind{"a pcap file", is_pcap, read_nexmon_csi},
    CsiFileKind{"a capture by FeitCSI", is_feitcsi, nullptr},
    CsiFileKind{"a capture by the Atheros CSI Tool", is_atheros, nullptr},
    CsiFileKind{"an ESP32's text", is_esp32_csi, read_esp32_csi},
    CsiFileKind{"an Intel 5300's records", is_intel5300, read_intel5300},
};

namespace fs = std::filesystem;

/// "01" of 12: padded with zeros so that names sort as numbers.
std::string numbered(std::size_t number, std::size_t last) {
  const std::string digits = std::to_string(number);
  return std::string(std::to_string(last).size() - digits.size(), '0') + digits;
}

}  // namespace

CsiCapture read_csi_capture(const std::string& name, std::string_view bytes) {
  if (bytes.empty()) throw InputError(name, 0, "the file is empty");
  const auto* kind = std::find_if(kFileKinds.begin(), kFileKinds.end(),
                                  [&](const CsiFileKind& k) { return k.recognises(bytes); });
  const bool is_known = kind != kFileKinds.end();
  if (is_known && kind->read != nullptr) return kind->read(name, bytes);
  throw InputError(name, 0,
                   "at byte 0: " + (is_known ? std::string(kind->name) : "an unknown kind of file") +
                       "; captures of Intel 5300, ESP32 and Nexmon CSI are supported");
}

CsiCapture read_csi_capture(const std::string& path) { return read_csi_capture(path, read_bytes(path)); }

std::vector<CsiCapture> read_csi_folder(const fs::path& folder) {
  std::vector<CsiCapture> captures;
  if (!fs::is_directory(folder)) return captures;
  for (const fs::path& file :
       files_in(folder, Depth::kFolder, [](const fs::path& candidate) { return !is_hidden(candidate); }))
    captures.push_back(read_csi_capture(file.string()));
  return captures;
}

void write_csi_folder(const fs::path& folder, const std::vector<CsiCapture>& captures) {
  std::vector<const CsiCapture*> written;
  for (const CsiCapture& capture : captures)
    if (!capture.packets.empty()) written.push_back(&capture);
  for (std::size_t k = 0; k < written.size(); ++k) {
    const std::string number = written.size() > 1 ? "-" + numbered(k + 1, written.size()) : "";
    write_file(folder / ("capture" + number + ".dat"), write_intel5300(*written[k]));
  }
}

}  // namespace radioslam
