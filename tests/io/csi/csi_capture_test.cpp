#include "radioslam/io/csi/csi_capture.hpp"

#include <gtest/gtest.h>

#include "esp32_text.hpp"
#include "io/csi/pcap_bytes.hpp"
#include "io/recorded_data.hpp"
#include "io/refusal.hpp"

namespace radioslam {
namespace {

std::string refused(const std::string& bytes) {
  return refusal([&] { read_csi_capture("x", bytes); });
}

/// An Intel 5300 capture of one packet with one antenna and one stream, all zeros.
std::string intel_capture() {
  const std::size_t channel_bytes = (30 * (16 + 3) + 7) / 8;
  std::string body = number_bytes(7, 8) + "\1\1" + std::string(6, '\0') + number_bytes(channel_bytes, 2) +
                     number_bytes(0x101, 2) + std::string(channel_bytes, '\0');
  return number_bytes(body.size() + 1, 2, ByteOrder::kBig) + "\xbb" + body;
}

std::string nexmon_capture() {
  const std::string record = std::string("\x11\x11\xc6\x08", 4) + std::string(8, 'm') + number_bytes(0, 2) +
                             number_bytes(0x1006, 2) + number_bytes(101, 2) + std::string(64 * 4, '\1');
  return PcapStyle{}.header() + PcapStyle{}.packet(1, 2, ethernet(datagram(record)));
}

TEST(CsiCaptureFile, IsRecognisedByItsContent) {
  EXPECT_EQ(read_csi_capture("x", intel_capture()).subcarrier_hz.size(), 30U);
  EXPECT_EQ(read_csi_capture("x", nexmon_capture()).carrier_hz, 2437e6);
  EXPECT_EQ(read_csi_capture("x", "some log first\n" + Esp32Text{}.line()).subcarrier_hz.size(), 56U);
}

TEST(CsiCaptureFile, RefusesOtherKindsByName) {
  const std::string read = "; captures of Intel 5300, ESP32 and Nexmon CSI are supported";
  EXPECT_EQ(refused(""), "x: the file is empty");
  EXPECT_EQ(refused("MATLAB 5.0 MAT-file, Platform: MACI64"), "x: at byte 0: a MATLAB file" + read);
  EXPECT_EQ(refused(std::string("\x0a\x0d\x0d\x0a\x1c\0\0\0", 8)),
            "x: at byte 0: a pcapng file (`editcap -F pcap` makes a pcap file of it)" + read);
  std::string feit(272 + 208, '\0');
  feit.replace(0, 4, number_bytes(208, 4)).replace(46, 2, "\1\1").replace(52, 4, number_bytes(52, 4));
  EXPECT_EQ(refused(feit), "x: at byte 0: a capture by FeitCSI" + read);
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
    std::string atheros(900, '\0');
    atheros.replace(10, 2, number_bytes(840, 2, order)).replace(18, 3, "\x38\3\2");
    EXPECT_EQ(refused(atheros), "x: at byte 0: a capture by the Atheros CSI Tool" + read);
  }
  for (const char* text : {"a", "some text\nof two lines\n", "type,role,mac\n"})
    EXPECT_EQ(refused(text), "x: at byte 0: an unknown kind of file" + read);
}

TEST(CsiCaptureFile, PassesOnTheErrorsOfACardsReader) {
  EXPECT_EQ(refused(intel_capture().substr(0, 40)), "x: at byte 0: not a capture of an Intel 5300 card");
  EXPECT_EQ(refused(nexmon_capture().substr(0, 50)), "x: at byte 24: the first packet is truncated");
  EXPECT_EQ(refused("\nCSI_DATA,7"), "x:2: the list of values is missing");
}

TEST(CsiCaptureFile, RefusesAMissingFile) {
  EXPECT_EQ(refusal([] { read_csi_capture("no/such/file"); }), "no/such/file: no such file");
}

TEST(CsiCaptureFile, KnowsEveryRecordedFile) {
  RADIOSLAM_RECORDED(folder, "csi_samples");
  const auto packets = [&](const char* file) {
    return read_csi_capture((folder / file).string()).packets.size();
  };
  EXPECT_EQ(packets("csitool/log.all_csi.6.7.6"), 29U);
  EXPECT_EQ(packets("csiread/sample_0x1_ap.dat"), 540U);
  EXPECT_EQ(packets("csiread/sample_0x5_64_3000.dat"), 2998U);
  EXPECT_EQ(packets("csiread/example_csi.csv"), 13U);
  EXPECT_EQ(packets("csikit/example_100hz_pitraffic.csv"), 833U);
  EXPECT_EQ(packets("csikit/example_43455c0.pcap"), 566U);
  EXPECT_EQ(packets("csikit/example_4366c0.pcap"), 293U);
  const auto refused_file = [&](const char* file) {
    return refusal([&] { read_csi_capture((folder / file).string()); });
  };
  EXPECT_NE(refused_file("csiread/ath_csi_1.dat").find("Atheros CSI Tool"), std::string::npos);
  EXPECT_NE(refused_file("csikit/HESU20_5500.csi").find("FeitCSI"), std::string::npos);
  EXPECT_NE(refused_file("spotfi/sample_csi_trace.mat").find("MATLAB"), std::string::npos);
}

}  // namespace
}  // namespace radioslam
