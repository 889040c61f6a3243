#include "radioslam/io/wifi/iwlist_scan.hpp"
#include "wifi_log_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_printed_list(data, size, [](const Text& text) { return read_iwlist_scans(text); });
}
