#include "radioslam/io/wifi/scan_table.hpp"
#include "wifi_log_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    ScanTableParams params;
    params.clock_offset_s = -4e9;
    check_wifi_log(read_scan_table(make_tool_output("input", std::string(data, data + size)), params));
  } catch (const InputError&) {
  }
  return 0;
}
